// Points of a quadrature along one line, a portion at a time. Internal to dd/elasticity/vectorised.
#pragma once

#include "dd/elasticity/line_table.h"

#include <array>
#include <cstddef>

namespace ddfem::internal
{
/// Positions and weights in units of the line's length.
struct LinePoints
{
  std::array<double, 64> position, weight;
  std::size_t n = 0;

  /// Adds a point; calls @p use() with a full portion first.
  template <class Use> void add(const double p, const double w, Use &&use)
  {
    if (n == position.size())
    {
      use();
      n = 0;
    }
    position[n] = p;
    weight[n++] = w;
  }

  /// Calls @p use() with the rest, filled up to whole registers by points without weight.
  template <class Use> void finish(Use &&use)
  {
    if (n == 0)
      return;
    for (; n % LineTable::block_size != 0; ++n)
    {
      position[n] = position[n - 1];
      weight[n] = 0.0;
    }
    use();
    n = 0;
  }
};
} // namespace ddfem::internal
