#include "dd/topology/remesh.h"

#include "dd/topology/line_operations.h"
#include "dd/topology/motion.h"

#include <algorithm>
#include <vector>

namespace ddfem
{
namespace
{
bool should_coarsen(const Network &network, const NodeIndex i, const TopologySettings &settings)
{
  if (!is_discretisation_node(network, i))
    return false;
  const auto arms = network.connected_segments(i);
  const NodeIndex a = network.other_end(arms[0], i), c = network.other_end(arms[1], i);
  const Vec3 &x = network.position(i);
  const Vec3 to_a = network.minimum_image(network.position(a) - x);
  const Vec3 to_c = network.minimum_image(network.position(c) - x);
  if ((to_c - to_a).norm() > settings.max_segment)
    return false;
  const bool short_arm = std::min(to_a.norm(), to_c.norm()) < settings.min_segment;
  // Small area with the arms on one side is a cusp, which the line tension must be left to straighten.
  const bool flat = 0.5 * to_a.cross(to_c).norm() < settings.min_area && to_a.dot(to_c) < 0;
  return short_arm || flat;
}

void coarsen(TopologyContext &context)
{
  Network &network = context.network;
  const std::vector<NodeIndex> nodes(network.nodes().begin(), network.nodes().end());
  for (const NodeIndex i : nodes)
    if (network.contains(i) && should_coarsen(network, i, context.settings))
    {
      remove_node(context, i);
      ++context.counts.coarsenings;
    }
}

void release_short_surface_lines(TopologyContext &context)
{
  Network &network = context.network;
  const std::vector<SegmentIndex> segments(network.segments().begin(), network.segments().end());
  for (const SegmentIndex s : segments)
    if (network.constraint(network.start(s)) == NodeConstraint::surface &&
        network.constraint(network.end(s)) == NodeConstraint::surface &&
        network.length(s) < context.settings.min_segment)
      leave_through_surface(context, s);
}

void refine(TopologyContext &context)
{
  Network &network = context.network;
  const std::vector<SegmentIndex> segments(network.segments().begin(), network.segments().end());
  for (const SegmentIndex s : segments)
    if (network.length(s) > context.settings.max_segment)
    {
      const Vec3 middle = network.position(network.start(s)) + 0.5 * network.direction(s);
      split_segment(context, s, middle, Vec3::Zero());
      ++context.counts.refinements;
    }
}
} // namespace

void remesh(TopologyContext &context)
{
  coarsen(context);
  if (context.shape)
    release_short_surface_lines(context);
  refine(context);
}
} // namespace ddfem
