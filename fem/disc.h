#pragma once

#include <deal.II/base/point.h>

#include <array>
#include <vector>

namespace ddfem::fem
{
/// Points and quadrilaterals of the unit disc.
struct Disc
{
  std::vector<dealii::Point<2>> points;
  std::vector<std::array<unsigned, 4>> quads; ///< deal.II's order: (0,0), (1,0), (0,1), (1,1)
  /// Points on the circle, counter-clockwise from -45 degrees in equal angles; their number is a multiple of four.
  std::vector<unsigned> rim;
};

/// A square core with bulged sides surrounded by rings, so that no cell has an angle above about 135 degrees; about
/// @p n_across cells (at least 3, hit within one) across a diameter.
Disc make_disc(unsigned n_across);
} // namespace ddfem::fem
