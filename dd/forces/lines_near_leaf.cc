#include "dd/forces/lines_near_leaf.h"

namespace ddfem
{
namespace
{
/// Middles of the panels whose first point is in a leaf may lie outside of it, by half a panel or so.
constexpr double enlargement = 1.25;
} // namespace

LinesNearLeaf::LinesNearLeaf(const fmm::Octree &tree_, const fmm::Box &leaf, const double reach)
    : tree(tree_), centre(tree.centre(leaf)), half_edges(0.5 * enlargement * tree.edges(leaf)), largest_reach(reach)
{
  const fmm::LineSpheres &all = tree.line_spheres();
  tree.for_each_line_near(centre, half_edges.norm() + reach,
                          [&](const std::uint32_t k, const std::size_t image)
                          {
                            const Vec3 &shift = tree.image_shifts()[image];
                            // Nearer to the leaf than the ball around it.
                            const Vec3 middle = Vec3(all.x[k], all.y[k], all.z[k]) + shift;
                            const double outside = ((middle - centre).cwiseAbs() - half_edges).cwiseMax(0.0).norm();
                            if (outside < reach + all.radius[k])
                            {
                              spheres.add(middle, all.radius[k]);
                              lines.emplace_back(k, image);
                            }
                          });
}
} // namespace ddfem
