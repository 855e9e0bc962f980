#include "dd/elasticity/vectorised/image_plan.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dd/elasticity/vectorised/image_plan.cc"
// clang-format off: before what is compiled for every instruction set
#include <hwy/foreach_target.h>
// clang-format on

#include "dd/elasticity/image_plan-inl.h"
#include "dd/elasticity/vectorised/point_groups-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ddfem::HWY_NAMESPACE
{
void plan_image(const SegmentImageData &image, std::size_t n_points, const double *const (&x)[3], double *n)
{
  double *const values[1] = {n};
  add_at_points(n_points, x, values,
                [&](std::size_t, const Vector<Real> &at) HWY_ATTR
                { return std::array<Real, 1>{n_points_for_image(image, at)}; });
}
} // namespace ddfem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ddfem
{
HWY_EXPORT(plan_image);

namespace internal
{
void plan_for_image(const SegmentImageData &image, const std::size_t n_points, const double *const (&x)[3],
                    double *const n)
{
  HWY_DYNAMIC_DISPATCH(plan_image)(image, n_points, x, n);
}
} // namespace internal
} // namespace ddfem
#endif
