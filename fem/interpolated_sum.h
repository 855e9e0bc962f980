#pragma once

#include "fem/traction_field.h"

#include <span>
#include <vector>

namespace ddfem::fem
{
/// Stress (MPa) of some `sources` of a field at many points (nm), source by source where they are near, by interpolation where they
/// are far: the box around a group of points gets them at Chebyshev nodes, and the groups are halved as long as that saves
/// evaluations. The field is analytic up to its smooth length s from a box of edge h, and n nodes in a direction err by about
/// rho^-n, rho = 2s/h + sqrt((2s/h)^2 + 1) (Trefethen, Approximation Theory and Approximation Practice, 2013, theorem 8.2).
/// `tolerance`: of that, relative to the stress of a source near the box. Local; threaded, with a result that does not depend on the
/// number of threads.
std::vector<dealii::SymmetricTensor<2, 3>> interpolated_sum(const TractionField &field,
                                                            std::span<const unsigned> sources,
                                                            std::span<const dealii::Point<3>> points, double tolerance);
} // namespace ddfem::fem
