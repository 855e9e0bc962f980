// Mean of a correlated series and its standard error.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace ddfem
{
struct Estimate
{
  double mean = 0, error = 0; ///< error: one standard deviation of the mean
};

/// Mean of independent values.
inline Estimate estimate(const std::vector<double> &values)
{
  const auto n = static_cast<double>(values.size());
  Estimate e;
  double squares = 0;
  for (const double v : values)
  {
    e.mean += v / n;
    squares += v * v / n;
  }
  e.error = std::sqrt((squares - e.mean * e.mean) / (n - 1));
  return e;
}

/// Mean of a stationary series by the means of @p n_blocks blocks, each much longer than the correlation.
inline Estimate estimate_by_blocks(const std::vector<double> &series, const std::size_t n_blocks)
{
  std::vector<double> blocks(n_blocks, 0.0);
  const std::size_t length = series.size() / n_blocks;
  for (std::size_t k = 0; k < n_blocks * length; ++k)
    blocks[k / length] += series[k] / static_cast<double>(length);
  return estimate(blocks);
}
} // namespace ddfem
