#include "dd/topology/remesh.h"

#include "dd/topology/line_operations.h"
#include "dd/topology/surface_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace ddfem
{
namespace
{
/// A discretisation node and its two neighbours.
struct Corner
{
  NodeIndex node, a, c;
  Vec3 to_a, to_c; ///< nm

  double area() const { return 0.5 * to_a.cross(to_c).norm(); }
  double joined() const { return (to_c - to_a).norm(); }
  double shorter() const { return std::min(to_a.norm(), to_c.norm()); }
  double longer() const { return std::max(to_a.norm(), to_c.norm()); }
};

Vec3 arm(const Network &network, const NodeIndex from, const NodeIndex to)
{
  return network.minimum_image(network.position(to) - network.position(from));
}

Corner corner_at(const Network &network, const NodeIndex i)
{
  const auto arms = network.connected_segments(i);
  const NodeIndex a = network.other_end(arms[0], i), c = network.other_end(arms[1], i);
  return {i, a, c, arm(network, i, a), arm(network, i, c)};
}

/// The longest segment that joins two with one shorter than L_min.
double longest_after_short(const TopologySettings &settings)
{
  return std::min(2 * settings.min_segment, 0.9 * settings.max_segment);
}

/// The longest segment that joins two in a straight piece of line.
double longest_after_flat(const TopologySettings &settings)
{
  return std::min(2.0 / 3.0 * settings.max_segment, settings.max_segment - settings.min_segment);
}

/// Area of the triangle at node @p i if its neighbour @p gone were replaced by @p instead; zero at physical nodes.
double area_with(const Network &network, const NodeIndex i, const NodeIndex gone, const NodeIndex instead)
{
  if (!is_discretisation_node(network, i))
    return 0;
  Corner corner = corner_at(network, i);
  if (corner.a != gone)
    std::swap(corner.to_a, corner.to_c);
  corner.to_a = arm(network, i, instead);
  return corner.area();
}

bool is_flat(const Network &network, const Corner &corner, const TopologySettings &settings)
{
  // A small area with the arms on one side is a cusp, which the line tension must be left to straighten.
  return corner.area() < settings.min_area && corner.to_a.dot(corner.to_c) < 0 &&
         corner.joined() <= longest_after_flat(settings) &&
         area_with(network, corner.a, corner.node, corner.c) <= settings.max_area &&
         area_with(network, corner.c, corner.node, corner.a) <= settings.max_area;
}

/// Moves the node along its longer arm to where both are equally long.
void balance(TopologyContext &context, const Corner &corner)
{
  const double a = corner.to_a.norm(), c = corner.to_c.norm();
  const Vec3 &along = a > c ? corner.to_a : corner.to_c;
  const double fraction = 0.5 * (1 - std::min(a, c) / std::max(a, c));
  move_node(context, corner.node, context.network.position(corner.node) + fraction * along);
}

/// Whether the network has been changed.
bool improve(TopologyContext &context, const Corner &corner)
{
  const Network &network = context.network;
  const TopologySettings &settings = context.settings;
  const bool too_short = corner.shorter() < settings.min_segment;
  // An arm of no length has no direction either; nothing moves when it goes.
  const bool vanished = corner.shorter() < 1e-3 * settings.min_segment;
  if (vanished || (too_short && corner.joined() <= longest_after_short(settings)) || is_flat(network, corner, settings))
  {
    remove_node(context, corner.node);
    ++context.counts.coarsenings;
    return true;
  }
  // An arm that gains less than a tenth is left alone: moving the node to and fro would only sweep area.
  const double balanced = 0.5 * (corner.shorter() + corner.longer());
  if (!too_short || corner.to_a.dot(corner.to_c) >= 0 || balanced < 1.1 * corner.shorter())
    return false;
  balance(context, corner);
  return true;
}

/// The nodes whose state depends on node @p i: itself, its neighbours and theirs.
void append_surroundings(const Network &network, const NodeIndex i, std::vector<NodeIndex> &nodes)
{
  if (!network.contains(i))
    return;
  nodes.push_back(i);
  for (const SegmentIndex s : network.connected_segments(i))
  {
    const NodeIndex neighbour = network.other_end(s, i);
    nodes.push_back(neighbour);
    for (const SegmentIndex t : network.connected_segments(neighbour))
      nodes.push_back(network.other_end(t, neighbour));
  }
}

void coarsen(TopologyContext &context)
{
  Network &network = context.network;
  std::vector<NodeIndex> nodes(network.nodes().begin(), network.nodes().end());
  while (!nodes.empty())
  {
    std::vector<NodeIndex> again;
    for (const NodeIndex i : nodes)
      if (network.contains(i) && is_discretisation_node(network, i))
        if (const Corner corner = corner_at(network, i); improve(context, corner))
          for (const NodeIndex neighbour : {corner.a, corner.c})
            append_surroundings(network, neighbour, again);
    std::ranges::sort(again, {}, &NodeIndex::value);
    again.erase(std::unique(again.begin(), again.end()), again.end());
    nodes = std::move(again);
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

bool is_sharply_bent(const Network &network, const NodeIndex i, const TopologySettings &settings)
{
  return is_discretisation_node(network, i) && corner_at(network, i).area() > settings.max_area;
}

/// Into how many parts a segment is to be divided.
unsigned parts_of(const Network &network, const SegmentIndex s, const TopologySettings &settings)
{
  const double length = network.length(s);
  if (length > settings.max_segment)
    return static_cast<unsigned>(std::ceil(length / settings.max_segment));
  const bool bent = length > 3 * settings.min_segment && (is_sharply_bent(network, network.start(s), settings) ||
                                                          is_sharply_bent(network, network.end(s), settings));
  return bent ? 2 : 1;
}

void divide(TopologyContext &context, SegmentIndex s, const unsigned parts)
{
  Network &network = context.network;
  const NodeIndex end = network.end(s);
  const Vec3 start = network.position(network.start(s)), step = network.direction(s) / parts;
  for (unsigned k = 1; k < parts; ++k)
  {
    const NodeIndex m = split_segment(context, s, start + k * step, Vec3::Zero());
    s = *network.find(m, end);
    ++context.counts.refinements;
  }
}

/// One pass over the segments; whether any was divided.
bool refine_once(TopologyContext &context)
{
  Network &network = context.network;
  const std::vector<SegmentIndex> segments(network.segments().begin(), network.segments().end());
  std::vector<unsigned> parts(segments.size());
  for (std::size_t k = 0; k < segments.size(); ++k) // decided before anything changes: the order does not matter
    parts[k] = parts_of(network, segments[k], context.settings);
  bool any = false;
  for (std::size_t k = 0; k < segments.size(); ++k)
    if (parts[k] > 1)
    {
      divide(context, segments[k], parts[k]);
      any = true;
    }
  return any;
}

void refine(TopologyContext &context)
{
  while (refine_once(context)) // the pieces may still be long for the bend
  {
  }
}
} // namespace

void remesh(TopologyContext &context)
{
  if (context.shape)
    release_short_surface_lines(context);
  refine(context);
  coarsen(context);
  if (!context.shape)
    return;
  settle_at_surface(context);
  release_short_surface_lines(context); // lines that have lost their last interior node
}
} // namespace ddfem
