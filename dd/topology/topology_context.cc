#include "dd/topology/topology_context.h"

namespace ddfem
{
void TopologyContext::begin_tracking()
{
  initial_displacement = remaining;
  initial_displacement.resize(network.node_capacity(), Vec3::Zero());
  first_new_segment = network.segment_capacity();
  new_segment_origins.clear();
}

void TopologyContext::end_tracking()
{
  initial_displacement.clear();
  new_segment_origins.clear();
}

SegmentOrigin TopologyContext::origin(const SegmentIndex s) const
{
  if (!is_tracking())
    return {network.id(s), Vec3::Zero(), Vec3::Zero()};
  if (s.value >= first_new_segment)
    return new_segment_origins[s.value - first_new_segment];
  return {network.id(s), initial_displacement[network.start(s).value], initial_displacement[network.end(s).value]};
}

SegmentIndex TopologyContext::insert_segment(const Segment &segment, const SegmentOrigin &origin)
{
  const SegmentIndex s = network.insert(segment);
  if (is_tracking())
    new_segment_origins.push_back(origin);
  return s;
}

NodeIndex TopologyContext::insert_node(const Node &node, Vec3 displacement)
{
  const NodeIndex i = network.insert(node);
  if (remaining.size() <= i.value)
    remaining.resize(i.value + 1, Vec3::Zero());
  remaining[i.value].swap(displacement);
  return i;
}

void TopologyContext::set_time(const NodeIndex i, const double t)
{
  if (recorded_at.size() <= i.value)
    recorded_at.resize(i.value + 1, 0.0);
  recorded_at[i.value] = t;
}

Vec3 TopologyContext::velocity(const NodeIndex i) const
{
  const double left = 1 - time_of(i);
  return left > 0 ? Vec3(remaining[i.value] / left) : Vec3(Vec3::Zero());
}
} // namespace ddfem
