// The slow part of the forces over a step.
#pragma once

#include "dd/forces/near_forces.h"

#include <vector>

namespace ddfem
{
/// What NearForces leaves of the forces on segments, at the start of a step and at its end, linear in time between. They are
/// Peach-Koehler forces, f = g x t with the line t from end to end: kept is the part of g across the line, so that forces turn and grow with the segment, and
/// gliding segments feel a constant resolved stress.
class FarForces
{
public:
  /// @p all: forces on the ends of the segments, MPa nm^2, by SegmentIndex::value, with the nodes where they are.
  void set_start(const Network &network, const NearForces &near, const std::vector<SegmentForces> &all);
  void set_end(const Network &network, const NearForces &near, const std::vector<SegmentForces> &all);
  /// Those of the start, constant.
  FarForces without_end() const;

  /// At @p time, a part of the step.
  SegmentForces on(const Network &network, SegmentIndex s, double time) const;

private:
  /// g of the two ends, MPa nm.
  static std::vector<SegmentForces> per_line(const Network &network, const NearForces &near,
                                             const std::vector<SegmentForces> &all);
  std::vector<SegmentForces> start, end; ///< by SegmentIndex::value
};
} // namespace ddfem
