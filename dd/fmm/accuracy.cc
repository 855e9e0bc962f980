#include "dd/fmm/accuracy.h"

#include "dd/fmm/solid_harmonics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ddfem::fmm
{
namespace
{
/// Effective radius of the contents of two boxes together, in box sizes: the error falls like (radius/distance)^order.
constexpr double effective_radius = 1.05;
} // namespace

int expansion_order(const double tolerance)
{
  if (!(tolerance >= 1e-9 && tolerance <= 0.1))
    throw std::invalid_argument("requested error of the far field outside [1e-9, 0.1]");
  const double order = std::log(0.6 / tolerance) / std::log(2 / effective_radius);
  return std::clamp(static_cast<int>(std::ceil(order)), 3, max_order);
}

int order_at_distance(const int order, const double distance)
{
  if (distance <= 2)
    return order;
  const double ratio = std::log(2 / effective_radius) / std::log(distance / effective_radius);
  return std::max(2, static_cast<int>(std::ceil((order + 1) * ratio)) - 1);
}

double translation_cost(const int order)
{
  return 0.2 * std::pow(order + 1, 3);
}
} // namespace ddfem::fmm
