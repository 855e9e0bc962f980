#include "dd/fmm/accuracy.h"

#include "dd/fmm/solid_harmonics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ddfem::fmm
{
namespace
{
/// For the choice of orders at larger distances: the error falls like (radius/distance)^order. Chosen by measurement: 0.9
/// makes the error 20 % larger, 0.4 20 % smaller.
constexpr double effective_radius = 0.75;
} // namespace

int expansion_order(const double tolerance)
{
  if (!(tolerance >= 1e-8 && tolerance <= 0.1))
    throw std::invalid_argument("requested error of the far field outside [1e-8, 0.1]");
  // Measured (benchmarks/accuracy.cc, two seeds and sizes): an order gains a factor of 2.1 at 1e-2, of 1.5 at 1e-8, where the corners
  // of the boxes are what is left. The orders 9, 12, 16, 20, 25, 31 and 38 for 1e-2, 1e-3, ... leave a margin for quadrature.
  const double beyond = std::log(1e-3 / tolerance);
  return std::clamp(static_cast<int>(std::ceil(12 + 1.41 * beyond + 0.067 * beyond * std::abs(beyond))), 3, max_order);
}

int order_at_distance(const int order, const double distance)
{
  const double ratio = std::log(2 / effective_radius) / std::log(distance / effective_radius);
  return std::clamp(static_cast<int>(std::ceil((order + 1) * ratio - 1e-9)) - 1, 2, max_order);
}

double distance_in_cubes(const Vec3 &shift, const Vec3 &edges)
{
  return shift.norm() * std::sqrt(3.0) / edges.norm();
}

double longest_line(const double tolerance)
{
  return tolerance > 5e-5 ? 0.5 : tolerance > 5e-6 ? 0.25 : 0.125;
}

double smallest_box(const double core_radius, const double tolerance)
{
  return core_radius / 2 / std::pow(tolerance, 0.25);
}

double translation_cost(const int order)
{
  return 0.23 * std::pow(order + 1, 3);
}

double half_line_translation_cost(const int source_order, const int target_order)
{
  return 5e-4 * std::pow(source_order + 1, 2) * std::pow(target_order + 1, 2);
}
} // namespace ddfem::fmm
