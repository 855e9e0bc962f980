#include "dd/forces/virtual_rays.h"

namespace ddfem
{
Vec3 ray_direction(const GrainShape &shape, const RayDirection rule, const Vec3 &x)
{
  if (rule == RayDirection::normal)
    return shape.outward_normal(x);
  return (x - 0.5 * (shape.lower_corner() + shape.upper_corner())).normalized();
}

Vec3 ray_burgers(const Network &network, const NodeIndex i)
{
  Vec3 b = Vec3::Zero();
  for (const SegmentIndex s : network.connected_segments(i))
    b -= network.burgers_from(s, i);
  return b;
}

std::vector<VirtualRay> virtual_rays(const Network &network, const GrainShape &shape, const RayDirection rule)
{
  std::vector<VirtualRay> rays;
  for (const NodeIndex i : network.nodes())
    if (network.constraint(i) == NodeConstraint::surface)
    {
      const Vec3 b = ray_burgers(network, i);
      if (b.squaredNorm() > 0)
        rays.push_back({network.position(i), ray_direction(shape, rule, network.position(i)), b});
    }
  return rays;
}
} // namespace ddfem
