// Bounding spheres of segments in a uniform grid: which spheres are near each other, or near a point.
#pragma once

#include "dd/network/network.h"
#include "dd/topology/collisions/cell_map.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ddfem
{
/// Ball that contains half of a segment (or a whole one).
struct Sphere
{
  Vec3 centre;   ///< nm, any image
  double radius; ///< nm
  SegmentIndex segment;
};

/// Below this number of spheres, segments or nodes the work of a loop is not worth waking other threads.
inline constexpr std::size_t least_for_threads = 2000;

/// Hash value of @p bits bits that keeps the last @p near bits of a Morton index: cells near each other stay near each
/// other in memory. The others are multiplied by 2^64 over the golden ratio (Knuth, TAOCP 3, section 6.4).
inline std::size_t hash_of_neighbourhood(std::uint64_t key, unsigned near, unsigned bits)
{
  const std::uint64_t far = (key >> near) * 0x9e3779b97f4a7c15U >> 32U;
  return (far << near | (key & ((std::uint64_t(1) << near) - 1))) & ((std::uint64_t(1) << bits) - 1);
}

/// Spheres sorted along the Morton curve of their cells, two per segment. Occupied cells are kept in blocks of 4 x 4 x
/// 4, consecutive on the curve, with a bit per cell; the blocks are found by hashing. Neighbouring cells are so found
/// with few visits to the table, and memory is proportional to the number of spheres however empty the space is.
class SphereGrid
{
public:
  /// @p spheres: both of a segment one after the other. pairs_of_block() looks into neighbouring cells only: those of
  /// @p map must be as wide as any two spheres are apart (from centre to centre) that it is to find.
  void build(const std::vector<Sphere> &spheres, const CellMap &map);

  std::size_t size() const { return segment_.size(); }
  std::size_t n_blocks() const { return blocks_.size() - 1; }
  SegmentIndex segment(std::uint32_t i) const { return segment_[i]; }
  /// The other sphere of the same segment.
  std::uint32_t partner(std::uint32_t i) const { return partner_[i]; }
  /// Distance of the surfaces of two spheres, nm (negative if they overlap), if these are the nearest ones of their
  /// segments; not a number for the other three combinations.
  double nearest_gap(std::uint32_t i, std::uint32_t j) const;
  /// Of the centres of the two largest spheres, if their surfaces are @p gap apart, nm.
  double largest_distance(double gap) const { return 2 * largest_ + gap; }

  /// The blocks that were looked up last; one for each thread.
  class Memory
  {
  public:
    Memory() { key_.fill(~std::uint64_t(0)); }

  private:
    friend class SphereGrid;
    std::array<std::uint64_t, 64> key_;
    std::array<std::uint32_t, 64> block_{};
  };

  /// f(i, j) for every two spheres whose surfaces are no farther apart than @p gap (nm), the first of them in the block
  /// @p block. All blocks together give every pair once. Returns the number of tests.
  template <class F> std::size_t pairs_of_block(std::size_t block, double gap, Memory &memory, F &&f) const;

  /// f(i) for every sphere whose surface is no farther than @p reach (nm) from the point @p x.
  template <class F> std::size_t near(const Vec3 &x, double reach, Memory &memory, F &&f) const;

private:
  struct Block
  {
    std::uint64_t key = 0;      ///< Morton index of its cells / 64
    std::uint64_t occupied = 0; ///< bit per cell
    std::uint32_t first_cell = 0;
  };
  static constexpr std::uint32_t none = 0xffffffffU;
  static constexpr unsigned block_bits = 6; ///< 64 cells

  /// Of the next occupied cell on the curve.
  void add_cell(std::uint64_t key, std::uint32_t first_sphere);
  void make_table();
  std::size_t first_slot(std::uint64_t key) const { return hash_of_neighbourhood(key, 3, table_bits_); }
  std::uint32_t find_block(std::uint64_t key) const;
  std::uint32_t find_block(std::uint64_t key, Memory &memory) const
  {
    const std::size_t slot = key & 63U; // neighbouring blocks differ in the lowest bits of their coordinates
    if (memory.key_[slot] != key)
    {
      memory.key_[slot] = key;
      memory.block_[slot] = find_block(key);
    }
    return memory.block_[slot];
  }
  /// Number of the occupied cell @p key of a block; none if it is empty.
  std::uint32_t cell_of(std::uint32_t block, std::uint64_t key) const
  {
    if (block == none)
      return none;
    const std::uint64_t bit = std::uint64_t(1) << (key & 63U), occupied = blocks_[block].occupied;
    return (occupied & bit) == 0
               ? none
               : blocks_[block].first_cell + static_cast<std::uint32_t>(std::popcount(occupied & (bit - 1)));
  }
  double squared_distance(std::uint32_t i, std::uint32_t j) const
  {
    return map_.squared_distance(x_[i] - x_[j], y_[i] - y_[j], z_[i] - z_[j]);
  }
  template <class F>
  void test(std::uint32_t i, std::uint32_t begin, std::uint32_t end, double gap, std::size_t &tests, F &&f) const
  {
    tests += end - begin;
    for (std::uint32_t j = begin; j < end; ++j)
    {
      const double reach = r_[i] + r_[j] + gap;
      if (squared_distance(i, j) <= reach * reach)
        f(i, j);
    }
  }

  CellMap map_;
  double largest_ = 0; ///< radius, nm
  std::vector<double> x_, y_, z_, r_;
  std::vector<SegmentIndex> segment_;
  std::vector<std::uint32_t> partner_;
  std::vector<std::uint32_t> cells_; ///< first sphere of each occupied cell, and the number of spheres
  std::vector<Block> blocks_{1};     ///< in the order of the curve, and one more that ends the last
  std::vector<std::uint32_t> table_; ///< open addressing: numbers of blocks
  unsigned table_bits_ = 1;
};

template <class F> std::size_t SphereGrid::pairs_of_block(std::size_t block, double gap, Memory &memory, F &&f) const
{
  std::size_t tests = 0;
  const std::uint64_t own_block = blocks_[block].key;
  for (std::uint32_t c = blocks_[block].first_cell; c < blocks_[block + 1].first_cell; ++c)
  {
    const std::uint32_t begin = cells_[c], end = cells_[c + 1];
    for (std::uint32_t i = begin; i < end; ++i)
      test(i, i + 1, end, gap, tests, f);
    const CellMap::Cell own = map_.cell({x_[begin], y_[begin], z_[begin]});
    map_.for_each_later_neighbour(
        own,
        [&](std::uint64_t key)
        {
          const std::uint64_t key_of_block = key >> block_bits;
          const std::uint32_t other = cell_of(
              key_of_block == own_block ? static_cast<std::uint32_t>(block) : find_block(key_of_block, memory), key);
          if (other == none)
            return;
          for (std::uint32_t i = begin; i < end; ++i)
            test(i, cells_[other], cells_[other + 1], gap, tests, f);
        });
  }
  return tests;
}

template <class F> std::size_t SphereGrid::near(const Vec3 &x, double reach, Memory &memory, F &&f) const
{
  if (size() == 0)
    return 0;
  std::size_t tests = 0;
  const Vec3 centre = map_.wrapped(x);
  const auto test_range = [&](std::uint32_t begin, std::uint32_t end)
  {
    tests += end - begin;
    for (std::uint32_t i = begin; i < end; ++i)
    {
      const double sum = r_[i] + reach;
      if (map_.squared_distance(x_[i] - centre[0], y_[i] - centre[1], z_[i] - centre[2]) <= sum * sum)
        f(i);
    }
  };
  const CellMap::Range range = map_.around(centre, reach + largest_);
  if (range.n_cells() > static_cast<double>(size()))
    test_range(0, static_cast<std::uint32_t>(size()));
  else
    map_.for_each_key(range,
                      [&](std::uint64_t key)
                      {
                        const std::uint32_t c = cell_of(find_block(key >> block_bits, memory), key);
                        if (c != none)
                          test_range(cells_[c], cells_[c + 1]);
                      });
  return tests;
}
} // namespace ddfem
