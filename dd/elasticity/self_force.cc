#include "dd/elasticity/self_force.h"

#include <cmath>
#include <numbers>

namespace ddfem
{
namespace
{
/// asinh(u) - 2 (sqrt(1 + u^2) - 1)/u for u > 0; the difference starts with u^3, hence the series.
double logarithm_part(double u)
{
  if (u < 0.03)
  {
    const double u2 = u * u;
    return u * u2 * (1.0 / 12.0 + u2 * (-1.0 / 20.0 + u2 * (15.0 / 448.0 - u2 * (7.0 / 288.0))));
  }
  return std::asinh(u) - 2.0 * u / (std::sqrt(1.0 + u * u) + 1.0);
}

/// mu/(4 pi) ln(a/r_core)/(1 - nu), the factor of b^2 L - nu (b.r)^2/L in the core energy.
double core_prefactor(const IsotropicMedium &medium, const CoreEnergy &core)
{
  return medium.mu / (4.0 * std::numbers::pi * (1.0 - medium.nu)) * std::log(medium.a / core.core_radius_cutoff);
}
} // namespace

SegmentForces self_force(const IsotropicMedium &medium, const Vec3 &x1, const Vec3 &x2, const Vec3 &b)
{
  const double length = (x2 - x1).norm();
  if (length == 0.0)
    return {};
  const Vec3 t = (x2 - x1) / length;
  const double screw = b.dot(t);
  const Vec3 edge = b - screw * t;
  const double la = std::hypot(length, medium.a);
  const double la_minus_a = length * length / (la + medium.a);
  const double shape =
      medium.nu / (1.0 - medium.nu) * logarithm_part(length / medium.a) - la_minus_a * la_minus_a / (2.0 * length * la);
  const Vec3 force = (medium.mu / (4.0 * std::numbers::pi) * screw * shape) * edge;
  return {-force, force};
}

double core_energy(const IsotropicMedium &medium, const CoreEnergy &core, const Vec3 &x1, const Vec3 &x2, const Vec3 &b)
{
  const Vec3 r = x2 - x1;
  const double length = r.norm();
  if (length == 0.0)
    return 0.0;
  const double projection = b.dot(r);
  return core_prefactor(medium, core) * (b.squaredNorm() * length - medium.nu * projection * projection / length);
}

SegmentForces core_force(const IsotropicMedium &medium, const CoreEnergy &core, const Vec3 &x1, const Vec3 &x2,
                         const Vec3 &b)
{
  const Vec3 r = x2 - x1;
  const double length = r.norm();
  if (length == 0.0)
    return {};
  const Vec3 t = r / length;
  const double screw = b.dot(t);
  const Vec3 gradient = core_prefactor(medium, core) *
                        ((b.squaredNorm() + medium.nu * screw * screw) * t - (2.0 * medium.nu * screw) * b);
  return {gradient, -gradient};
}
} // namespace ddfem
