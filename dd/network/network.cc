#include "dd/network/network.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ddfem
{
namespace
{
/// Next free slot of an array, as an index value.
std::uint32_t next_slot(std::size_t size)
{
  if (size >= NodeIndex::invalid)
    throw std::length_error("The network holds as many objects as a 32-bit index can number.");
  return static_cast<std::uint32_t>(size);
}
} // namespace

const char *name_of(NodeConstraint constraint)
{
  switch (constraint)
  {
    case NodeConstraint::free: return "free";
    case NodeConstraint::pinned: return "pinned";
    case NodeConstraint::surface: return "surface";
  }
  return "unknown";
}

std::optional<NodeIndex> Network::find_node(ObjectId id) const
{
  const auto found = node_of_id_.find(id);
  return found == node_of_id_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<SegmentIndex> Network::find_segment(ObjectId id) const
{
  const auto found = segment_of_id_.find(id);
  return found == segment_of_id_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<SegmentIndex> Network::find(NodeIndex a, NodeIndex b) const
{
  if (!contains(a) || !contains(b) || a == b)
    return {};
  for (const SegmentIndex s : connected_segments(a))
    if (other_end(s, a) == b)
      return s;
  return {};
}

void Network::reserve(std::size_t n_nodes, std::size_t n_segments)
{
  position_.reserve(n_nodes);
  constraint_.reserve(n_nodes);
  node_id_.reserve(n_nodes);
  node_alive_.reserve(n_nodes);
  arms_.reserve(n_nodes);
  node_of_id_.reserve(n_nodes);
  live_nodes_.reserve(n_nodes);

  start_.reserve(n_segments);
  end_.reserve(n_segments);
  burgers_.reserve(n_segments);
  plane_.reserve(n_segments);
  segment_id_.reserve(n_segments);
  segment_alive_.reserve(n_segments);
  segment_of_id_.reserve(n_segments);
  live_segments_.reserve(n_segments);
}

NodeIndex Network::insert(const Node &node)
{
  return insert(node, next_node_id_);
}

NodeIndex Network::insert(const Node &node, ObjectId id)
{
  const NodeIndex i{next_slot(position_.size())};
  if (!node_of_id_.try_emplace(id, i).second)
    throw std::invalid_argument("A node with id " + std::to_string(id) + " exists already.");
  position_.push_back(node.position);
  constraint_.push_back(node.constraint);
  node_id_.push_back(id);
  node_alive_.push_back(1);
  arms_.emplace_back();
  live_nodes_.append(i);
  next_node_id_ = std::max(next_node_id_, id + 1);
  return i;
}

SegmentIndex Network::insert(const Segment &segment)
{
  return insert(segment, next_segment_id_);
}

SegmentIndex Network::insert(const Segment &segment, ObjectId id)
{
  if (!contains(segment.start) || !contains(segment.end))
    throw std::invalid_argument("Segment " + std::to_string(id) + " cannot be inserted: an end node does not exist.");
  if (segment.start == segment.end)
    throw std::invalid_argument("Segment " + std::to_string(id) + " cannot be inserted: it would join " +
                                describe(segment.start) + " to itself.");
  if (find(segment.start, segment.end))
    throw std::invalid_argument("Segment " + std::to_string(id) + " cannot be inserted: " + describe(segment.start) +
                                " and " + describe(segment.end) + " are joined already.");
  if (segment.plane.is_valid() && segment.plane.value >= planes_.size())
    throw std::invalid_argument("Segment " + std::to_string(id) + " cannot be inserted: its glide plane is unknown.");
  const SegmentIndex s{next_slot(start_.size())};
  if (!segment_of_id_.try_emplace(id, s).second)
    throw std::invalid_argument("A segment with id " + std::to_string(id) + " exists already.");
  start_.push_back(segment.start);
  end_.push_back(segment.end);
  burgers_.push_back(segment.burgers);
  plane_.push_back(segment.plane);
  segment_id_.push_back(id);
  segment_alive_.push_back(1);
  arms_[segment.start.value].append(s);
  arms_[segment.end.value].append(s);
  live_segments_.append(s);
  next_segment_id_ = std::max(next_segment_id_, id + 1);
  return s;
}

void Network::require(NodeIndex i) const
{
  if (!contains(i))
    throw std::out_of_range("Node index " + std::to_string(i.value) + " names no live node.");
}

void Network::require(SegmentIndex s) const
{
  if (!contains(s))
    throw std::out_of_range("Segment index " + std::to_string(s.value) + " names no live segment.");
}

void Network::erase(NodeIndex i)
{
  require(i);
  if (degree(i) != 0)
    throw std::invalid_argument(describe(i) + " cannot be erased: " + std::to_string(degree(i)) +
                                " segments are connected to it.");
  node_of_id_.erase(id(i));
  node_alive_[i.value] = 0;
  live_nodes_.mark_erased();
}

void Network::erase(SegmentIndex s)
{
  require(s);
  arms_[start(s).value].remove(s);
  arms_[end(s).value].remove(s);
  segment_of_id_.erase(id(s));
  segment_alive_[s.value] = 0;
  live_segments_.mark_erased();
}

void Network::set_next_ids(ObjectId node, ObjectId segment)
{
  if (node < next_node_id_ || segment < next_segment_id_)
    throw std::invalid_argument("Ids are never reused: the next ids must be at least " + std::to_string(next_node_id_) +
                                " (node) and " + std::to_string(next_segment_id_) + " (segment).");
  next_node_id_ = node;
  next_segment_id_ = segment;
}

Node Network::get(NodeIndex i) const
{
  return {position(i), constraint(i)};
}

Segment Network::get(SegmentIndex s) const
{
  return {start(s), end(s), burgers(s), plane(s)};
}

Node Network::at(NodeIndex i) const
{
  require(i);
  return get(i);
}

Segment Network::at(SegmentIndex s) const
{
  require(s);
  return get(s);
}

void Network::set(NodeIndex i, const Node &node)
{
  require(i);
  position_[i.value] = node.position;
  constraint_[i.value] = node.constraint;
}

void Network::set(SegmentIndex s, const Segment &segment)
{
  require(s);
  if (segment.start != start(s) || segment.end != end(s))
    throw std::invalid_argument("set() cannot move " + describe(s) + " to other nodes: erase and insert it.");
  if (segment.plane.is_valid() && segment.plane.value >= planes_.size())
    throw std::invalid_argument("set() was given an unknown glide plane for " + describe(s) + ".");
  burgers_[s.value] = segment.burgers;
  plane_[s.value] = segment.plane;
}

bool Network::is_physical(NodeIndex i) const
{
  if (degree(i) != 2 || constraint(i) != NodeConstraint::free)
    return true;
  const SegmentIndex s = connected_segments(i)[0], t = connected_segments(i)[1];
  if ((burgers_from(s, i) + burgers_from(t, i)).norm() > 1e-6 * burgers(s).norm())
    return true;
  if (plane(s) == plane(t))
    return false;
  // Two parallel planes that hold the same node are one plane (or one and its image in a periodic cell).
  return !plane(s).is_valid() || !plane(t).is_valid() || !planes_.parallel(plane(s), plane(t));
}

void Network::set_period(const Vec3 &period)
{
  if (!period.allFinite() || period.minCoeff() < 0)
    throw std::invalid_argument("The period of a network must be finite and not negative (zero: not periodic).");
  period_ = period;
  is_periodic_ = period.maxCoeff() > 0;
}

Vec3 Network::minimum_image(const Vec3 &d) const
{
  Vec3 image = d;
  for (int axis = 0; axis < 3; ++axis)
    if (period_[axis] > 0)
      image[axis] -= period_[axis] * std::round(d[axis] / period_[axis]);
  return image;
}
} // namespace ddfem
