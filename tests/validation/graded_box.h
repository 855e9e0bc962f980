// Boxes whose elements grow away from a fine middle under the free face z = 0, so that they stand for a half-space.
#pragma once

#include "fem/triangulation.h"

#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_generator.h>

#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

namespace ddfem::validation
{
using Mesh = dealii::parallel::distributed::Triangulation<3>;

/// Element sizes @p h up to the distance @p fine, then twice as long from one to the next up to @p end at least.
inline std::vector<double> graded(const double h, const double fine, const double end)
{
  std::vector<double> sizes(static_cast<std::size_t>(std::lround(fine / h)), h);
  double x = fine, size = h;
  while (x < end)
  {
    size *= 2;
    sizes.push_back(size);
    x += size;
  }
  return sizes;
}

/// The same to both sides.
inline std::vector<double> graded_both_ways(const double h, const double fine, const double end)
{
  const auto half = graded(h, fine, end);
  std::vector<double> across(half.rbegin(), half.rend());
  across.insert(across.end(), half.begin(), half.end());
  return across;
}

/// Box z > 0 of elements of these sizes, centred about x = y = 0; boundary ids x-, x+, y-, y+, z-, z+ = 0..5.
inline std::unique_ptr<Mesh> box_of(const std::vector<double> &x, const std::vector<double> &y,
                                    const std::vector<double> &z)
{
  const auto length = [](const std::vector<double> &sizes) { return std::accumulate(sizes.begin(), sizes.end(), 0.0); };
  auto mesh = std::make_unique<Mesh>(MPI_COMM_WORLD);
  dealii::GridGenerator::subdivided_hyper_rectangle(*mesh, {x, y, z},
                                                    dealii::Point<3>(-length(x) / 2, -length(y) / 2, 0),
                                                    dealii::Point<3>(length(x) / 2, length(y) / 2, length(z)), true);
  return mesh;
}
} // namespace ddfem::validation
