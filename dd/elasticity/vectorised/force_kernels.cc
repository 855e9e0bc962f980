#include "dd/elasticity/vectorised/force_kernels.h"

#include "dd/elasticity/panel_quadrature.h"
#include "dd/elasticity/vectorised/force_plan.h"
#include "dd/elasticity/vectorised/line_points.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dd/elasticity/vectorised/force_kernels.cc"
// clang-format off: before what is compiled for every instruction set
#include <hwy/foreach_target.h>
// clang-format on

#include "dd/elasticity/line_stress-inl.h"
#include "dd/elasticity/vectorised/lane_rules-inl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#ifndef DDFEM_DD_ELASTICITY_FORCE_KERNELS_ONCE
#define DDFEM_DD_ELASTICITY_FORCE_KERNELS_ONCE
namespace ddfem::internal
{
/// Lines whose numbers of points are found together.
constexpr std::size_t chunk_of_blocks = 8, chunk_of_lines = chunk_of_blocks * LineTable::block_size;

/// Integrals of sigma.b (units of mu/(4 pi), and of the segment's length) and of their moments, lane by lane.
struct LaneSums
{
  alignas(64) double value[6][LineTable::block_size] = {};
};
} // namespace ddfem::internal
#endif

HWY_BEFORE_NAMESPACE();
namespace ddfem::HWY_NAMESPACE
{
namespace
{
struct Sums
{
  Vector<Real> total{}, moment{};

  HWY_INLINE explicit Sums(const internal::LaneSums &s)
      : total{Real::load(s.value[0]), Real::load(s.value[1]), Real::load(s.value[2])}, moment{Real::load(s.value[3]),
                                                                                              Real::load(s.value[4]),
                                                                                              Real::load(s.value[5])}
  {
  }
  HWY_INLINE void add(const Real &position, const Vector<Real> &weighted)
  {
    total += weighted;
    moment += position * weighted;
  }
  HWY_INLINE void store(internal::LaneSums &s) const
  {
    total.x.store(s.value[0]);
    total.y.store(s.value[1]);
    total.z.store(s.value[2]);
    moment.x.store(s.value[3]);
    moment.y.store(s.value[4]);
    moment.z.store(s.value[5]);
  }
};

/// Adds what the lines in the lanes do on single panels.
template <class TermsOf>
HWY_INLINE void add_lanes(const StressConstants<Real> &constants, const Line<Real> &lines,
                          const internal::ForceTarget &target, const double *const n_of_lane, Sums &sums,
                          TermsOf &&terms_of)
{
  const LaneRules rules(n_of_lane);
  const Vector<Real> x3 = vector_of<Real>(target.x3), r = vector_of<Real>(target.x4 - target.x3),
                     b = vector_of<Real>(target.b);
  const auto force = [&](const Real &position, const Real &weight) HWY_ATTR
  { return weight * traction(terms_of(constants, lines, x3 + position * r), lines.t, b); };
  if (!rules.has_idle_lanes())
    rules.for_each([&](const Real &position, const Real &weight) HWY_ATTR
                   { sums.add(position, force(position, weight)); });
  else // idle lanes may hold infinities
    rules.for_each([&](const Real &position, const Real &weight) HWY_ATTR
                   { sums.add(position, select(Real(0.0) < weight, force(position, weight), Vector<Real>{})); });
}

template <class TermsOf>
HWY_INLINE void add_single_panels(const IsotropicMedium &medium, const LineTable &lines, const std::size_t first,
                                  const std::size_t n_blocks, const internal::ForceTarget &target, const double *n,
                                  internal::LaneSums &lane_sums, TermsOf &&terms_of)
{
  const StressConstants<Real> constants(medium);
  Sums sums(lane_sums);
  for (std::size_t k = first; k < first + n_blocks; ++k)
    for (std::size_t offset = 0; offset < LineTable::block_size; offset += n_lanes, n += n_lanes)
      add_lanes(constants, lines_of(lines.block(k), offset), target, n, sums, terms_of);
  sums.store(lane_sums);
}

/// Adds what one line does at the given points, whose number is a multiple of that of the lanes.
template <class TermsOf>
HWY_INLINE void add_points(const IsotropicMedium &medium, const LineTable &lines, const std::size_t number,
                           const internal::ForceTarget &target, const internal::LinePoints &points,
                           internal::LaneSums &lane_sums, TermsOf &&terms_of)
{
  const StressConstants<Real> constants(medium);
  const Line<Real> line = line_of<Real>(lines, number);
  const Vector<Real> x3 = vector_of<Real>(target.x3), r = vector_of<Real>(target.x4 - target.x3),
                     b = vector_of<Real>(target.b);
  Sums sums(lane_sums);
  for (std::size_t q = 0; q < points.n; q += n_lanes)
  {
    const Real position = Real::load(&points.position[q]), weight = Real::load(&points.weight[q]);
    sums.add(position, weight * traction(terms_of(constants, line, x3 + position * r), line.t, b));
  }
  sums.store(lane_sums);
}

struct OfSegments
{
  HWY_INLINE StressTerms<Real> operator()(const StressConstants<Real> &c, const Line<Real> &l,
                                          const Vector<Real> &x) const
  {
    return segment_stress_terms(c, l, x);
  }
};

struct OfRays
{
  HWY_INLINE StressTerms<Real> operator()(const StressConstants<Real> &c, const Line<Real> &l,
                                          const Vector<Real> &x) const
  {
    return ray_stress_terms(c, l, x);
  }
};
} // namespace

void add_segments_by_lanes(const IsotropicMedium &medium, const LineTable &lines, std::size_t first,
                           std::size_t n_blocks, const internal::ForceTarget &target, const double *n,
                           internal::LaneSums &sums)
{
  add_single_panels(medium, lines, first, n_blocks, target, n, sums, OfSegments());
}

void add_rays_by_lanes(const IsotropicMedium &medium, const LineTable &lines, std::size_t first, std::size_t n_blocks,
                       const internal::ForceTarget &target, const double *n, internal::LaneSums &sums)
{
  add_single_panels(medium, lines, first, n_blocks, target, n, sums, OfRays());
}

void add_segment_by_points(const IsotropicMedium &medium, const LineTable &lines, std::size_t number,
                           const internal::ForceTarget &target, const internal::LinePoints &points,
                           internal::LaneSums &sums)
{
  add_points(medium, lines, number, target, points, sums, OfSegments());
}

void add_ray_by_points(const IsotropicMedium &medium, const LineTable &lines, std::size_t number,
                       const internal::ForceTarget &target, const internal::LinePoints &points,
                       internal::LaneSums &sums)
{
  add_points(medium, lines, number, target, points, sums, OfRays());
}
} // namespace ddfem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ddfem
{
HWY_EXPORT(add_segments_by_lanes);
HWY_EXPORT(add_rays_by_lanes);
HWY_EXPORT(add_segment_by_points);
HWY_EXPORT(add_ray_by_points);

namespace
{
/// What is called for segments, or for rays.
struct LineKernels
{
  decltype(&internal::plan_for_segments) plan;
  decltype(&HWY_DYNAMIC_DISPATCH(add_segments_by_lanes)) add_lanes;
  decltype(&HWY_DYNAMIC_DISPATCH(add_segment_by_points)) add_points;
  /// Of the line with the given ends and direction, core radius a.
  internal::LineSingularities (*singularities)(const Vec3 &x1, const Vec3 &x2, const Vec3 &t, double a,
                                               const internal::ForceTarget &target);
};

LineKernels segment_kernels()
{
  return {internal::plan_for_segments, &HWY_DYNAMIC_DISPATCH(add_segments_by_lanes),
          &HWY_DYNAMIC_DISPATCH(add_segment_by_points),
          [](const Vec3 &x1, const Vec3 &x2, const Vec3 & /*t*/, const double a, const internal::ForceTarget &target)
          { return internal::LineSingularities::of_segment(x1, x2, a, target.x3, target.t); }};
}

LineKernels ray_kernels()
{
  return {internal::plan_for_rays, &HWY_DYNAMIC_DISPATCH(add_rays_by_lanes), &HWY_DYNAMIC_DISPATCH(add_ray_by_points),
          [](const Vec3 &x1, const Vec3 & /*x2*/, const Vec3 &t, const double a, const internal::ForceTarget &target)
          { return internal::LineSingularities::of_ray(x1, t, a, target.x3, target.t); }};
}

/// Adds what one near line does, in portions of points.
void add_near_line(const LineKernels &kernels, const IsotropicMedium &medium, const LineTable &lines,
                   const std::size_t number, const internal::ForceTarget &target, const double tolerance,
                   internal::LaneSums &sums)
{
  const auto vector = [&](const LineTable::Row row) { return lines.vector(number, row); };
  internal::LinePoints points;
  const auto use = [&] { kernels.add_points(medium, lines, number, target, points, sums); };
  internal::integrate_graded(kernels.singularities(vector(LineTable::first_end), vector(LineTable::second_end),
                                                   vector(LineTable::direction), medium.a, target),
                             target.length, tolerance,
                             [&](const double z, const double weight)
                             { points.add(z / target.length, weight / target.length, use); });
  points.finish(use);
}

SegmentForces forces_from(const IsotropicMedium &medium, const internal::LaneSums &sums,
                          const internal::ForceTarget &target)
{
  const double unit = medium.mu / (4.0 * std::numbers::pi) * target.length;
  std::array<double, 6> sum{};
  for (std::size_t c = 0; c < 6; ++c)
    for (const double lane : sums.value[c])
      sum[c] += unit * lane;
  const Vec3 total(sum[0], sum[1], sum[2]), moment(sum[3], sum[4], sum[5]);
  return {(total - moment).cross(target.t), moment.cross(target.t)};
}

/// Sum over portions of lines: plan(target, block, n_blocks, n_points) says how many points each line gets on a single panel, add_rest(target,
/// i, n_points, sums) adds what line number i does besides.
template <class Plan, class AddRest>
SegmentForces sum_portions(const LineKernels &kernels, const IsotropicMedium &medium, const LineTable &lines,
                           const Vec3 &x3, const Vec3 &x4, const Vec3 &b34, Plan &&plan, AddRest &&add_rest)
{
  const double length = (x4 - x3).norm();
  if (length == 0.0)
    return {};
  const internal::ForceTarget target{x3, x4, (x4 - x3) / length, b34, length};
  internal::LaneSums sums;
  std::array<double, internal::chunk_of_lines> n_points;
  for (std::size_t block = 0; block < lines.n_blocks(); block += internal::chunk_of_blocks)
  {
    const std::size_t n_blocks = std::min(internal::chunk_of_blocks, lines.n_blocks() - block);
    const std::size_t first = block * LineTable::block_size, end = first + n_blocks * LineTable::block_size;
    plan(target, block, n_blocks, n_points.data());
    for (std::size_t i = lines.size(); i < end; ++i)
      n_points[i - first] = -1.0; // nothing there
    kernels.add_lanes(medium, lines, block, n_blocks, target, n_points.data(), sums);
    for (std::size_t i = first; i < end; ++i)
      add_rest(target, i, n_points[i - first], sums);
  }
  return forces_from(medium, sums, target);
}

SegmentForces force_of_lines(const LineKernels &kernels, const IsotropicMedium &medium, const LineTable &lines,
                             const Vec3 &x3, const Vec3 &x4, const Vec3 &b34, const double tolerance,
                             const std::size_t without)
{
  return sum_portions(
      kernels, medium, lines, x3, x4, b34,
      [&](const internal::ForceTarget &target, const std::size_t block, const std::size_t n_blocks, double *n_points)
      {
        kernels.plan(lines, block, n_blocks, target, medium.a, tolerance, n_points);
        const std::size_t first = block * LineTable::block_size;
        if (without >= first && without < first + n_blocks * LineTable::block_size)
          n_points[without - first] = -1.0;
      },
      [&](const internal::ForceTarget &target, const std::size_t i, const double n_points, internal::LaneSums &sums)
      {
        if (n_points == 0.0)
          add_near_line(kernels, medium, lines, i, target, tolerance, sums);
      });
}
} // namespace

SegmentForces force_of_segments(const IsotropicMedium &medium, const LineTable &segments, const Vec3 &x3,
                                const Vec3 &x4, const Vec3 &b34, const double tolerance, const std::size_t without)
{
  return force_of_lines(segment_kernels(), medium, segments, x3, x4, b34, tolerance, without);
}

SegmentForces force_of_segments_by_rule(const IsotropicMedium &medium, const LineTable &segments, const Vec3 &x3,
                                        const Vec3 &x4, const Vec3 &b34, const int n_gauss)
{
  return sum_portions(
      segment_kernels(), medium, segments, x3, x4, b34,
      [&](const internal::ForceTarget &, std::size_t, const std::size_t n_blocks, double *n_points)
      { std::fill(n_points, n_points + n_blocks * LineTable::block_size, n_gauss); },
      [](const internal::ForceTarget &, std::size_t, double, internal::LaneSums &) {});
}

SegmentForces force_of_rays(const IsotropicMedium &medium, const LineTable &rays, const Vec3 &x3, const Vec3 &x4,
                            const Vec3 &b34, const double tolerance)
{
  return force_of_lines(ray_kernels(), medium, rays, x3, x4, b34, tolerance, no_line);
}
} // namespace ddfem
#endif
