// Morton (Z-curve) order of points in a cube.
#pragma once

#include "dd/common/types.h"

#include <algorithm>
#include <cstdint>

namespace ddfem
{
/// Number of bits per axis of a Morton index: 3 * 21 fit into 64 bits.
inline constexpr unsigned morton_bits = 21;

/// Spread the low 21 bits of @p v so that two zero bits follow each (G. M. Morton, IBM report, 1966).
inline std::uint64_t spread_bits(std::uint64_t v)
{
  v &= 0x1fffffU;
  v = (v | v << 32) & 0x1f00000000ffffU;
  v = (v | v << 16) & 0x1f0000ff0000ffU;
  v = (v | v << 8) & 0x100f00f00f00f00fU;
  v = (v | v << 4) & 0x10c30c30c30c30c3U;
  v = (v | v << 2) & 0x1249249249249249U;
  return v;
}

/// Morton index of integer cell coordinates below 2^21.
inline std::uint64_t morton_index(std::uint64_t i, std::uint64_t j, std::uint64_t k)
{
  return spread_bits(i) | spread_bits(j) << 1 | spread_bits(k) << 2;
}

/// Morton index of @p x in the cube [origin, origin + width]^3 (nm) cut into 2^21 cells per axis. Points outside are
/// counted in the nearest cell; a cube without width has one cell.
inline std::uint64_t morton_index(const Vec3 &x, const Vec3 &origin, double width)
{
  constexpr double cells = 1U << morton_bits;
  std::uint64_t cell[3] = {0, 0, 0};
  for (int d = 0; d < 3; ++d)
    if (width > 0)
      cell[d] = static_cast<std::uint64_t>(std::clamp((x[d] - origin[d]) / width * cells, 0.0, cells - 1));
  return morton_index(cell[0], cell[1], cell[2]);
}
} // namespace ddfem
