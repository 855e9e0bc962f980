// Stress of many straight lines at many points, with the vector instructions of the processor that the program runs on.
#pragma once

#include "dd/elasticity/isotropic.h"
#include "dd/elasticity/line_table.h"

#include <cstddef>
#include <span>
#include <vector>

namespace ddfem
{
/// Points and the stresses at them, component by component, for evaluation in a vectorised loop.
struct StressBatch
{
  std::size_t n;      ///< number of points
  const double *x[3]; ///< coordinates, nm
  double *sigma[6];   ///< xx yy zz xy xz yz, MPa
};

/// A batch with its own memory, stresses zero at first.
class StressBuffer
{
public:
  explicit StressBuffer(std::size_t n_points) : n(n_points), numbers(9 * n_points, 0.0) {}

  /// @p x: anything with three components, nm.
  template <class Point> void set_point(const std::size_t i, const Point &x)
  {
    numbers[i] = x[0];
    numbers[n + i] = x[1];
    numbers[2 * n + i] = x[2];
  }
  StressBatch batch()
  {
    double *const p = numbers.data();
    return {n, {p, p + n, p + 2 * n}, {p + 3 * n, p + 4 * n, p + 5 * n, p + 6 * n, p + 7 * n, p + 8 * n}};
  }
  /// MPa.
  SymTensor stress(const std::size_t i) const
  {
    SymTensor s;
    for (std::size_t c = 0; c < 6; ++c)
      s[static_cast<Eigen::Index>(c)] = numbers[(3 + c) * n + i];
    return s;
  }

private:
  std::size_t n;
  std::vector<double> numbers; // coordinates and stresses, component by component
};

/// Adds the stress of all segments of a table at all points: segment_stress() to rounding. The sum at a point runs over the
/// segments in their order and does not depend on the other points.
void add_segment_stress(const IsotropicMedium &medium, const LineTable &segments, const StressBatch &batch);
/// The same of some of the segments, by their numbers.
void add_segment_stress(const IsotropicMedium &medium, const LineTable &segments, std::span<const unsigned> which,
                        const StressBatch &batch);

/// Adds the stress of rays: ray_stress() to rounding.
void add_ray_stress(const IsotropicMedium &medium, const LineTable &rays, const StressBatch &batch);
void add_ray_stress(const IsotropicMedium &medium, const LineTable &rays, std::span<const unsigned> which,
                    const StressBatch &batch);
} // namespace ddfem
