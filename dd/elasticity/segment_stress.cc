#include "dd/elasticity/segment_stress.h"

#include "dd/elasticity/line_integrals.h"

#include <cmath>
#include <numbers>

namespace ddfem
{
namespace
{
/// prefactor * { u v + v u summed over the two pairs (t, v) and (d, w), plus pressure * I }.
SymTensor combine(double prefactor, const Vec3 &t, const Vec3 &v, const Vec3 &d, const Vec3 &w, double pressure)
{
  SymTensor s;
  s << 2.0 * (t[0] * v[0] + d[0] * w[0]) + pressure, 2.0 * (t[1] * v[1] + d[1] * w[1]) + pressure,
      2.0 * (t[2] * v[2] + d[2] * w[2]) + pressure, t[0] * v[1] + t[1] * v[0] + d[0] * w[1] + d[1] * w[0],
      t[0] * v[2] + t[2] * v[0] + d[0] * w[2] + d[2] * w[0], t[1] * v[2] + t[2] * v[1] + d[1] * w[2] + d[2] * w[1];
  return prefactor * s;
}

/// The formula at the top of the header with R = d - s t inserted (R x b = d x b + s e, R.e = d.e).
/// @p m is 1/(1-nu), @p a2 the square of the core radius.
SymTensor assemble(const internal::StressIntegrals &j, double prefactor, double m, double a2, const Vec3 &d,
                   const Vec3 &t, const Vec3 &e, const Vec3 &b)
{
  const double de = m * d.dot(e);
  const double core = 1.5 * a2;
  const Vec3 v = -(j.j03 + core * j.j05) * d.cross(b) + ((m - 1.0) * j.j13 - core * j.j15) * e -
                 (3.0 * de * j.j15) * d + (1.5 * de * j.j25) * t;
  const Vec3 w = -(m * j.j03) * e + (1.5 * de * j.j05) * d;
  return combine(prefactor, t, v, d, w, de * (j.j03 + 2.0 * core * j.j05));
}

double inverse_or_zero(double length)
{
  return length > 0.0 ? 1.0 / length : 0.0;
}
} // namespace

SegmentStressField::SegmentStressField(const IsotropicMedium &medium, const Vec3 &x1_, const Vec3 &x2_, const Vec3 &b_)
    : x1(x1_), x2(x2_), b(b_), t(x2_ - x1_), length(t.norm()), a2(medium.a * medium.a),
      inverse_one_minus_nu(1.0 / (1.0 - medium.nu)), prefactor(medium.mu / (4.0 * std::numbers::pi))
{
  t *= inverse_or_zero(length);
  e = b.cross(t);
}

SymTensor SegmentStressField::operator()(const Vec3 &x) const
{
  const Vec3 from_x1 = x - x1, from_x2 = x - x2;
  const double s1 = -from_x1.dot(t), s2 = -from_x2.dot(t);
  // The perpendicular is taken from the nearer end: its rounding error is then relative to the smaller distance.
  const bool first_nearer = std::abs(s1) < std::abs(s2);
  const Vec3 d = (first_nearer ? from_x1 : from_x2) + (first_nearer ? s1 : s2) * t;
  const internal::SegmentGeometry geometry(s1, s2, length, d.squaredNorm() + a2);
  return assemble(internal::stress_integrals(geometry), prefactor, inverse_one_minus_nu, a2, d, t, e, b);
}

RayStressField::RayStressField(const IsotropicMedium &medium, const Vec3 &origin_, const Vec3 &direction,
                               const Vec3 &b_)
    : origin(origin_), b(b_), t(direction), e(b_.cross(direction)), a2(medium.a * medium.a),
      inverse_one_minus_nu(1.0 / (1.0 - medium.nu)), prefactor(medium.mu / (4.0 * std::numbers::pi))
{
}

SymTensor RayStressField::operator()(const Vec3 &x) const
{
  const Vec3 from_origin = x - origin;
  const double s = -from_origin.dot(t);
  const Vec3 d = from_origin + s * t;
  const auto integrals = internal::ray_stress_integrals(s, d.squaredNorm() + a2);
  return assemble(integrals, prefactor, inverse_one_minus_nu, a2, d, t, e, b);
}

SymTensor segment_stress(const IsotropicMedium &medium, const Vec3 &x, const Vec3 &x1, const Vec3 &x2, const Vec3 &b)
{
  return SegmentStressField(medium, x1, x2, b)(x);
}

SymTensor ray_stress(const IsotropicMedium &medium, const Vec3 &x, const Vec3 &origin, const Vec3 &direction,
                     const Vec3 &b)
{
  return RayStressField(medium, origin, direction, b)(x);
}
} // namespace ddfem
