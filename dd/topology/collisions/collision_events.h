// Contacts of the network's segments during a step, as events in time.
#pragma once

#include "dd/topology/collisions/candidate_list.h"
#include "dd/topology/topology_context.h"

#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace ddfem
{
/// Two segments come within the capture radius of each other. A segment with itself: it shrinks to nothing.
struct CollisionEvent
{
  double time = 0; ///< of the first contact, in [0, 1] of the step
  ObjectId first_id = 0, second_id = 0;
  SegmentIndex first, second; ///< first_id <= second_id
  double first_fraction = 0, second_fraction = 0;
  double closest_time = 0; ///< when the approach ends
  std::uint64_t stamp = 0; ///< of the detection; stale if a node of either segment has changed since
  bool at_closest = false; ///< second attempt, at the end of the approach

  /// The order in which events are handled; no two events of one detection are equal in it.
  bool operator<(const CollisionEvent &other) const
  {
    return std::tie(time, first_id, second_id) < std::tie(other.time, other.first_id, other.second_id);
  }
};

/// First contact of two different segments (with or without a common node) or of a segment with itself from time @p t on.
std::optional<CollisionEvent> detect(const TopologyContext &context, SegmentIndex a, SegmentIndex b, double t);

/// Where two such segments are nearest at time @p t, as fractions of each.
std::pair<double, double> nearest_fractions(const TopologyContext &context, SegmentIndex a, SegmentIndex b, double t);

/// All contacts of the step: candidate pairs, arms of every node, shrinking segments. Threaded; in the order of events.
std::vector<CollisionEvent> detect_all(const TopologyContext &context, const CandidateList &candidates);

/// A ball that holds a segment from time @p t to the end of the step.
struct SweptBall
{
  Vec3 centre;
  double radius;
};
SweptBall swept_ball(const TopologyContext &context, SegmentIndex s, double t);

/// Contacts of the arms of node @p i, each with everything near it, from time @p t on. Appended in no particular order.
void detect_around(const TopologyContext &context, const CandidateList &candidates, NodeIndex i, double t,
                   std::vector<CollisionEvent> &found);
} // namespace ddfem
