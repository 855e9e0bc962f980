// Lines near the panels of one leaf, found once for all of them.
#pragma once

#include "dd/fmm/octree.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace ddfem
{
/// The lines, images included, that come near any place in a leaf: a panel looks for its own among these few hundred instead of in the tree.
class LinesNearLeaf
{
public:
  /// @p reach: the largest that for_each() will be asked for, nm.
  LinesNearLeaf(const fmm::Octree &tree, const fmm::Box &leaf, double reach);

  /// Calls visit(position in the tree's order, image) for every line whose middle is nearer to @p x than @p reach plus half its
  /// length (nm), in the order of Octree::for_each_line_near(), which is asked for places that are not in the leaf.
  template <class Visit> void for_each(const Vec3 &x, const double reach, Visit &&visit) const
  {
    if (reach > largest_reach || ((x - centre).cwiseAbs() - half_edges).maxCoeff() > 0)
      tree.for_each_line_near(x, reach, std::forward<Visit>(visit));
    else
      spheres.for_each_near(x, reach, 0, lines.size(),
                            [&](const std::size_t k) { visit(lines[k].first, lines[k].second); });
  }

private:
  const fmm::Octree &tree;
  Vec3 centre, half_edges; ///< nm
  double largest_reach;
  fmm::LineSpheres spheres; ///< of the images
  std::vector<std::pair<std::uint32_t, std::size_t>> lines;
};
} // namespace ddfem
