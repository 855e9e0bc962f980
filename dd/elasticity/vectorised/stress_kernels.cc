#include "dd/elasticity/vectorised/stress_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dd/elasticity/vectorised/stress_kernels.cc"
// clang-format off: before what is compiled for every instruction set
#include <hwy/foreach_target.h>
// clang-format on

#include "dd/elasticity/line_stress-inl.h"
#include "dd/elasticity/vectorised/point_groups-inl.h"

#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace ddfem::HWY_NAMESPACE
{
namespace
{
/// The lines to be summed: numbers which[0] ... which[n - 1], or all if there is no list.
struct Sources
{
  const LineTable &lines;
  const unsigned *which;
  std::size_t n;
};

template <class TermsOf>
HWY_INLINE void add_lines(const IsotropicMedium &medium, const Sources &sources, const StressBatch &batch,
                          TermsOf &&terms_of)
{
  const StressConstants<Real> constants(medium);
  const Real unit(medium.mu / (4.0 * std::numbers::pi));
  add_at_points(batch.n, batch.x, batch.sigma,
                [&](std::size_t, const Vector<Real> &x) HWY_ATTR
                {
                  Tensor<Real> sum{};
                  for (std::size_t k = 0; k < sources.n; ++k)
                  {
                    const Line<Real> line = line_of<Real>(sources.lines, sources.which ? sources.which[k] : k);
                    add_stress(terms_of(constants, line, x), line.t, sum);
                  }
                  return std::array<Real, 6>{unit * sum.xx, unit * sum.yy, unit * sum.zz,
                                             unit * sum.xy, unit * sum.xz, unit * sum.yz};
                });
}
} // namespace

void add_segments(const IsotropicMedium &medium, const LineTable &lines, const unsigned *which, std::size_t n,
                  const StressBatch &batch)
{
  add_lines(medium, Sources{lines, which, n}, batch,
            [](const StressConstants<Real> &c, const Line<Real> &l, const Vector<Real> &x) HWY_ATTR
            { return segment_stress_terms(c, l, x); });
}

void add_rays(const IsotropicMedium &medium, const LineTable &lines, const unsigned *which, std::size_t n,
              const StressBatch &batch)
{
  add_lines(medium, Sources{lines, which, n}, batch,
            [](const StressConstants<Real> &c, const Line<Real> &l, const Vector<Real> &x) HWY_ATTR
            { return ray_stress_terms(c, l, x); });
}
} // namespace ddfem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ddfem
{
HWY_EXPORT(add_segments);
HWY_EXPORT(add_rays);

void add_segment_stress(const IsotropicMedium &medium, const LineTable &segments, const StressBatch &batch)
{
  HWY_DYNAMIC_DISPATCH(add_segments)(medium, segments, nullptr, segments.size(), batch);
}

void add_segment_stress(const IsotropicMedium &medium, const LineTable &segments, const std::span<const unsigned> which,
                        const StressBatch &batch)
{
  HWY_DYNAMIC_DISPATCH(add_segments)(medium, segments, which.data(), which.size(), batch);
}

void add_ray_stress(const IsotropicMedium &medium, const LineTable &rays, const StressBatch &batch)
{
  HWY_DYNAMIC_DISPATCH(add_rays)(medium, rays, nullptr, rays.size(), batch);
}

void add_ray_stress(const IsotropicMedium &medium, const LineTable &rays, const std::span<const unsigned> which,
                    const StressBatch &batch)
{
  HWY_DYNAMIC_DISPATCH(add_rays)(medium, rays, which.data(), which.size(), batch);
}
} // namespace ddfem
#endif
