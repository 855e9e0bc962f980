#include "dd/fmm/grid_expansions.h"

#include "dd/common/stopwatch.h"
#include "dd/elasticity/gauss.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>

namespace ddfem::fmm
{
namespace
{
/// How far from the centre a line may reach, in box edges: a quarter out of the box, more where boxes are no cubes.
constexpr double farthest_reach = 0.8;

/// Gauss points for a line of @p length whose middle is @p distance or more from all points: the error of a rule falls like
/// rho^-2n, rho = d/h + sqrt(1 + (d/h)^2) with half the length h (Trefethen, SIAM Rev. 50 (2008) 67, eq. 4.15).
int n_points_along(const double length, const double distance, const int n_grid)
{
  const double ratio = 2 * distance / std::max(length, 1e-6 * distance), rho = ratio + std::sqrt(1 + ratio * ratio);
  const double n = std::log(10 / grid_error(n_grid)) / (2 * std::log(rho));
  return std::clamp(static_cast<int>(std::ceil(n)), 1, max_gauss_points);
}

std::size_t coarsest_far_level(const Octree &tree)
{
  for (std::size_t box = 0; box < tree.boxes().size(); ++box)
    if (tree.n_far_links(box) > 0)
      return tree.boxes()[box].level;
  return tree.levels().size() - 1;
}
} // namespace

GridExpansions::GridExpansions(const IsotropicMedium &medium_, const int n_points, const Octree &tree_,
                               const std::span<const LineSource> lines_)
    : medium(medium_), grid(n_points), transform(grid.n()), tree(tree_), lines(lines_),
      coarsest(coarsest_far_level(tree_))
{
  check_reach();
}

void GridExpansions::check_reach() const
{
  for (std::size_t i = tree.levels()[coarsest]; i < tree.boxes().size(); ++i)
  {
    const Box &box = tree.boxes()[i];
    const Vec3 centre = tree.centre(box), edges = tree.edges(box);
    for (std::uint32_t k = box.lines_begin; k < box.own_lines_end; ++k)
      for (const Vec3 &end : {lines[k].start, lines[k].end})
        if ((end - centre).cwiseQuotient(edges).lpNorm<Eigen::Infinity>() > farthest_reach)
          throw std::invalid_argument("a line of " + std::to_string((lines[k].end - lines[k].start).norm()) +
                                      " nm reaches too far out of a box of " + std::to_string(tree.size(box)) +
                                      " nm to be interpolated");
  }
}

void GridExpansions::compute()
{
  density = stress = RowBuffer(tree.boxes().size() * grid.n_rows());
  for (std::size_t level = tree.levels().size() - 1; level-- > coarsest;)
    add_up(level);
  for (std::size_t level = coarsest; level + 1 < tree.levels().size(); ++level)
    translate(level);
  for (std::size_t level = coarsest + 1; level + 1 < tree.levels().size(); ++level)
    add_down(level);
  density = RowBuffer();
}

void GridExpansions::add_lines(const std::size_t index)
{
  const Box &box = tree.boxes()[index];
  const Vec3 centre = tree.centre(box), edges = tree.edges(box);
  for (std::uint32_t k = box.lines_begin; k < box.own_lines_end; ++k)
  {
    const LineSource &l = lines[k];
    const Vec3 d = l.end - l.start;
    const auto A = line_density(l.burgers, d);
    const GaussRule rule = gauss_rule(n_points_along(d.norm(), edges.minCoeff(), static_cast<int>(grid.n())));
    for (std::size_t p = 0; p < rule.points.size(); ++p)
    {
      Row strength;
      for (std::size_t c = 0; c < n_densities; ++c)
        strength[c] = rule.weights[p] * A[c];
      const Vec3 y = (l.start + rule.points[p] * d - centre).cwiseQuotient(edges);
      grid.add_source(grid.basis(y), strength, density.rows() + index * grid.n_rows());
    }
  }
}

void GridExpansions::add_up(const std::size_t level)
{
  const Stopwatch watch(seconds.upward);
#pragma omp parallel for schedule(dynamic, 8)
  for (std::size_t i = tree.levels()[level]; i < tree.levels()[level + 1]; ++i)
  {
    const Box &box = tree.boxes()[i];
    if (box.n_lines() == 0)
      continue;
    add_lines(i);
    for (std::size_t child = box.first_child; child < box.first_child + box.n_children; ++child)
      if (tree.boxes()[child].n_lines() > 0)
        grid.add_to_parent(tree.boxes()[child].octant(), density.rows() + child * grid.n_rows(),
                           density.rows() + i * grid.n_rows());
  }
}

GridExpansions::Level GridExpansions::level_of(const std::size_t level) const
{
  constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  const std::uint32_t begin = tree.levels()[level], end = tree.levels()[level + 1];
  Level l;
  l.first.push_back(0);
  std::vector<std::uint32_t> number(end - begin, none);
  std::set<Offset> offsets;
  for (std::uint32_t i = begin; i < end; ++i)
  {
    if (tree.n_far_links(i) == 0)
      continue;
    l.targets.push_back(i);
    for (const FarLink &link : tree.far_links(i))
    {
      std::uint32_t &source = number[link.box - begin];
      if (source == none)
      {
        source = static_cast<std::uint32_t>(l.sources.size());
        l.sources.push_back(link.box);
      }
      l.links.push_back({0, source});
      offsets.insert(link.offset);
    }
    l.first.push_back(static_cast<std::uint32_t>(l.links.size()));
  }
  l.offsets.assign(offsets.begin(), offsets.end());
  return l;
}

GridKernel GridExpansions::kernel_of(Level &level)
{
  const Stopwatch watch(seconds.kernels);
  const Vec3 edges = tree.edges(tree.boxes()[level.targets.front()]);
  GridKernel kernel(transform, medium, grid.spacing(edges), edges, level.offsets);
  std::size_t l = 0;
  for (const std::uint32_t target : level.targets)
    for (const FarLink &link : tree.far_links(target))
      level.links[l++].kernel = kernel.number(link.offset);
  return kernel;
}

Spectra GridExpansions::spectra_of_sources(const Level &level)
{
  const Stopwatch watch(seconds.transforms);
  Spectra spectra(transform.n_frequencies(), level.sources.size(), n_densities);
#pragma omp parallel for schedule(dynamic, 4)
  for (std::size_t s = 0; s < level.sources.size(); ++s)
  {
    RowBuffer spectrum;
    transform.forward(density.rows() + level.sources[s] * grid.n_rows(), spectrum);
    for (std::size_t q = 0; q < n_densities; ++q)
      spectra.set(s, q, spectrum, q);
  }
  return spectra;
}

Spectra GridExpansions::convolve_all(const Level &level, const Spectra &kernels, const Spectra &sources)
{
  const Stopwatch watch(seconds.translations);
  Spectra targets(transform.n_frequencies(), level.targets.size(), n_stresses);
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t b = 0; b < targets.n_blocks(); ++b)
    convolve(medium.nu, level.links, level.first, kernels.block(b), sources.block(b), targets.block(b));
  return targets;
}

void GridExpansions::add_to_stress(const Level &level, const Spectra &targets)
{
  const Stopwatch watch(seconds.transforms);
#pragma omp parallel for schedule(dynamic, 4)
  for (std::size_t t = 0; t < level.targets.size(); ++t)
  {
    RowBuffer spectrum(2 * transform.n_frequencies());
    targets.get(t, spectrum);
    transform.add_backward(spectrum, stress.rows() + level.targets[t] * grid.n_rows());
  }
}

void GridExpansions::translate(const std::size_t level_number)
{
  Level level = level_of(level_number);
  if (level.targets.empty())
    return;
  const GridKernel kernel = kernel_of(level);
  const Spectra sources = spectra_of_sources(level), targets = convolve_all(level, kernel.spectra(), sources);
  add_to_stress(level, targets);
  const std::size_t n_rows =
      density.size() + stress.size() + kernel.spectra().n_rows() + sources.n_rows() + targets.n_rows();
  most_bytes = std::max(most_bytes, n_rows * row_size);
}

void GridExpansions::add_down(const std::size_t level)
{
  const Stopwatch watch(seconds.downward);
#pragma omp parallel for schedule(dynamic, 8)
  for (std::size_t i = tree.levels()[level]; i < tree.levels()[level + 1]; ++i)
    if (const Box &box = tree.boxes()[i]; box.n_points() > 0)
      grid.add_to_child(box.octant(), stress.rows() + box.parent * grid.n_rows(), stress.rows() + i * grid.n_rows());
}

void GridExpansions::add_stress(const std::size_t leaf, const StressBatch &points) const
{
  const Box &box = tree.boxes()[leaf];
  if (box.level < coarsest)
    return;
  const Vec3 centre = tree.centre(box), edges = tree.edges(box);
  for (std::size_t i = 0; i < points.n; ++i)
  {
    const Vec3 x(points.x[0][i], points.x[1][i], points.x[2][i]);
    Row value = {};
    grid.add_value(grid.basis((x - centre).cwiseQuotient(edges)), stress.rows() + leaf * grid.n_rows(), value);
    for (std::size_t c = 0; c < n_stresses; ++c)
      points.value[c][i] += value[c];
  }
}
} // namespace ddfem::fmm
