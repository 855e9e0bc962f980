#include "dd/elasticity/image_quadrature.h"

#include "dd/elasticity/image_plan-inl.h"

#include <cmath>

namespace ddfem::internal
{
namespace
{
void add_branch_points(LineSingularities &singularities, const Vec3 &start, const Vec3 &t, const double a)
{
  if (t[2] != 0)
    singularities.add(-start[2] / t[2], a / std::abs(t[2]));
}
} // namespace

LineSingularities branch_points(const Vec3 &start, const Vec3 &t, const double a)
{
  LineSingularities result;
  add_branch_points(result, start, t, a);
  return result;
}

LineSingularities image_singularities(const SegmentImageData &d, const Vec3 &x)
{
  LineSingularities result = LineSingularities::of_point(x, d.medium.a, d.start, d.t);
  add_branch_points(result, d.start, d.t, d.medium.a);
  return result;
}

int n_gauss_points_for_image(const SegmentImageData &d, const Vec3 &x)
{
  return static_cast<int>(HWY_NAMESPACE::n_points_for_image(d, HWY_NAMESPACE::vector_of<double>(x)));
}
} // namespace ddfem::internal
