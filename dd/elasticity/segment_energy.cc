#include "dd/elasticity/segment_energy.h"

#include "dd/elasticity/line_stress-inl.h"
#include "dd/elasticity/panel_quadrature.h"

#include <cmath>
#include <numbers>

namespace ddfem
{
double segment_interaction_energy(const IsotropicMedium &medium, const Vec3 &x1, const Vec3 &x2, const Vec3 &b12,
                                  const Vec3 &x3, const Vec3 &x4, const Vec3 &b34, double tolerance)
{
  const double length12 = (x2 - x1).norm(), length34 = (x4 - x3).norm();
  if (length12 == 0.0 || length34 == 0.0)
    return 0.0;
  const Vec3 t12 = (x2 - x1) / length12, t34 = (x4 - x3) / length34;
  const Vec3 e12 = b12.cross(t12), e34 = b34.cross(t34);
  const double laplacian_factor = 0.5 * b12.dot(t12) * b34.dot(t34) - b12.cross(b34).dot(t12.cross(t34));
  const double hessian_factor = 1.0 / (1.0 - medium.nu), a2 = medium.a * medium.a;

  double energy = 0.0;
  const auto add = [&](double z, double weight)
  {
    const Vec3 x = x3 + z * t34;
    const double s1 = (x1 - x).dot(t12), s2 = (x2 - x).dot(t12);
    const Vec3 d = std::abs(s1) < std::abs(s2) ? Vec3(x - x1 + s1 * t12) : Vec3(x - x2 + s2 * t12);
    const HWY_NAMESPACE::SegmentGeometry<double> geometry(s1, s2, length12, d.squaredNorm() + a2);
    const double j01 = std::log1p(geometry.of_j01()), j03 = geometry.j03();
    // e12 . (I/R_a - R R/R_a^3) . e34 with R = d - s t12 and e12.t12 = 0.
    const double hessian = e12.dot(e34) * j01 - d.dot(e12) * (d.dot(e34) * j03 - t12.dot(e34) * geometry.j13());
    energy += weight * (laplacian_factor * (2.0 * j01 + a2 * j03) + hessian_factor * hessian);
  };
  internal::integrate_on_panels(internal::LineSingularities::of_segment(x1, x2, medium.a, x3, t34), length34, tolerance,
                                add);
  return medium.mu / (4.0 * std::numbers::pi) * energy;
}

double segment_self_energy(const IsotropicMedium &medium, const Vec3 &x1, const Vec3 &x2, const Vec3 &b)
{
  const double length = (x2 - x1).norm();
  if (length == 0.0)
    return 0.0;
  const double screw = b.dot(x2 - x1) / length;
  const double screw2 = screw * screw, edge2 = b.cross(x2 - x1).squaredNorm() / (length * length);
  const double logarithm = length * std::asinh(length / medium.a);
  const double la_minus_a = length * length / (std::hypot(length, medium.a) + medium.a);
  return medium.mu / (4.0 * std::numbers::pi) *
         (screw2 * (logarithm - 0.5 * la_minus_a) + edge2 / (1.0 - medium.nu) * (logarithm - la_minus_a));
}
} // namespace ddfem
