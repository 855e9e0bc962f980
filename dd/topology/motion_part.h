// Part of the motion of a step.
#pragma once

#include "dd/common/types.h"

#include <vector>

namespace ddfem
{
/// In which every node goes straight at constant speed.
struct MotionPart
{
  double duration;                ///< in any unit, the same for all parts of a step
  std::vector<Vec3> displacement; ///< nm, by NodeIndex::value
};
} // namespace ddfem
