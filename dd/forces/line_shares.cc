#include "dd/forces/line_shares.h"

#include "dd/common/parallel.h"

#include <algorithm>
#include <numeric>

namespace ddfem
{
LineShares equal_shares(const std::size_t n_lines, MPI_Comm comm)
{
  LineShares shares{std::vector<std::uint32_t>(n_lines), owned_ranges(n_lines, comm)};
  std::iota(shares.lines.begin(), shares.lines.end(), 0U);
  return shares;
}

std::size_t PointsOfLines::line_of(const std::size_t point) const
{
  return static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), point) - first.begin()) - 1;
}

LineShares shares_by_first_point(const PointsOfLines &points, const fmm::MultipoleSum &sum)
{
  constexpr std::uint32_t none = -1U;
  std::vector<std::uint32_t> line_at(points.n_points(), none); // whose first point it is
  for (std::size_t i = 0; i < points.n_lines(); ++i)
    line_at[points.begin(i)] = static_cast<std::uint32_t>(i);
  const std::vector<std::size_t> limits = sum.point_shares();
  const std::vector<std::uint32_t> &order = sum.octree().point_order();
  LineShares shares{{}, {0}};
  shares.lines.reserve(points.n_lines());
  for (std::size_t r = 0; r + 1 < limits.size(); ++r)
  {
    for (std::size_t k = limits[r]; k < limits[r + 1]; ++k)
      if (const std::uint32_t line = line_at[order[k]]; line != none)
        shares.lines.push_back(line);
    shares.begin.push_back(shares.lines.size());
  }
  return shares;
}
} // namespace ddfem
