#include "dd/elasticity/gauss.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>

namespace ddfem
{
namespace
{
struct GaussTables
{
  std::array<std::array<double, max_gauss_points>, max_gauss_points + 1> points{};
  std::array<std::array<double, max_gauss_points>, max_gauss_points + 1> weights{};

  GaussTables();
};

/// Value and derivative of the Legendre polynomial P_n at z in (-1, 1), by the three-term recurrence.
struct Legendre
{
  long double value, derivative;

  Legendre(int n, long double z)
  {
    long double previous = 1.0L, current = z;
    for (int k = 2; k <= n; ++k)
    {
      const long double next = ((2 * k - 1) * z * current - (k - 1) * previous) / k;
      previous = current;
      current = next;
    }
    value = current;
    derivative = n * (z * current - previous) / (z * z - 1.0L);
  }
};

GaussTables::GaussTables()
{
  for (int n = 1; n <= max_gauss_points; ++n)
    for (int i = 0; i < n; ++i)
    {
      // Newton's iteration from the usual asymptotic guess; six steps are more than quadratic convergence needs.
      long double z = -std::cos(std::numbers::pi_v<long double> * (i + 0.75L) / (n + 0.5L));
      for (int step = 0; step < 6; ++step)
      {
        const Legendre p(n, z);
        z -= p.value / p.derivative;
      }
      const Legendre p(n, z);
      const auto row = static_cast<std::size_t>(n), column = static_cast<std::size_t>(i);
      points[row][column] = static_cast<double>(0.5L * (1.0L + z));
      weights[row][column] = static_cast<double>(1.0L / ((1.0L - z * z) * p.derivative * p.derivative));
    }
}
} // namespace

GaussRule gauss_rule(int n_points)
{
  static const GaussTables tables;
  if (n_points < 1 || n_points > max_gauss_points)
    throw std::out_of_range("gauss_rule: number of points outside [1, max_gauss_points]");
  const auto n = static_cast<std::size_t>(n_points);
  return {std::span(tables.points[n]).first(n), std::span(tables.weights[n]).first(n)};
}
} // namespace ddfem
