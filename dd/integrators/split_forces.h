// The forces of the equation of motion in two parts.
#pragma once

#include "dd/forces/near_forces.h"

#include <functional>
#include <vector>

namespace ddfem
{
/// What the near forces err by is among the far ones and stays there during the step: they need not be accurate, only vary as they should.
inline constexpr double near_pair_tolerance = 1e-2;

/// What subcycling needs besides EquationOfMotion::velocity: the near forces of single segments, and the velocities of single nodes.
class SplitForces
{
public:
  NearForceSettings settings;
  SymTensor applied = SymTensor::Zero(); ///< uniform part of the stress, MPa
  std::vector<double> drag;              ///< of the nodes, MPa ns nm, by NodeIndex::value
  /// All forces on the ends of the segments, by SegmentIndex::value, MPa nm^2, of the last call of EquationOfMotion::velocity.
  const std::vector<SegmentForces> *last = nullptr;
  /// Velocity (nm/ns) of a node that feels the force @p force (MPa nm^2); a function of its neighbourhood. Called from many threads.
  std::function<Vec3(const Network &, NodeIndex, const Vec3 &force)> velocity;
};
} // namespace ddfem
