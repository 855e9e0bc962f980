#include "dd/elasticity/segment_force.h"

#include "dd/elasticity/panel_quadrature.h"
#include "dd/elasticity/segment_stress.h"

namespace ddfem
{
namespace
{
/// Peach-Koehler force of @p stress on the segment that starts at @p x3 with direction @p t, shared by its nodes.
/// @p integrate(add) calls add(z, weight) for the points of a rule.
template <typename Field, typename Integrate>
SegmentForces integrate_force(const Field &stress, const Vec3 &x3, const Vec3 &t, double length, const Vec3 &b34,
                              Integrate &&integrate)
{
  // (sigma.b) x t is linear in sigma.b: integrate that, and take the cross product once.
  Vec3 total = Vec3::Zero(), first_moment = Vec3::Zero();
  integrate(
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
  const int n = internal::n_gauss_points_for_segment(x1, x2, medium.a, x3, x4, t, tolerance);
  return integrate_force(SegmentStressField(medium, x1, x2, b12), x3, t, length, b34,
                         [&](const auto &add)
                         {
                           if (n > 0)
                             internal::integrate_on_panel(n, 0.0, length, add);
                           else
                             internal::integrate_graded(
                                 internal::LineSingularities::of_segment(x1, x2, medium.a, x3, t), length, tolerance,
                                 add);
                         });
}

SegmentForces segment_force_from_ray(const IsotropicMedium &medium, const Vec3 &origin, const Vec3 &direction,
                                     const Vec3 &b_ray, const Vec3 &x3, const Vec3 &x4, const Vec3 &b34,
                                     double tolerance)
{
  const double length = (x4 - x3).norm();
  if (length == 0.0)
    return {};
  const Vec3 t = (x4 - x3) / length;
  return integrate_force(RayStressField(medium, origin, direction, b_ray), x3, t, length, b34,
                         [&](const auto &add)
                         {
                           internal::integrate_on_panels(
                               internal::LineSingularities::of_ray(origin, direction, medium.a, x3, t), length,
                               tolerance, add);
                         });
}
} // namespace ddfem
