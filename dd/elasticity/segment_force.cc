#include "dd/elasticity/segment_force.h"

#include "dd/elasticity/panel_quadrature.h"
#include "dd/elasticity/segment_stress.h"

namespace ddfem
{
namespace
{
/// Peach-Koehler force of @p stress on the segment that starts at @p x3 with direction @p t, shared by its nodes.
template <typename Field>
SegmentForces integrate_force(const Field &stress, const internal::LineSingularities &singularities, const Vec3 &x3,
                              const Vec3 &t, double length, const Vec3 &b34, double tolerance)
{
  // (sigma.b) x t is linear in sigma.b: integrate that, and take the cross product once.
  Vec3 total = Vec3::Zero(), first_moment = Vec3::Zero();
  internal::integrate_on_panels(singularities, length, tolerance,
                                [&](double z, double weight)
                                {
                                  const Vec3 traction = weight * contract(stress(x3 + z * t), b34);
                                  total += traction;
                                  first_moment += z * traction;
                                });
  first_moment /= length;
  return {(total - first_moment).cross(t), first_moment.cross(t)};
}
} // namespace

SegmentForces segment_force(const IsotropicMedium &medium, const Vec3 &x1, const Vec3 &x2, const Vec3 &b12,
                            const Vec3 &x3, const Vec3 &x4, const Vec3 &b34, double tolerance)
{
  const double length = (x4 - x3).norm();
  if (length == 0.0)
    return {};
  const Vec3 t = (x4 - x3) / length;
  return integrate_force(SegmentStressField(medium, x1, x2, b12),
                         internal::LineSingularities::of_segment(x1, x2, medium.a, x3, t), x3, t, length, b34,
                         tolerance);
}

SegmentForces segment_force_from_ray(const IsotropicMedium &medium, const Vec3 &origin, const Vec3 &direction,
                                     const Vec3 &b_ray, const Vec3 &x3, const Vec3 &x4, const Vec3 &b34,
                                     double tolerance)
{
  const double length = (x4 - x3).norm();
  if (length == 0.0)
    return {};
  const Vec3 t = (x4 - x3) / length;
  return integrate_force(RayStressField(medium, origin, direction, b_ray),
                         internal::LineSingularities::of_ray(origin, direction, medium.a, x3, t), x3, t, length, b34,
                         tolerance);
}
} // namespace ddfem
