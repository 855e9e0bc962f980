// Merging two lines where they meet.
#pragma once

#include "dd/topology/topology_context.h"

#include <array>
#include <optional>

namespace ddfem
{
/// A point of the network: this fraction of a segment, from its start.
struct LinePoint
{
  SegmentIndex segment;
  double fraction;
};

/// How two points become one node.
struct MergePlan
{
  /// One of the two points.
  struct End
  {
    LinePoint point;
    NodeIndex node;    ///< end of the segment that takes part; invalid: the segment is cut at the point
    Vec3 position;     ///< at the time of the meeting, nm, in the periodic image of `node` or of the segment's start
    Vec3 target;       ///< where it goes, in the same image
    Vec3 displacement; ///< per step, that the point had at the start of the step (zero without tracking), nm
    bool is_cut() const { return !node.is_valid(); }
  };
  std::array<End, 2> ends; ///< the first one is kept
  double time;             ///< of the step
};

/// Plans the meeting at time @p t of the step of two points that are within about a capture radius of each other.
///
/// A point within the capture radius of an end of its segment is that end; otherwise the segment is cut. The common
/// node lies on the glide planes of all lines that it joins, at the point nearest to the middle between the two. Where
/// there is no such point within twice the capture radius, other choices of ends and cuts are tried. Pinned nodes stay
/// where they are. The end of a line at the surface merges only with such an end with which it annihilates. Empty if
/// the two cannot meet.
std::optional<MergePlan> plan_merge(const TopologyContext &context, const LinePoint &first, const LinePoint &second,
                                    double t);

/// Carries the plan out. The common node is recorded at the time of the meeting and does not move any further. Returned
/// even if it is gone from the network because everything there annihilated.
NodeIndex perform_merge(TopologyContext &context, const MergePlan &plan);
} // namespace ddfem
