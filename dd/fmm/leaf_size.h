// The root of the tree such that halving it meets the size that suits leaves.
#pragma once

#include "dd/fmm/octree.h"

#include <span>

namespace ddfem::fmm
{
/// Edge of leaves with @p lines_per_leaf sources, as most sources see it (networks cluster), nm. @p width: of a cube around the sources,
/// from @p origin, nm.
double suitable_leaf_size(std::span<const SourceExtent> sources, const Vec3 &origin, double width,
                          double lines_per_leaf);

/// @p grid with other boxes, of which a power of two has about the suitable size: leaves from halving the given ones are too large or too small by
/// up to sqrt(2) in their edges, 2.8 in the number of their lines, which costs up to a third of the time (measured). A single cube grows,
/// and keeps its lowest corner or, if @p centred, its centre; a periodic grid is divided by three, if that is better.
RootGrid fit_to_leaves(const RootGrid &grid, std::span<const SourceExtent> sources, double lines_per_leaf,
                       bool centred);
} // namespace ddfem::fmm
