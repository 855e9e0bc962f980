#include "dd/fmm/grids_and_rays.h"

#include "dd/fmm/leaf_size.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ddfem::fmm
{
RootGrid enclosing_grid(const std::span<const SourceExtent> sources, const std::span<const RaySource> rays,
                        const std::span<const Vec3> points, const double lines_per_leaf)
{
  Eigen::AlignedBox3d box;
  for (const SourceExtent &s : sources)
    box.extend(s.middle);
  for (const RaySource &r : rays)
    box.extend(r.origin);
  for (const Vec3 &p : points)
    box.extend(p);
  if (box.isEmpty())
    return {};
  // A little wider, so that rounding leaves no point outside.
  const double slack = 1e-9 * std::max(box.sizes().maxCoeff(), 1.0), width = box.sizes().maxCoeff() + 2 * slack;
  const bool centred = !rays.empty() || lines_per_leaf == 0;
  RootGrid grid{centred ? Vec3(box.center() - Vec3::Constant(0.5 * width)) : Vec3(box.min() - Vec3::Constant(slack)),
                Vec3::Constant(width),
                {1, 1, 1},
                false};
  if (lines_per_leaf > 0)
    grid = fit_to_leaves(grid, sources, lines_per_leaf, centred);
  if (!rays.empty())
  {
    grid.origin -= 1.5 * grid.edges;
    grid.edges *= 4;
  }
  return grid;
}

RootGrid periodic_grid(const Vec3 &origin, const Vec3 &lengths, const std::span<const SourceExtent> sources,
                       const double lines_per_leaf)
{
  RootGrid grid{origin, lengths, {1, 1, 1}, true};
  for (int k = 1; k <= 4; ++k) // boxes along the shortest edge: as few as make the boxes cubes to 15 %
  {
    for (int c = 0; c < 3; ++c)
    {
      const double n = std::round(lengths[c] / (lengths.minCoeff() / k));
      grid.n[static_cast<std::size_t>(c)] = static_cast<int>(n);
      grid.edges[c] = lengths[c] / n;
    }
    if (grid.edges.maxCoeff() < 1.15 * grid.edges.minCoeff())
      break;
  }
  return lines_per_leaf > 0 ? fit_to_leaves(grid, sources, lines_per_leaf, false) : grid;
}

std::vector<double> cuts_of(const RaySource &ray, const RootGrid &grid, const double shortest)
{
  double way = std::numeric_limits<double>::infinity(); // to the boundary of the root
  for (int c = 0; c < 3; ++c)
  {
    const double wall = grid.origin[c] + (ray.direction[c] > 0 ? grid.edges[c] : 0.0);
    if (ray.direction[c] != 0.0)
      way = std::min(way, (wall - ray.origin[c]) / ray.direction[c]);
  }
  std::vector<double> cuts{0.0};
  while (cuts.back() < way)
    cuts.push_back(std::min(way, cuts.back() + std::max(shortest, 0.25 * cuts.back())));
  return cuts;
}

RaySource cut_ray(const RaySource &ray, const std::span<const double> cuts, std::vector<LineSource> &lines)
{
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k)
    lines.push_back({ray.origin + cuts[k] * ray.direction, ray.origin + cuts[k + 1] * ray.direction, ray.burgers});
  return {ray.origin + cuts.back() * ray.direction, ray.direction, ray.burgers};
}
} // namespace ddfem::fmm
