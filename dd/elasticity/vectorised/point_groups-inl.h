// Loops over points, as many at a time as there are lanes.

#if defined(DDFEM_DD_ELASTICITY_POINT_GROUPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DDFEM_DD_ELASTICITY_POINT_GROUPS_INL_H
#undef DDFEM_DD_ELASTICITY_POINT_GROUPS_INL_H
#else
#define DDFEM_DD_ELASTICITY_POINT_GROUPS_INL_H
#endif

#include "dd/elasticity/real-inl.h"

#include <algorithm>
#include <array>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace ddfem::HWY_NAMESPACE
{
/// values[c][i] += f(i, x_i)[c] for @p n points, f being a function from the number of the first of n_lanes points and a
/// Vector<Real> to std::array<Real, n_values>. In the last group the last point is repeated.
template <std::size_t n_values, class Function>
HWY_INLINE void add_at_points(const std::size_t n, const double *const (&x)[3], double *const (&values)[n_values],
                              Function &&f)
{
  std::size_t i = 0;
  for (; i + n_lanes <= n; i += n_lanes)
  {
    const std::array<Real, n_values> sums =
        f(i, Vector<Real>{Real::load(x[0] + i), Real::load(x[1] + i), Real::load(x[2] + i)});
    for (std::size_t c = 0; c < n_values; ++c)
      (Real::load(values[c] + i) + sums[c]).store(values[c] + i);
  }
  if (i == n)
    return;
  double rest[3][n_lanes], sums_of_rest[n_lanes];
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t l = 0; l < n_lanes; ++l)
      rest[c][l] = x[c][std::min(i + l, n - 1)];
  const std::array<Real, n_values> sums =
      f(i, Vector<Real>{Real::load(rest[0]), Real::load(rest[1]), Real::load(rest[2])});
  for (std::size_t c = 0; c < n_values; ++c)
  {
    sums[c].store(sums_of_rest);
    for (std::size_t l = 0; i + l < n; ++l)
      values[c][i + l] += sums_of_rest[l];
  }
}
} // namespace ddfem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
