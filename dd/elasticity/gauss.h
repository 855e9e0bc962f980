// Gauss-Legendre rules on the unit interval.
#pragma once

#include <span>

namespace ddfem
{
/// Points and weights (both dimensionless, weights sum to one) of a Gauss-Legendre rule on [0, 1], points ascending.
struct GaussRule
{
  std::span<const double> points;
  std::span<const double> weights;
};

/// Largest number of points gauss_rule() knows.
inline constexpr int max_gauss_points = 32;

/// The rule with @p n_points points, 1 <= n_points <= max_gauss_points; exact for polynomials of degree
/// 2 n_points - 1. The tables are computed once, on first use; safe to call from any thread.
GaussRule gauss_rule(int n_points);
} // namespace ddfem
