// Points and values at them as the vectorised kernels read and write them: component by component.
#pragma once

#include "dd/common/types.h"

#include <cstddef>
#include <vector>

namespace ddfem
{
/// Arrays that a kernel adds to; they belong to somebody else.
template <std::size_t n_values> struct PointBatch
{
  std::size_t n;           ///< number of points
  const double *x[3];      ///< coordinates, nm
  double *value[n_values]; ///< one array for each component
};

/// A batch with its own memory, values zero at first.
template <std::size_t n_values> class PointBuffer
{
public:
  using Value = Eigen::Matrix<double, static_cast<int>(n_values), 1>;

  explicit PointBuffer(std::size_t n_points) : n(n_points), numbers((3 + n_values) * n_points, 0.0) {}

  /// @p x: anything with three components, nm.
  template <class Point> void set_point(const std::size_t i, const Point &x)
  {
    numbers[i] = x[0];
    numbers[n + i] = x[1];
    numbers[2 * n + i] = x[2];
  }
  PointBatch<n_values> batch()
  {
    PointBatch<n_values> result{n, {}, {}};
    for (std::size_t c = 0; c < 3; ++c)
      result.x[c] = numbers.data() + c * n;
    for (std::size_t c = 0; c < n_values; ++c)
      result.value[c] = numbers.data() + (3 + c) * n;
    return result;
  }
  Value value(const std::size_t i) const
  {
    Value v;
    for (std::size_t c = 0; c < n_values; ++c)
      v[static_cast<Eigen::Index>(c)] = numbers[(3 + c) * n + i];
    return v;
  }

private:
  std::size_t n;
  std::vector<double> numbers; // coordinates and values, component by component
};

using StressBatch = PointBatch<6>; ///< xx yy zz xy xz yz, MPa
using StressBuffer = PointBuffer<6>;
using DisplacementBatch = PointBatch<3>; ///< nm
using DisplacementBuffer = PointBuffer<3>;
} // namespace ddfem
