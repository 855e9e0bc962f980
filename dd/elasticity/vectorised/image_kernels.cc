#include "dd/elasticity/vectorised/image_kernels.h"

#include "dd/elasticity/image_quadrature.h"
#include "dd/elasticity/vectorised/image_plan.h"
#include "dd/elasticity/vectorised/line_points.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dd/elasticity/vectorised/image_kernels.cc"
// clang-format off: before what is compiled for every instruction set
#include <hwy/foreach_target.h>
// clang-format on

#include "dd/elasticity/half_space_image-inl.h"
#include "dd/elasticity/vectorised/lane_rules-inl.h"
#include "dd/elasticity/vectorised/point_groups-inl.h"

#include <algorithm>
#include <array>
#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace ddfem::HWY_NAMESPACE
{
namespace
{
HWY_INLINE std::array<Real, 6> values_of(const Tensor<Real> &s)
{
  return {s.xx, s.yy, s.zz, s.xy, s.xz, s.yz};
}
HWY_INLINE std::array<Real, 3> values_of(const Vector<Real> &u)
{
  return {u.x, u.y, u.z};
}

/// What the integral over the elements gives, and what is added to it.
struct StressOfImage
{
  using Sums = StressSums<Real>;
  static constexpr std::size_t n_values = 6;

  static HWY_INLINE std::array<Real, 6> of_elements(const SegmentImageData &d, const Sums &sums, const Real &depth)
  {
    Tensor<Real> sigma{};
    sums.add_stress_to(sigma, Real(d.medium.mu / (2 * std::numbers::pi)), Real(d.medium.nu), depth);
    return values_of(sigma);
  }
  static HWY_INLINE std::array<Real, 6> of_mirror(const SegmentImageData &d, const Vector<Real> &x)
  {
    Tensor<Real> sigma{};
    const Line<Real> mirror = mirror_of<Real>(d);
    add_scaled_stress(d.medium, segment_stress_terms(StressConstants<Real>(d.medium), mirror, x), mirror.t, sigma);
    return values_of(sigma);
  }
};

struct DisplacementOfImage
{
  using Sums = DisplacementSums<Real>;
  static constexpr std::size_t n_values = 3;

  static HWY_INLINE std::array<Real, 3> of_elements(const SegmentImageData &d, const Sums &sums, const Real &depth)
  {
    return values_of(sums.displacement(d.medium.mu / (2 * std::numbers::pi), d.medium.mu, d.medium.nu, depth));
  }
  static HWY_INLINE std::array<Real, 3> of_mirror(const SegmentImageData &d, const Vector<Real> &x)
  {
    return values_of(displacement_of(d.medium.nu, d.strip, 1.0, x));
  }
};

/// The mirror image at all points, and the elements at those for which a single panel is enough (@p counts: numbers of
/// Gauss points, filled up to whole registers).
template <class Field>
HWY_INLINE void add_by_lanes(const SegmentImageData &d, const std::size_t n, const double *const (&x)[3],
                             double *const (&values)[Field::n_values], const double *const counts)
{
  add_at_points(n, x, values,
                [&](const std::size_t i, const Vector<Real> &at) HWY_ATTR
                {
                  typename Field::Sums sums{};
                  const LaneRules rules(counts + i);
                  rules.for_each([&](const Real &position, const Real &weight) HWY_ATTR
                                 { add_image_element(d, at, position, Real(d.length) * weight, sums); });
                  auto result = Field::of_elements(d, sums, at.z);
                  const auto mirror = Field::of_mirror(d, at);
                  for (std::size_t c = 0; c < Field::n_values; ++c)
                    result[c] += mirror[c];
                  return result;
                });
}

/// The elements at one point @p x, with points of the quadrature in the lanes.
template <class Field>
HWY_INLINE void add_by_elements(const SegmentImageData &d, const Vec3 &x, const internal::LinePoints &points,
                                double (&values)[Field::n_values])
{
  typename Field::Sums sums{};
  const Vector<Real> at = vector_of<Real>(x);
  for (std::size_t q = 0; q < points.n; q += n_lanes)
    add_image_element(d, at, Real::load(&points.position[q]), Real(d.length) * Real::load(&points.weight[q]), sums);
  const auto elements = Field::of_elements(d, sums, at.z);
  for (std::size_t c = 0; c < Field::n_values; ++c)
    values[c] += sum_of_lanes(elements[c]);
}
} // namespace

void add_stress_by_lanes(const SegmentImageData &d, const StressBatch &batch, const double *counts)
{
  add_by_lanes<StressOfImage>(d, batch.n, batch.x, batch.sigma, counts);
}

void add_displacement_by_lanes(const SegmentImageData &d, const DisplacementBatch &batch, const double *counts)
{
  add_by_lanes<DisplacementOfImage>(d, batch.n, batch.x, batch.u, counts);
}

void add_stress_by_elements(const SegmentImageData &d, const Vec3 &x, const internal::LinePoints &points,
                            double (&values)[6])
{
  add_by_elements<StressOfImage>(d, x, points, values);
}

void add_displacement_by_elements(const SegmentImageData &d, const Vec3 &x, const internal::LinePoints &points,
                                  double (&values)[3])
{
  add_by_elements<DisplacementOfImage>(d, x, points, values);
}

void add_leg_stress(const LegImageData &d, const StressBatch &batch)
{
  add_at_points(batch.n, batch.x, batch.sigma,
                [&](std::size_t, const Vector<Real> &x) HWY_ATTR { return values_of(stress_of(d, x)); });
}

void add_leg_displacement(const LegImageData &d, const DisplacementBatch &batch)
{
  add_at_points(batch.n, batch.x, batch.u,
                [&](std::size_t, const Vector<Real> &x) HWY_ATTR { return values_of(displacement_of(d, x)); });
}

void add_piercing_stress(const PiercingImageData &d, const StressBatch &batch)
{
  add_at_points(batch.n, batch.x, batch.sigma,
                [&](std::size_t, const Vector<Real> &x) HWY_ATTR { return values_of(stress_of(d, x)); });
}

void add_piercing_displacement(const PiercingImageData &d, const DisplacementBatch &batch)
{
  add_at_points(batch.n, batch.x, batch.u,
                [&](std::size_t, const Vector<Real> &x) HWY_ATTR { return values_of(displacement_of(d, x)); });
}
} // namespace ddfem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ddfem
{
HWY_EXPORT(add_stress_by_lanes);
HWY_EXPORT(add_displacement_by_lanes);
HWY_EXPORT(add_stress_by_elements);
HWY_EXPORT(add_displacement_by_elements);
HWY_EXPORT(add_leg_stress);
HWY_EXPORT(add_leg_displacement);
HWY_EXPORT(add_piercing_stress);
HWY_EXPORT(add_piercing_displacement);

namespace
{
/// Points [first, first + n) of a batch.
StressBatch part_of(const StressBatch &batch, const std::size_t first, const std::size_t n)
{
  StressBatch part{n, {}, {}};
  std::transform(batch.x, batch.x + 3, part.x, [&](const double *p) { return p + first; });
  std::transform(batch.sigma, batch.sigma + 6, part.sigma, [&](double *p) { return p + first; });
  return part;
}

DisplacementBatch part_of(const DisplacementBatch &batch, const std::size_t first, const std::size_t n)
{
  DisplacementBatch part{n, {}, {}};
  std::transform(batch.x, batch.x + 3, part.x, [&](const double *p) { return p + first; });
  std::transform(batch.u, batch.u + 3, part.u, [&](double *p) { return p + first; });
  return part;
}

/// @p by_lanes(part, counts) and @p by_elements(x, points, values) add to the points of a portion; @p values_of are
/// the arrays of a batch that they add to.
template <std::size_t n_values, class Batch, class ByLanes, class ByElements>
void add_segment_image(const SegmentImageData &image, const Batch &batch, double *const (Batch::*values_of)[n_values],
                       ByLanes &&by_lanes, ByElements &&by_elements)
{
  constexpr std::size_t portion = 64;
  if (!(image.length > 0))
    return;
  for (std::size_t first = 0; first < batch.n; first += portion)
  {
    const Batch part = part_of(batch, first, std::min(portion, batch.n - first));
    std::array<double, portion + LineTable::block_size> counts{};
    internal::plan_for_image(image, part.n, part.x, counts.data());
    std::fill(counts.begin() + static_cast<std::ptrdiff_t>(part.n), counts.end(), counts[part.n - 1]);
    by_lanes(part, counts.data());
    for (std::size_t i = 0; i < part.n; ++i)
      if (counts[i] == 0.0)
      {
        const Vec3 x(part.x[0][i], part.x[1][i], part.x[2][i]);
        double sums[n_values] = {};
        internal::LinePoints points;
        const auto use = [&] { by_elements(x, points, sums); };
        internal::integrate_graded(internal::image_singularities(image, x), image.length, image.tolerance,
                                   [&](const double s, const double weight)
                                   { points.add(s / image.length, weight / image.length, use); });
        points.finish(use);
        for (std::size_t c = 0; c < n_values; ++c)
          (part.*values_of)[c][i] += sums[c];
      }
  }
}
} // namespace

void add_image_stress(const SegmentImageData &image, const StressBatch &batch)
{
  add_segment_image<6>(
      image, batch, &StressBatch::sigma,
      [&](const StressBatch &part, const double *counts) {
        HWY_DYNAMIC_DISPATCH(add_stress_by_lanes)(image, part, counts);
      },
      [&](const Vec3 &x, const internal::LinePoints &points, double(&sums)[6]) {
        HWY_DYNAMIC_DISPATCH(add_stress_by_elements)(image, x, points, sums);
      });
}

void add_image_displacement(const SegmentImageData &image, const DisplacementBatch &batch)
{
  add_segment_image<3>(
      image, batch, &DisplacementBatch::u,
      [&](const DisplacementBatch &part, const double *counts) {
        HWY_DYNAMIC_DISPATCH(add_displacement_by_lanes)(image, part, counts);
      },
      [&](const Vec3 &x, const internal::LinePoints &points, double(&sums)[3]) {
        HWY_DYNAMIC_DISPATCH(add_displacement_by_elements)(image, x, points, sums);
      });
}

void add_image_stress(const LegImageData &image, const StressBatch &batch)
{
  HWY_DYNAMIC_DISPATCH(add_leg_stress)(image, batch);
}

void add_image_displacement(const LegImageData &image, const DisplacementBatch &batch)
{
  HWY_DYNAMIC_DISPATCH(add_leg_displacement)(image, batch);
}

void add_image_stress(const PiercingImageData &image, const StressBatch &batch)
{
  HWY_DYNAMIC_DISPATCH(add_piercing_stress)(image, batch);
}

void add_image_displacement(const PiercingImageData &image, const DisplacementBatch &batch)
{
  HWY_DYNAMIC_DISPATCH(add_piercing_displacement)(image, batch);
}
} // namespace ddfem
#endif
