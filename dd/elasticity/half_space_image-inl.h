// Image fields under a free surface (see half_space_image.h), for one point or a vector of them.

#if defined(DDFEM_DD_ELASTICITY_HALF_SPACE_IMAGE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DDFEM_DD_ELASTICITY_HALF_SPACE_IMAGE_INL_H
#undef DDFEM_DD_ELASTICITY_HALF_SPACE_IMAGE_INL_H
#else
#define DDFEM_DD_ELASTICITY_HALF_SPACE_IMAGE_INL_H
#endif

#include "dd/elasticity/half_space_image.h"
#include "dd/elasticity/triangle_displacement-inl.h"

#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace ddfem::HWY_NAMESPACE
{
/// Rb, Rb + Z and the coefficients of the derivatives of psi, Lambda and V = 1/Rb. With X a vector in the surface,
/// tangential derivatives are
///   f_,ij = p delta_ij + q X_i X_j,   f_,ijk = q (delta_ij X_k + delta_ik X_j + delta_jk X_i) + r X_i X_j X_k.
template <class T> struct Radii
{
  T v, s;         ///< 1/Rb, 1/(Rb + Z)
  T v2, v3, v5;   ///< powers of 1/Rb
  T psi_q, psi_r; ///< of psi; psi_,i = -X_i s
  T lambda_p, lambda_q, lambda_r;

  explicit HWY_INLINE Radii(const Vector<T> &x)
  {
    const T radius = sqrt(dot(x, x)), below = radius + x.z;
    const T inverse = T(1.0) / (radius * below); // one division for both
    v = inverse * below;
    s = inverse * radius;
    v2 = v * v;
    v3 = v2 * v;
    v5 = v3 * v2;
    psi_q = v * s * s;
    psi_r = -(v2 * s * s * (v + T(2.0) * s));
    lambda_p = v * s;
    lambda_q = -(v2 * s * (v + s));
    lambda_r = v3 * s * (T(3.0) * v2 + T(3.0) * v * s + T(2.0) * s * s);
  }
};

/// Derivatives of a harmonic function phi that its stress needs; phi_,zz and phi_,zzz follow from Laplace's equation.
template <class T> struct StressSums
{
  T xx, yy, xy;              ///< phi_,ij
  T xxz, yyz, xyz, xzz, yzz; ///< phi_,ijz, phi_,izz

  /// d_c f for a function f with tangential third derivatives (q, r); third with z: those of its z-derivative.
  HWY_INLINE void add_tangential(const Vector<T> &x, const Vector<T> &c, const T &q, const T &r, const T &qz,
                                 const T &rz)
  {
    const T two(2.0), cx = c.x * x.x + c.y * x.y;
    const T cxx = two * c.x * x.x + cx, cyy = two * c.y * x.y + cx, cxy = c.x * x.y + c.y * x.x;
    const T x2 = cx * x.x * x.x, y2 = cx * x.y * x.y, x1y1 = cx * x.x * x.y;
    xx += q * cxx + r * x2;
    yy += q * cyy + r * y2;
    xy += q * cxy + r * x1y1;
    xxz += qz * cxx + rz * x2;
    yyz += qz * cyy + rz * y2;
    xyz += qz * cxy + rz * x1y1;
  }

  /// phi_,izz of d_c f with f_,zz,ij = p delta_ij + q X_i X_j.
  HWY_INLINE void add_normal(const Vector<T> &x, const Vector<T> &c, const T &p, const T &q)
  {
    const T cx = c.x * x.x + c.y * x.y;
    xzz += p * c.x + q * cx * x.x;
    yzz += p * c.y + q * cx * x.y;
  }

  /// (c . grad) psi + (along . grad) Lambda at x relative to the mirrored source point.
  HWY_INLINE void add_element(const Vector<T> &x, const Vector<T> &c, const Vector<T> &along)
  {
    const Radii<T> k(x);
    const T three(3.0), v7_15 = T(15.0) * k.v5 * k.v2, v5_3 = three * k.v5, z = x.z;
    add_tangential(x, c, k.psi_q, k.psi_r, k.lambda_q, k.lambda_r);
    add_normal(x, c, -k.v3, v5_3);
    // Lambda: tangential derivatives, and V_,ij from its z-derivative.
    add_tangential(x, along, k.lambda_q, k.lambda_r, v5_3, -v7_15);
    add_normal(x, along, v5_3 * z, -(v7_15 * z));
    const T ez = along.z, ezz = ez * z;
    xx += ez * (v5_3 * x.x * x.x - k.v3);
    yy += ez * (v5_3 * x.y * x.y - k.v3);
    xy += ez * v5_3 * x.x * x.y;
    xxz += ezz * (v5_3 - v7_15 * x.x * x.x);
    yyz += ezz * (v5_3 - v7_15 * x.y * x.y);
    xyz += -(ezz * v7_15 * x.x * x.y);
    const T zzz = ez * (v5_3 - v7_15 * z * z);
    xzz += zzz * x.x;
    yzz += zzz * x.y;
  }

  /// Adds the stress of `factor` phi at depth @p z, MPa.
  HWY_INLINE void add_stress_to(Tensor<T> &sigma, const T &factor, const T &nu, const T &z) const
  {
    const T zz = -(xx + yy), zzz = -(xxz + yyz), two_nu = T(2.0) * nu;
    sigma.xx += factor * (xx + two_nu * yy + z * xxz);
    sigma.yy += factor * (yy + two_nu * xx + z * yyz);
    sigma.zz += factor * (z * zzz - zz);
    sigma.xy += factor * ((T(1.0) - two_nu) * xy + z * xyz);
    sigma.xz += factor * (z * xzz);
    sigma.yz += factor * (z * yzz);
  }
};

/// Derivatives of phi that its displacement needs.
template <class T> struct DisplacementSums
{
  T x, y, z, xz, yz, zz;

  /// As StressSums::add_element().
  HWY_INLINE void add_element(const Vector<T> &r, const Vector<T> &c, const Vector<T> &along)
  {
    const Radii<T> k(r);
    const T three(3.0), v5_3 = three * k.v5, cx = c.x * r.x + c.y * r.y, ex = along.x * r.x + along.y * r.y;
    const T ez = along.z, depth = r.z;
    const T tangential = cx * k.psi_q + ex * k.lambda_q - ez * k.v3;
    const T with_z = cx * k.lambda_q + v5_3 * (ex + ez * depth);
    x += along.x * k.lambda_p - c.x * k.s + tangential * r.x;
    y += along.y * k.lambda_p - c.y * k.s + tangential * r.y;
    xz += c.x * k.lambda_p - along.x * k.v3 + with_z * r.x;
    yz += c.y * k.lambda_p - along.y * k.v3 + with_z * r.y;
    z += cx * k.lambda_p - (ex + ez * depth) * k.v3;
    zz += v5_3 * depth * (ex + ez * depth) - (cx + ez) * k.v3;
  }

  /// Displacement of `factor` phi at @p depth, nm.
  HWY_INLINE Vector<T> displacement(const double factor, const double mu, const double nu, const T &depth) const
  {
    const T half(factor / (2 * mu)), planar(1 - 2 * nu), normal(-2 * (1 - nu));
    return {half * (planar * x + depth * xz), half * (planar * y + depth * yz), half * (normal * z + depth * zz)};
  }
};

/// The element of the line at @p position (0 to 1) as seen from @p x, times @p weight (nm).
template <class T, template <class> class Sums>
HWY_INLINE void add_image_element(const SegmentImageData &d, const Vector<T> &x, const T &position, const T &weight,
                                  Sums<T> &sums)
{
  const T s = position * T(d.length), zero(0.0);
  const Vector<T> source = vector_of<T>(d.start) + s * vector_of<T>(d.t);
  const T depth = sqrt(source.z * source.z + T(d.medium.a * d.medium.a));
  const T over_depth = select(zero < depth, T(1.0) / depth, T(1.0));
  const Vector<T> r{x.x - source.x, x.y - source.y, x.z + depth};
  const Vector<T> along{depth * T(d.e[0]) + over_depth * T(d.core[0]), depth * T(d.e[1]) + over_depth * T(d.core[1]),
                        -(source.z * T(d.e[2]))};
  sums.add_element(r, weight * vector_of<T>(d.c), weight * along);
}

/// The image of the line itself.
template <class T> HWY_INLINE Line<T> mirror_of(const SegmentImageData &d)
{
  return {vector_of<T>(d.start),   vector_of<T>(d.end),  vector_of<T>(d.t),
          vector_of<T>(d.burgers), vector_of<T>(d.edge), T(d.length)};
}

/// The stress of a ray along -z that starts at @p origin.
template <class T>
HWY_INLINE Tensor<T> outward_ray(const IsotropicMedium &medium, const Vec3 &origin, const Vec3 &b, const Vector<T> &x)
{
  const Vec3 t = -Vec3::UnitZ(), e = b.cross(t);
  const Line<T> ray{vector_of<T>(origin), {}, vector_of<T>(t), vector_of<T>(b), vector_of<T>(e), T(0.0)};
  return stress_of(medium, ray_stress_terms(StressConstants<T>(medium), ray, x), ray.t);
}

template <class T> HWY_INLINE Tensor<T> stress_of(const LegImageData &d, const Vector<T> &x)
{
  Tensor<T> sigma = outward_ray(d.medium, d.origin, d.burgers, x);
  const Vector<T> r = x - vector_of<T>(d.origin), c = vector_of<T>(d.c);
  const Radii<T> k(r);
  const T v5_3 = T(3.0) * k.v5, v7_15 = T(15.0) * k.v5 * k.v2;
  const Vector<T> chi = T(d.of_chi) * c, psi = T(d.of_psi) * c, lambda = T(d.of_lambda) * c;
  StressSums<T> sums{};
  // chi_,ijk has q = -s^2/2, r = s^3/Rb.
  sums.add_tangential(r, chi, T(-0.5) * k.s * k.s, k.v * k.s * k.s * k.s, k.psi_q, k.psi_r);
  sums.add_normal(r, chi, k.lambda_p, k.lambda_q);
  sums.add_tangential(r, psi, k.psi_q, k.psi_r, k.lambda_q, k.lambda_r);
  sums.add_normal(r, psi, -k.v3, v5_3);
  sums.add_tangential(r, lambda, k.lambda_q, k.lambda_r, v5_3, -v7_15);
  sums.add_normal(r, lambda, v5_3 * r.z, -(v7_15 * r.z));
  sums.add_stress_to(sigma, T(d.medium.mu / (2 * std::numbers::pi)), T(d.medium.nu), x.z);
  return sigma;
}

template <class T> HWY_INLINE Vector<T> displacement_of(const LegImageData &d, const Vector<T> &x)
{
  const Vector<T> r = x - vector_of<T>(d.origin), c = vector_of<T>(d.c);
  const Radii<T> k(r);
  const T of_chi(d.of_chi), of_psi(d.of_psi), of_lambda(d.of_lambda), cx = c.x * r.x + c.y * r.y;
  // The unit of length in the logarithm is a rigid translation. The constant makes chi harmonic.
  const T chi_p = T(0.25) - T(0.5) * (r.z * k.s - log(k.s));
  const T of_c = of_chi * chi_p - of_psi * k.s + of_lambda * k.lambda_p;
  const T of_r = cx * (of_psi * k.psi_q + of_lambda * k.lambda_q - T(0.5) * of_chi * k.s * k.s);
  const T of_c_z = of_psi * k.lambda_p - of_chi * k.s - of_lambda * k.v3;
  const T of_r_z = cx * (of_chi * k.psi_q + of_psi * k.lambda_q + T(3.0) * of_lambda * k.v5);
  const DisplacementSums<T> sums{of_c * c.x + of_r * r.x,
                                 of_c * c.y + of_r * r.y,
                                 cx * of_c_z,
                                 of_c_z * c.x + of_r_z * r.x,
                                 of_c_z * c.y + of_r_z * r.y,
                                 cx * (of_chi * k.lambda_p - of_psi * k.v3 + T(3.0) * of_lambda * r.z * k.v5)};
  return sums.displacement(d.medium.mu / (2 * std::numbers::pi), d.medium.mu, d.medium.nu, x.z);
}

/// Of the function psi of the torsion at X: psi_,i = first X_i, psi_,xy = second X Y, psi_,iz = shear X_i.
template <class T> struct Torsion
{
  T first, second, shear;
};

/// Farther than core_distance() from the point @p r is relative to.
template <class T> HWY_INLINE Torsion<T> far_torsion(const PiercingImageData &d, const Vector<T> &r)
{
  const Radii<T> k(r);
  const T a2(d.medium.a * d.medium.a), core = T(0.75) * a2 * k.v5;
  return {T(0.25) * a2 * k.v3 - k.s, k.psi_q - core, k.lambda_p - core * r.z};
}

template <class T>
HWY_INLINE Tensor<T> stress_of(const PiercingImageData &d, const Vector<T> &x, const Torsion<T> &torsion)
{
  Tensor<T> sigma = outward_ray(d.medium, d.origin, d.burgers, x);
  const Vector<T> r = x - vector_of<T>(d.origin);
  const T factor(d.medium.mu * d.screw / (2 * std::numbers::pi));
  const T shear = factor * torsion.shear, plane = factor * torsion.second, xy = T(2.0) * plane * r.x * r.y;
  sigma.xx += xy;
  sigma.yy += -xy;
  sigma.xy += plane * (r.y * r.y - r.x * r.x);
  sigma.xz += shear * r.y;
  sigma.yz += -(shear * r.x);
  return sigma;
}

template <class T>
HWY_INLINE Vector<T> displacement_of(const PiercingImageData &d, const Vector<T> &x, const Torsion<T> &torsion)
{
  const Vector<T> r = x - vector_of<T>(d.origin);
  const T factor = T(d.screw / (2 * std::numbers::pi)) * torsion.first;
  return {factor * r.y, -(factor * r.x), T(0.0)};
}
} // namespace ddfem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
