// Which rank computes the forces on which lines.
#pragma once

#include "dd/fmm/multipole_sum.h"

#include <mpi.h>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace ddfem
{
/// The same on all ranks.
struct LineShares
{
  std::vector<std::uint32_t> lines; ///< those of the first rank, then those of the second, ...
  std::vector<std::size_t> begin;   ///< first of each rank, and one past the last

  std::span<const std::uint32_t> of(const int rank) const
  {
    const auto r = static_cast<std::size_t>(rank);
    return std::span(lines).subspan(begin[r], begin[r + 1] - begin[r]);
  }
};

/// In their order, as many for each rank.
LineShares equal_shares(std::size_t n_lines, MPI_Comm comm);

/// Points on lines, line after line.
class PointsOfLines
{
public:
  /// @p first_point: of each line, and one past the last point. Every line has a point.
  explicit PointsOfLines(std::vector<std::size_t> first_point) : first(std::move(first_point)) {}

  std::size_t n_lines() const { return first.size() - 1; }
  std::size_t n_points() const { return first.back(); }
  std::size_t begin(const std::size_t line) const { return first[line]; }
  std::size_t end(const std::size_t line) const { return first[line + 1]; }
  std::size_t line_of(std::size_t point) const;

private:
  std::vector<std::size_t> first;
};

/// A line belongs to the rank that computes the field at its first point, and comes in the order of these points in the tree.
LineShares shares_by_first_point(const PointsOfLines &points, const fmm::MultipoleSum &sum);
} // namespace ddfem
