// How many Gauss points a single panel needs for the image of a segment. Compiled like panel_plan-inl.h.

#if defined(DDFEM_DD_ELASTICITY_IMAGE_PLAN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DDFEM_DD_ELASTICITY_IMAGE_PLAN_INL_H
#undef DDFEM_DD_ELASTICITY_IMAGE_PLAN_INL_H
#else
#define DDFEM_DD_ELASTICITY_IMAGE_PLAN_INL_H
#endif

#include "dd/elasticity/half_space_image.h"
#include "dd/elasticity/panel_plan-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ddfem::HWY_NAMESPACE
{
/// Number of points for the image of a segment (of length > 0) at @p x; 0: a graded partition is needed.
template <class T> HWY_INLINE T n_points_for_image(const SegmentImageData &d, const Vector<T> &x)
{
  const T length(d.length);
  const Panel<T> panel{vector_of<T>(d.start), vector_of<T>(d.end), vector_of<T>(d.t), length};
  return n_points_on_panel(min(distance_sum(x, panel, T(d.medium.a * d.medium.a)), T(d.branch)) / length, d.tolerance);
}
} // namespace ddfem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
