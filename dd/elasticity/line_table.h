// Straight lines as the vectorised kernels read them.
#pragma once

#include "dd/common/types.h"

#include <cstddef>
#include <vector>

namespace ddfem
{
/// Segments or rays, number by number in blocks of eight: with eight values of each component next to each other, a vector
/// register is filled from one place, whatever its width, and a block is contiguous in memory.
class LineTable
{
public:
  static constexpr std::size_t block_size = 8;
  /// Rows of a block: ends (nm; a ray has no second one), unit direction t, Burgers vector b, e = b x t (nm), length (nm;
  /// ray: 0).
  enum Row : std::size_t
  {
    first_end = 0,
    second_end = 3,
    direction = 6,
    burgers = 9,
    edge = 12,
    length = 15,
    n_rows = 16
  };
  struct alignas(64) Block
  {
    double value[n_rows][block_size] = {};
  };

  /// Segment @p x1 -> @p x2 (nm) with Burgers vector @p b (nm, FS/RH). One of length zero has no field.
  void add_segment(const Vec3 &x1, const Vec3 &x2, const Vec3 &b);
  /// Ray from @p origin (nm) to infinity along the unit vector @p t.
  void add_ray(const Vec3 &origin, const Vec3 &t, const Vec3 &b);

  /// Line number @p i of @p table, moved by @p shift (nm).
  void add_moved(const LineTable &table, std::size_t i, const Vec3 &shift);

  /// Removes all lines, and keeps the memory.
  void clear()
  {
    blocks.clear();
    n_lines = 0;
  }
  void reserve(std::size_t n) { blocks.reserve((n + block_size - 1) / block_size); }
  std::size_t size() const { return n_lines; }
  std::size_t n_blocks() const { return blocks.size(); }
  /// The lines behind the last one are zero.
  const Block &block(std::size_t k) const { return blocks[k]; }
  /// The three rows from @p first on of line @p i.
  Vec3 vector(const std::size_t i, const Row first) const
  {
    const double *const rows = line(i) + first * block_size;
    return {rows[0], rows[block_size], rows[2 * block_size]};
  }
  /// The first row of line @p i; row r is r * block_size numbers further on.
  const double *line(std::size_t i) const { return &blocks[i / block_size].value[0][i % block_size]; }

private:
  void add(const Vec3 &x1, const Vec3 &x2, const Vec3 &t, const Vec3 &b, double length);

  std::vector<Block> blocks;
  std::size_t n_lines = 0;
};
} // namespace ddfem
