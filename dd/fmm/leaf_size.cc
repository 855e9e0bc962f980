#include "dd/fmm/leaf_size.h"

#include "dd/common/morton.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace ddfem::fmm
{
namespace
{
/// Sources that are counted, at most.
constexpr std::size_t largest_sample = 20000;
constexpr unsigned finest_level = 16;

/// Cells of a sample of the sources in the finest of the grids that halve @p width.
std::vector<std::uint64_t> cells_of(const std::span<const SourceExtent> sources, const std::size_t stride,
                                    const Vec3 &origin, const double width)
{
  std::vector<std::uint64_t> cells;
  cells.reserve(sources.size() / stride + 1);
  for (std::size_t i = 0; i < sources.size(); i += stride)
    cells.push_back(morton_index(sources[i].middle, origin, width));
  std::sort(cells.begin(), cells.end());
  return cells;
}

/// How many others a source finds in its cell, in the mean.
double mean_others(const std::vector<std::uint64_t> &cells, const unsigned level)
{
  const unsigned dropped = 3 * (morton_bits - level);
  double pairs = 0;
  for (std::size_t begin = 0, end = 0; begin < cells.size(); begin = end)
  {
    while (end < cells.size() && cells[end] >> dropped == cells[begin] >> dropped)
      ++end;
    const auto n = static_cast<double>(end - begin);
    pairs += n * (n - 1);
  }
  return pairs / static_cast<double>(cells.size());
}

/// The whole number by which an edge is divided, near @p wanted in ratio.
double nearest_division(const double wanted)
{
  const double below = std::max(1.0, std::floor(wanted));
  return wanted / below < (below + 1) / wanted ? below : below + 1;
}
} // namespace

double suitable_leaf_size(const std::span<const SourceExtent> sources, const Vec3 &origin, const double width,
                          const double lines_per_leaf)
{
  const std::size_t stride = (sources.size() + largest_sample - 1) / largest_sample;
  if (sources.empty())
    return width;
  const std::vector<std::uint64_t> cells = cells_of(sources, stride, origin, width);
  // What is direct comes from 27 boxes. Their number of lines says more than that of one, in which neighbours on the same curve count.
  constexpr double n_boxes = 27;
  const double wanted = n_boxes * lines_per_leaf;
  unsigned level = 0;
  double others = 0;
  do
    others = static_cast<double>(stride) * mean_others(cells, level);
  while (others > std::sqrt(8.0) * wanted && ++level < finest_level);
  return std::ldexp(width, -static_cast<int>(level)) * std::cbrt(wanted / std::max(others, wanted / 8) / n_boxes);
}

RootGrid fit_to_leaves(const RootGrid &grid, const std::span<const SourceExtent> sources, const double lines_per_leaf,
                       const bool centred)
{
  const Vec3 whole = grid.edges.cwiseProduct(Vec3(grid.n[0], grid.n[1], grid.n[2]));
  const double width = whole.maxCoeff(), leaf = suitable_leaf_size(sources, grid.origin, width, lines_per_leaf);
  RootGrid fitted = grid;
  if (grid.periodic)
  {
    const double levels = std::log2(grid.edges.maxCoeff() / leaf);
    const auto distance_to_level = [](const double x) { return std::abs(x - std::round(x)); };
    // A third is log2(3) levels deeper. With fewer levels the many pairs of images of the roots would weigh.
    if (levels > 2 && distance_to_level(levels - std::log2(3.0)) < distance_to_level(levels))
      for (std::size_t c = 0; c < 3; ++c)
      {
        fitted.n[c] *= 3;
        fitted.edges[static_cast<int>(c)] /= 3;
      }
    return fitted;
  }
  // Leaves of 1/m of the width of the sources, which lie symmetrically about the centre only if m is even.
  const double division = centred ? 2 * nearest_division(0.5 * width / leaf) : nearest_division(width / leaf);
  const double growth = std::exp2(std::ceil(std::log2(division) - 1e-9)) / division;
  fitted.edges *= growth;
  if (centred)
    fitted.origin += 0.5 * (grid.edges - fitted.edges);
  return fitted;
}
} // namespace ddfem::fmm
