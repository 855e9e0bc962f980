#include "dd/elasticity/vectorised/force_plan.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dd/elasticity/vectorised/force_plan.cc"
// clang-format off: before what is compiled for every instruction set
#include <hwy/foreach_target.h>
// clang-format on

#include "dd/elasticity/panel_plan-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ddfem::HWY_NAMESPACE
{
namespace
{
template <class EllipseOf>
HWY_INLINE void plan(const LineTable &lines, const std::size_t first, const std::size_t n_blocks,
                     const internal::ForceTarget &target, const double tolerance, double *n, EllipseOf &&ellipse_of)
{
  const Panel<Real> panel{vector_of<Real>(target.x3), vector_of<Real>(target.x4), vector_of<Real>(target.t),
                          Real(target.length)};
  for (std::size_t k = first; k < first + n_blocks; ++k)
    for (std::size_t offset = 0; offset < LineTable::block_size; offset += n_lanes, n += n_lanes)
      n_points_on_panel(ellipse_of(lines_of(lines.block(k), offset), panel), tolerance).store(n);
}
} // namespace

void plan_segments(const LineTable &lines, std::size_t first, std::size_t n_blocks, const internal::ForceTarget &target,
                   double a, double tolerance, double *n)
{
  plan(lines, first, n_blocks, target, tolerance, n,
       [a2 = Real(a * a)](const Line<Real> &l, const Panel<Real> &p) HWY_ATTR { return ellipse_of_segment(l, p, a2); });
}

void plan_rays(const LineTable &lines, std::size_t first, std::size_t n_blocks, const internal::ForceTarget &target,
               double a, double tolerance, double *n)
{
  plan(lines, first, n_blocks, target, tolerance, n,
       [a2 = Real(a * a)](const Line<Real> &l, const Panel<Real> &p) HWY_ATTR { return ellipse_of_ray(l, p, a2); });
}
} // namespace ddfem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ddfem
{
HWY_EXPORT(plan_segments);
HWY_EXPORT(plan_rays);

namespace internal
{
void plan_for_segments(const LineTable &lines, const std::size_t first, const std::size_t n_blocks,
                       const ForceTarget &target, const double a, const double tolerance, double *const n)
{
  HWY_DYNAMIC_DISPATCH(plan_segments)(lines, first, n_blocks, target, a, tolerance, n);
}

void plan_for_rays(const LineTable &lines, const std::size_t first, const std::size_t n_blocks,
                   const ForceTarget &target, const double a, const double tolerance, double *const n)
{
  HWY_DYNAMIC_DISPATCH(plan_rays)(lines, first, n_blocks, target, a, tolerance, n);
}
} // namespace internal
} // namespace ddfem
#endif
