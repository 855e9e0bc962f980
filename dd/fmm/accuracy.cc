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
  // Measured on the networks of the tests: about 0.6 exp(-0.59 order), for orders 8 to 32.
  return std::clamp(static_cast<int>(std::ceil(-std::log(tolerance) / 0.59)), 3, max_order);
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
  return 0.1 * std::pow(order + 1, 3);
}
} // namespace ddfem::fmm
