#include "dd/fmm/grid_stress.h"

#include "dd/elasticity/line_table.h"
#include "dd/elasticity/vectorised/stress_kernels.h"
#include "dd/fmm/shifted_batch.h"

namespace ddfem::fmm
{
namespace
{
/// Adds the lines that act directly on the points of a leaf, images one after the other.
void add_near(const IsotropicMedium &medium, const Octree &tree, const LineTable &lines, const std::size_t leaf,
              StressBuffer &buffer)
{
  std::vector<std::vector<unsigned>> near(tree.image_shifts().size());
  tree.for_each_near_link(leaf,
                          [&](const NearLink &link, const std::uint32_t first, const std::uint32_t last)
                          {
                            for (std::uint32_t k = first; k < last; ++k)
                              near[link.image].push_back(k);
                          });
  const StressBatch batch = buffer.batch();
  for (std::size_t image = 0; image < near.size(); ++image)
    if (!near[image].empty())
      add_segment_stress(medium, lines, near[image], ShiftedBatch(batch, -tree.image_shifts()[image]).batch);
}
} // namespace

std::vector<SymTensor> grid_stress(const IsotropicMedium &medium, const int n_points, const Octree &tree,
                                   const std::span<const LineSource> lines, const std::span<const Vec3> points,
                                   const bool far_only)
{
  LineTable table;
  for (const LineSource &l : lines)
    table.add_segment(l.start, l.end, l.burgers);
  GridExpansions far(medium, n_points, tree, lines);
  far.compute();
  std::vector<SymTensor> stress(points.size(), SymTensor::Zero());
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t leaf = 0; leaf < tree.boxes().size(); ++leaf)
  {
    const Box &box = tree.boxes()[leaf];
    if (!box.is_leaf() || box.n_points() == 0)
      continue;
    const std::span<const std::uint32_t> order(tree.point_order().data() + box.points_begin, box.n_points());
    StressBuffer buffer(order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      buffer.set_point(i, points[order[i]]);
    far.add_stress(leaf, buffer.batch());
    if (!far_only)
      add_near(medium, tree, table, leaf, buffer);
    for (std::size_t i = 0; i < order.size(); ++i)
      stress[order[i]] = buffer.value(i);
  }
  return stress;
}
} // namespace ddfem::fmm
