// Sizes of lists of values, and sizes of tests.
#pragma once

#include <cmath>
#include <cstddef>

namespace ddfem::samples
{
/// Root mean square of the norms.
template <class Values> double rms(const Values &values)
{
  double sum = 0;
  for (const auto &v : values)
    sum += v.squaredNorm();
  return std::sqrt(sum / static_cast<double>(values.size()));
}

template <class Values> Values difference(Values a, const Values &b)
{
  for (std::size_t i = 0; i < a.size(); ++i)
    a[i] -= b[i];
  return a;
}

/// With sanitizers everything takes ten to twenty times as long: long tests look at less.
#ifdef __SANITIZE_ADDRESS__
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif
} // namespace ddfem::samples
