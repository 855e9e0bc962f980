// Orthorhombic periodic cell.
#pragma once

#include "dd/common/types.h"

#include <cmath>

namespace ddfem
{
/// Cell [origin, origin + lengths), nm.
struct PeriodicCell
{
  Vec3 origin = Vec3::Zero();
  Vec3 lengths = Vec3::Ones();

  /// The image of difference vector @p d with components in [-L/2, L/2].
  Vec3 minimum_image(const Vec3 &d) const
  {
    Vec3 r = d;
    for (int c = 0; c < 3; ++c)
      r[c] -= lengths[c] * std::round(r[c] / lengths[c]);
    return r;
  }

  /// Lattice vector that takes @p x into the cell when added to it.
  Vec3 shift_into_cell(const Vec3 &x) const
  {
    Vec3 s;
    for (int c = 0; c < 3; ++c)
      s[c] = -lengths[c] * std::floor((x[c] - origin[c]) / lengths[c]);
    return s;
  }

  double volume() const { return lengths.prod(); }
};
} // namespace ddfem
