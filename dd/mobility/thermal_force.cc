#include "dd/mobility/thermal_force.h"

#include "dd/common/random.h"

#include <array>
#include <cmath>
#include <numbers>

namespace ddfem
{
namespace
{
/// Two independent vectors of normal numbers of segment @p s.
std::array<Vec3, 2> normal_vectors(const Network &network, const SegmentIndex s, const HeatBath &bath)
{
  const CounterRandom random(bath.seed, network.id(s), bath.step, RandomPurpose::thermal_force);
  const auto p = random.normal_pair(0), q = random.normal_pair(1), r = random.normal_pair(2);
  return {Vec3(p[0], p[1], q[0]), Vec3(q[1], r[0], r[1])};
}

/// Part of the first of the two forces of a segment that its start takes; its end takes as much of the second.
double near_share(const DragMatrix matrix)
{
  return matrix == DragMatrix::lumped ? 1 : 0.5 + 0.5 / std::numbers::sqrt3;
}
} // namespace

std::vector<Vec3> thermal_forces(const Network &network, const SegmentDrag &drag, const DragMatrix matrix,
                                 const HeatBath &bath, const double dt)
{
  const double share = near_share(matrix);
  std::vector<std::array<Vec3, 2>> ends(network.segment_capacity());
  network.for_each_segment(
      [&](const SegmentIndex s, NodeIndex, NodeIndex)
      {
        const LineDrag of_segment = drag(s);
        const double across = std::sqrt(bath.kT * of_segment.across / dt),
                     along = std::sqrt(bath.kT * of_segment.along / dt);
        const Vec3 xi = network.direction(s).normalized();
        std::array<Vec3, 2> force = normal_vectors(network, s, bath);
        for (Vec3 &f : force)
          f = across * f + (along - across) * xi.dot(f) * xi;
        ends[s.value] = {share * force[0] + (1 - share) * force[1], (1 - share) * force[0] + share * force[1]};
      });
  std::vector<Vec3> force(network.node_capacity(), Vec3::Zero());
  network.for_each_node_with_segments(
      [&](const NodeIndex i, const std::span<const SegmentIndex> arms)
      {
        for (const SegmentIndex s : arms)
          force[i.value] += ends[s.value][network.start(s) == i ? 0 : 1];
      });
  return force;
}
} // namespace ddfem
