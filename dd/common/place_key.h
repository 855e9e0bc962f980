// Positions as keys of maps.
#pragma once

#include "dd/common/types.h"

#include <array>
#include <cmath>

namespace ddfem
{
/// The same for positions closer than about 1e-6 nm, which are one node: far below a core radius, far above rounding.
inline std::array<long long, 3> place_key(const Vec3 &x)
{
  constexpr double same_place = 1e-6;
  return {std::llround(x[0] / same_place), std::llround(x[1] / same_place), std::llround(x[2] / same_place)};
}
} // namespace ddfem
