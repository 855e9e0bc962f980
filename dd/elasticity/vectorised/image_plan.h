// Numbers of Gauss points for the image of a segment at many points. Internal to dd/elasticity/vectorised.
#pragma once

#include "dd/elasticity/half_space_image.h"

#include <cstddef>

namespace ddfem::internal
{
/// n[i] += number of Gauss points of a single panel at the @p n_points points x[.][i] (nm); 0 if a graded partition is
/// needed.
void plan_for_image(const SegmentImageData &image, std::size_t n_points, const double *const (&x)[3], double *n);
} // namespace ddfem::internal
