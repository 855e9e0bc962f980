// The quadrature along the image of a segment.
#pragma once

#include "dd/elasticity/half_space_image.h"
#include "dd/elasticity/panel_quadrature.h"

namespace ddfem::internal
{
/// Where D = sqrt(z^2 + a^2) has branch points on the line from @p start along the unit vector @p t; none at finite
/// distance for a line parallel to the surface.
LineSingularities branch_points(const Vec3 &start, const Vec3 &t, double a);

/// All singularities for the image at @p x.
LineSingularities image_singularities(const SegmentImageData &d, const Vec3 &x);

/// Number of points of a single panel at @p x; 0: a graded partition is needed.
int n_gauss_points_for_image(const SegmentImageData &d, const Vec3 &x);

/// Calls @p add(s, weight) for the points and weights (nm) at @p x.
template <typename Add> void for_each_image_point(const SegmentImageData &d, const Vec3 &x, Add &&add)
{
  const int n = n_gauss_points_for_image(d, x);
  if (n > 0)
    integrate_on_panel(n, 0.0, d.length, add);
  else
    integrate_graded(image_singularities(d, x), d.length, d.tolerance, add);
}
} // namespace ddfem::internal
