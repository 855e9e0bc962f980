#include "dd/mobility/thermal_force.h"

#include "dd/common/random.h"

#include <cmath>

namespace ddfem
{
namespace
{
/// Six normal numbers of a segment: three for its start, three for its end.
struct EndNumbers
{
  Vec3 start, end;
};

EndNumbers normal_numbers(const Network &network, const SegmentIndex s, const HeatBath &bath)
{
  const CounterRandom random(bath.seed, network.id(s), bath.step, RandomPurpose::thermal_force);
  const auto p = random.normal_pair(0), q = random.normal_pair(1), r = random.normal_pair(2);
  return {Vec3(p[0], p[1], q[0]), Vec3(q[1], r[0], r[1])};
}
} // namespace

std::vector<Vec3> thermal_forces(const Network &network, const EndDrag &end_drag, const HeatBath &bath, const double dt)
{
  std::vector<EndNumbers> ends(network.segment_capacity());
  network.for_each_segment(
      [&](const SegmentIndex s, NodeIndex, NodeIndex)
      {
        const double deviation = std::sqrt(2 * bath.kT * end_drag(s) / dt);
        const EndNumbers numbers = normal_numbers(network, s, bath);
        ends[s.value] = {deviation * numbers.start, deviation * numbers.end};
      });
  std::vector<Vec3> force(network.node_capacity(), Vec3::Zero());
  network.for_each_node_with_segments(
      [&](const NodeIndex i, const std::span<const SegmentIndex> arms)
      {
        for (const SegmentIndex s : arms)
          force[i.value] += network.start(s) == i ? ends[s.value].start : ends[s.value].end;
      });
  return force;
}
} // namespace ddfem
