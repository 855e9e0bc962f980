// Stress of lines at points: distant boxes by grids, near ones in closed form.
#pragma once

#include "dd/fmm/grid_expansions.h"

#include <vector>

namespace ddfem::fmm
{
/// Stress (MPa) of the lines of a tree, given in its order, at its points (nm), given and returned in the order in which the tree
/// got them. @p n_points: per direction, of the grids. With @p far_only, only what boxes with far links contribute.
std::vector<SymTensor> grid_stress(const IsotropicMedium &medium, int n_points, const Octree &tree,
                                   std::span<const LineSource> lines, std::span<const Vec3> points,
                                   bool far_only = false);
} // namespace ddfem::fmm
