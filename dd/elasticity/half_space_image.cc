#include "dd/elasticity/half_space_image.h"

#include "dd/elasticity/distance.h"
#include "dd/elasticity/panel_quadrature.h"
#include "dd/elasticity/triangle_displacement.h"

#include <cmath>
#include <numbers>

namespace ddfem
{
namespace
{
Vec3 mirrored(const Vec3 &x)
{
  return {x[0], x[1], -x[2]};
}

/// Burgers vector of the mirror image of a line, for the mirrored line sense.
Vec3 mirror_burgers(const Vec3 &b)
{
  return {-b[0], -b[1], b[2]};
}

/// Out of the body.
const Vec3 outward(0, 0, -1);

/// Rb, Rb + Z and the coefficients of the derivatives of psi, Lambda and V = 1/Rb. With X a vector in the surface,
/// tangential derivatives are
///   f_,ij = p delta_ij + q X_i X_j,   f_,ijk = q (delta_ij X_k + delta_ik X_j + delta_jk X_i) + r X_i X_j X_k.
struct Radii
{
  double v, s;         ///< 1/Rb, 1/(Rb + Z)
  double v2, v3, v5;   ///< powers of 1/Rb
  double psi_q, psi_r; ///< of psi; psi_,i = -X_i s
  double lambda_p, lambda_q, lambda_r;

  explicit Radii(const Vec3 &x)
  {
    const double radius = x.norm();
    v = 1.0 / radius;
    s = 1.0 / (radius + x[2]);
    v2 = v * v;
    v3 = v2 * v;
    v5 = v3 * v2;
    psi_q = v * s * s;
    psi_r = -v2 * s * s * (v + 2.0 * s);
    lambda_p = v * s;
    lambda_q = -v2 * s * (v + s);
    lambda_r = v3 * s * (3.0 * v2 + 3.0 * v * s + 2.0 * s * s);
  }
};

/// Derivatives of a harmonic function phi that its stress needs; phi_,zz and phi_,zzz follow from Laplace's equation.
struct StressSums
{
  double xx = 0, yy = 0, xy = 0;                      ///< phi_,ij
  double xxz = 0, yyz = 0, xyz = 0, xzz = 0, yzz = 0; ///< phi_,ijz, phi_,izz

  /// d_c f for a function f with tangential third derivatives (q, r); third with z: those of its z-derivative.
  void add_tangential(const Vec3 &x, const Vec3 &c, const double q, const double r, const double qz, const double rz)
  {
    const double cx = c[0] * x[0] + c[1] * x[1];
    const double cxx = 2 * c[0] * x[0] + cx, cyy = 2 * c[1] * x[1] + cx, cxy = c[0] * x[1] + c[1] * x[0];
    xx += q * cxx + r * cx * x[0] * x[0];
    yy += q * cyy + r * cx * x[1] * x[1];
    xy += q * cxy + r * cx * x[0] * x[1];
    xxz += qz * cxx + rz * cx * x[0] * x[0];
    yyz += qz * cyy + rz * cx * x[1] * x[1];
    xyz += qz * cxy + rz * cx * x[0] * x[1];
  }

  /// phi_,izz of d_c f with f_,zz,ij = p delta_ij + q X_i X_j.
  void add_normal(const Vec3 &x, const Vec3 &c, const double p, const double q)
  {
    const double cx = c[0] * x[0] + c[1] * x[1];
    xzz += p * c[0] + q * cx * x[0];
    yzz += p * c[1] + q * cx * x[1];
  }

  /// Stress of `factor` phi at depth @p z, MPa.
  SymTensor stress(const double factor, const double nu, const double z) const
  {
    const double zz = -(xx + yy), zzz = -(xxz + yyz);
    SymTensor sigma;
    sigma << xx + 2 * nu * yy + z * xxz, yy + 2 * nu * xx + z * yyz, -zz + z * zzz, (1 - 2 * nu) * xy + z * xyz,
        z * xzz, z * yzz;
    return factor * sigma;
  }
};

/// Derivatives of phi that its displacement needs.
struct DisplacementSums
{
  double x = 0, y = 0, z = 0, xz = 0, yz = 0, zz = 0;

  /// Displacement of `factor` phi at @p depth, nm.
  Vec3 displacement(const double factor, const double mu, const double nu, const double depth) const
  {
    return factor / (2 * mu) *
           Vec3((1 - 2 * nu) * x + depth * xz, (1 - 2 * nu) * y + depth * yz, -2 * (1 - nu) * z + depth * zz);
  }
};

/// (c . grad) psi + (along . grad) Lambda at x relative to the mirrored source point.
void add_element(StressSums &sums, const Vec3 &x, const Vec3 &c, const Vec3 &along)
{
  const Radii k(x);
  const double v7 = k.v5 * k.v2;
  sums.add_tangential(x, c, k.psi_q, k.psi_r, k.lambda_q, k.lambda_r);
  sums.add_normal(x, c, -k.v3, 3 * k.v5);
  // Lambda: tangential derivatives, and V_,ij from its z-derivative.
  sums.add_tangential(x, along, k.lambda_q, k.lambda_r, 3 * k.v5, -15 * v7);
  const double z = x[2], ez = along[2];
  sums.add_normal(x, along, 3 * k.v5 * z, -15 * v7 * z);
  sums.xx += ez * (-k.v3 + 3 * k.v5 * x[0] * x[0]);
  sums.yy += ez * (-k.v3 + 3 * k.v5 * x[1] * x[1]);
  sums.xy += ez * 3 * k.v5 * x[0] * x[1];
  sums.xxz += ez * z * (3 * k.v5 - 15 * v7 * x[0] * x[0]);
  sums.yyz += ez * z * (3 * k.v5 - 15 * v7 * x[1] * x[1]);
  sums.xyz -= ez * z * 15 * v7 * x[0] * x[1];
  const double zzz = ez * (3 * k.v5 - 15 * v7 * z * z);
  sums.xzz += zzz * x[0];
  sums.yzz += zzz * x[1];
}

/// The same for the displacement, times @p weight.
void add_element(DisplacementSums &sums, const Vec3 &x, const Vec3 &c, const Vec3 &along, const double weight)
{
  const Radii k(x);
  const double cx = c[0] * x[0] + c[1] * x[1], ex = along[0] * x[0] + along[1] * x[1], ez = along[2], z = x[2];
  const auto tangential = [&](const int i)
  { return -c[i] * k.s + cx * x[i] * k.psi_q + along[i] * k.lambda_p + ex * x[i] * k.lambda_q - ez * x[i] * k.v3; };
  const auto with_z = [&](const int i)
  {
    return c[i] * k.lambda_p + cx * x[i] * k.lambda_q - along[i] * k.v3 + 3 * ex * x[i] * k.v5 +
           3 * ez * x[i] * z * k.v5;
  };
  sums.x += weight * tangential(0);
  sums.y += weight * tangential(1);
  sums.xz += weight * with_z(0);
  sums.yz += weight * with_z(1);
  sums.z += weight * (cx * k.lambda_p - (ex + ez * z) * k.v3);
  sums.zz += weight * (-cx * k.v3 + 3 * ex * z * k.v5 + ez * (3 * z * z * k.v5 - k.v3));
}

/// phi of the leg is mu/(2 pi) d_c { 2 nu/(1-nu) chi - depth/(1-nu) psi - a^2/(2 (1-nu)) Lambda }, chi_,z = psi,
/// c = (b_y, -b_x).
Vec3 leg_direction(const Vec3 &b)
{
  return {b[1], -b[0], 0.0};
}
} // namespace

SegmentImage::SegmentImage(const IsotropicMedium &medium, const Vec3 &x1, const Vec3 &x2, const Vec3 &b,
                           const double tolerance)
    : start(mirrored(x1)), end(mirrored(x2)), mirrored_burgers(mirror_burgers(b)),
      mirror(medium, start, end, mirrored_burgers), length((x2 - x1).norm()), a2(medium.a * medium.a), mu(medium.mu),
      nu(medium.nu), quadrature_tolerance(tolerance)
{
  const Vec3 direction = length > 0 ? Vec3((x2 - x1) / length) : Vec3(Vec3::Zero());
  const double m = 1 / (1 - nu);
  const Vec3 edge = b.cross(direction);
  t = mirrored(direction);
  e = m * mirrored(edge);
  c = Vec3(2 * direction[2] * b[1] - m * edge[0], -2 * direction[2] * b[0] - m * edge[1], 0.0);
  core = -a2 * direction[2] * Vec3(b[1], -b[0], 0.0);
}

template <typename Add> void SegmentImage::for_each_point(const Vec3 &x, Add &&add) const
{
  if (!(length > 0))
    return;
  auto singularities = internal::LineSingularities::of_point(x, std::sqrt(a2), start, t);
  if (t[2] != 0) // branch points of D
    singularities.add(-start[2] / t[2], std::sqrt(a2) / std::abs(t[2]));
  internal::integrate_on_panels(singularities, length, quadrature_tolerance,
                                [&](const double s, const double weight)
                                {
                                  const Vec3 source = start + s * t;
                                  const double depth = std::sqrt(source[2] * source[2] + a2);
                                  const Vec3 r(x[0] - source[0], x[1] - source[1], x[2] + depth);
                                  const Vec3 along = Vec3(depth * e[0], depth * e[1], -source[2] * e[2]) +
                                                     (depth > 0 ? Vec3(core / depth) : core);
                                  add(r, along, weight);
                                });
}

SymTensor SegmentImage::stress(const Vec3 &x) const
{
  StressSums sums;
  for_each_point(x, [&](const Vec3 &r, const Vec3 &along, const double weight)
                 { add_element(sums, r, weight * c, weight * along); });
  return mirror(x) + sums.stress(mu / (2 * std::numbers::pi), nu, x[2]);
}

Vec3 SegmentImage::displacement(const Vec3 &x) const
{
  DisplacementSums sums;
  for_each_point(x, [&](const Vec3 &r, const Vec3 &along, const double weight)
                 { add_element(sums, r, c, along, weight); });
  return triangle_displacement(nu, x, LoopVertex::at(start), LoopVertex::at(end), LoopVertex::towards(outward),
                               mirrored_burgers) +
         sums.displacement(mu / (2 * std::numbers::pi), mu, nu, x[2]);
}

double SegmentImage::distance(const Vec3 &x) const
{
  return std::sqrt(distance_point_segment(x, start, end).squared);
}

LegImage::LegImage(const IsotropicMedium &medium, const Vec3 &x, const Vec3 &b)
    : origin(mirrored(x)), mirror(medium, origin, outward, mirror_burgers(b)), c(leg_direction(b)),
      of_chi(2 * medium.nu / (1 - medium.nu)), of_psi(-x[2] / (1 - medium.nu)),
      of_lambda(-0.5 * medium.a * medium.a / (1 - medium.nu)), mu(medium.mu), nu(medium.nu)
{
}

SymTensor LegImage::stress(const Vec3 &x) const
{
  const Vec3 r = x - origin;
  const Radii k(r);
  StressSums sums;
  // chi_,ijk has q = -s^2/2, r = s^3/Rb.
  sums.add_tangential(r, of_chi * c, -0.5 * k.s * k.s, k.v * k.s * k.s * k.s, k.psi_q, k.psi_r);
  sums.add_normal(r, of_chi * c, k.lambda_p, k.lambda_q);
  sums.add_tangential(r, of_psi * c, k.psi_q, k.psi_r, k.lambda_q, k.lambda_r);
  sums.add_normal(r, of_psi * c, -k.v3, 3 * k.v5);
  const double v7 = k.v5 * k.v2;
  sums.add_tangential(r, of_lambda * c, k.lambda_q, k.lambda_r, 3 * k.v5, -15 * v7);
  sums.add_normal(r, of_lambda * c, 3 * k.v5 * r[2], -15 * v7 * r[2]);
  return mirror(x) + sums.stress(mu / (2 * std::numbers::pi), nu, x[2]);
}

Vec3 LegImage::displacement(const Vec3 &x) const
{
  const Vec3 r = x - origin;
  const Radii k(r);
  const double cx = c[0] * r[0] + c[1] * r[1];
  // The unit of length in the logarithm is a rigid translation.
  const double chi_p = -0.5 * (r[2] * k.s - std::log(k.s));
  const auto tangential = [&](const int i)
  {
    return of_chi * (chi_p * c[i] - 0.5 * cx * r[i] * k.s * k.s) + of_psi * (-c[i] * k.s + cx * r[i] * k.psi_q) +
           of_lambda * (c[i] * k.lambda_p + cx * r[i] * k.lambda_q);
  };
  const auto with_z = [&](const int i)
  {
    return of_chi * (-c[i] * k.s + cx * r[i] * k.psi_q) + of_psi * (c[i] * k.lambda_p + cx * r[i] * k.lambda_q) +
           of_lambda * (-c[i] * k.v3 + 3 * cx * r[i] * k.v5);
  };
  const DisplacementSums sums{
      tangential(0), tangential(1), cx * (-of_chi * k.s + of_psi * k.lambda_p - of_lambda * k.v3),
      with_z(0),     with_z(1),     cx * (of_chi * k.lambda_p - of_psi * k.v3 + 3 * of_lambda * r[2] * k.v5)};
  return sums.displacement(mu / (2 * std::numbers::pi), mu, nu, x[2]);
}

PiercingImage::PiercingImage(const IsotropicMedium &medium, const Vec3 &x, const Vec3 &b, const double tolerance)
    : origin(x), mirror(medium, x, outward, mirror_burgers(b)), screw(-b[2]), a(medium.a), mu(medium.mu),
      quadrature_tolerance(tolerance)
{
}

PiercingImage::Torsion PiercingImage::torsion(const Vec3 &r) const
{
  const double a2 = a * a, core_depth = 30 * a;
  const bool near = r.squaredNorm() < core_depth * core_depth;
  const Radii k(near ? Vec3(r[0], r[1], r[2] + core_depth) : r);
  Torsion sum{-k.s, k.psi_q, k.lambda_p};
  if (!near)
    return {sum.first + 0.25 * a2 * k.v3, sum.second - 0.75 * a2 * k.v5, sum.shear - 0.75 * a2 * r[2] * k.v5};
  auto singularities = internal::LineSingularities::of_point(r, a, Vec3::Zero(), outward);
  singularities.add(0, a); // branch point of D
  internal::integrate_on_panels(singularities, core_depth, quadrature_tolerance,
                                [&](const double s, const double weight)
                                {
                                  const double depth = std::hypot(s, a), core = 0.5 * a2 / depth;
                                  const Radii e(Vec3(r[0], r[1], r[2] + depth));
                                  sum.first -= weight * (e.lambda_p + core * e.v3);
                                  sum.second -= weight * (e.lambda_q - 3 * core * e.v5);
                                  sum.shear += weight * (e.v3 + 3 * core * (r[2] + depth) * e.v5);
                                });
  return sum;
}

SymTensor PiercingImage::stress(const Vec3 &x) const
{
  const Vec3 r = x - origin;
  const Torsion t = torsion(r);
  const double factor = mu * screw / (2 * std::numbers::pi);
  const double shear = factor * t.shear, plane = factor * t.second;
  SymTensor sigma;
  sigma << 2 * plane * r[0] * r[1], -2 * plane * r[0] * r[1], 0, -plane * (r[0] * r[0] - r[1] * r[1]), shear * r[1],
      -shear * r[0];
  return mirror(x) + sigma;
}

Vec3 PiercingImage::displacement(const Vec3 &x) const
{
  const Vec3 r = x - origin;
  const double factor = screw / (2 * std::numbers::pi) * torsion(r).first;
  return {factor * r[1], -factor * r[0], 0.0};
}
} // namespace ddfem
