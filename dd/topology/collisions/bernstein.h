// Polynomials of one variable in the Bernstein basis of an interval, and where they fall through zero.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace ddfem
{
constexpr double binomial(const std::size_t n, const std::size_t k)
{
  double b = 1;
  for (std::size_t i = 0; i < k; ++i)
    b = b * static_cast<double>(n - i) / static_cast<double>(i + 1);
  return b;
}

/// weight[i][j] = C(m, i) C(n, j) / C(m + n, i + j), by the numbers of coefficients m + 1 and n + 1.
template <std::size_t size_p, std::size_t size_q>
constexpr auto bernstein_weights = []
{
  std::array<std::array<double, size_q>, size_p> weights{};
  for (std::size_t i = 0; i < size_p; ++i)
    for (std::size_t j = 0; j < size_q; ++j)
      weights[i][j] = binomial(size_p - 1, i) * binomial(size_q - 1, j) / binomial(size_p + size_q - 2, i + j);
  return weights;
}();

/// Coefficients of the product of two polynomials, each given by its Bernstein coefficients (degree + 1 of them)
/// on the same interval. @p multiply forms the product of two coefficients: of numbers, or a dot or cross product of
/// vectors. (Farin, Curves and Surfaces for CAGD, ch. 6: c_k = sum_{i+j=k} C(m,i) C(n,j) / C(m+n,k) p_i q_j.)
template <class A, std::size_t size_p, class B, std::size_t size_q, class Multiply>
auto bernstein_product(const std::array<A, size_p> &p, const std::array<B, size_q> &q, const Multiply &multiply)
{
  constexpr auto &weights = bernstein_weights<size_p, size_q>;
  std::array<decltype(multiply(p[0], q[0])), size_p + size_q - 1> product;
  for (std::size_t j = 0; j < size_q; ++j)
    product[j] = weights[0][j] * multiply(p[0], q[j]);
  for (std::size_t i = 1; i < size_p; ++i)
  {
    for (std::size_t j = 0; j + 1 < size_q; ++j)
      product[i + j] += weights[i][j] * multiply(p[i], q[j]);
    product[i + size_q - 1] = weights[i][size_q - 1] * multiply(p[i], q[size_q - 1]);
  }
  return product;
}

/// Number of changes of sign in a sequence, zero counting as negative. For Bernstein coefficients it bounds the
/// number of roots inside the interval and differs from it by an even number (Descartes): none for 0, one for 1.
template <std::size_t n> unsigned sign_variations(const std::array<double, n> &coefficients)
{
  unsigned variations = 0;
  for (std::size_t i = 1; i < n; ++i)
    variations += (coefficients[i] > 0) != (coefficients[i - 1] > 0) ? 1U : 0U;
  return variations;
}

/// Where @p f falls through zero, for f(a) > 0 >= f(b), a < b: a point x with f(x) <= 0 no more than @p tolerance
/// behind one where f > 0. Interpolation with the worst case of bisection (ITP: Oliveira and Takahashi, ACM Trans.
/// Math. Softw. 47, 5, 2020).
template <class Function> double falling_root(const Function &f, double a, double b, const double tolerance)
{
  double fa = f(a), fb = f(b);
  const double half = 0.5 * tolerance, k1 = 0.2 / (b - a);
  double reach = half * std::exp2(std::max(0.0, std::ceil(std::log2((b - a) / tolerance))) + 1);
  while (b - a > tolerance)
  {
    const double middle = 0.5 * (a + b), radius = reach - 0.5 * (b - a);
    const double secant = std::clamp((fb * a - fa * b) / (fb - fa), a, b);
    const double side = middle >= secant ? 1.0 : -1.0, shift = k1 * (b - a) * (b - a);
    const double truncated = shift <= std::abs(middle - secant) ? secant + side * shift : middle;
    double x = std::abs(truncated - middle) <= radius ? truncated : middle - side * radius;
    if (x <= a || x >= b)
      x = middle; // the interpolation hits the end to rounding
    if (x <= a || x >= b)
      break;
    const double fx = f(x);
    (fx > 0 ? a : b) = x;
    (fx > 0 ? fa : fb) = fx;
    reach *= 0.5;
  }
  return b;
}

/// Visits the points in [a, b] where a polynomial falls from above to zero, in increasing order, until @p accept
/// returns true, and returns whether it did. Intervals are halved until their coefficients have at most one change of
/// sign; those shorter than @p resolution that still have more are visited once (a minimum that touches zero, say).
///
/// @p polynomial has coefficients(a, b), its Bernstein coefficients on any interval, formed afresh from what it is
/// made of so that they are as accurate as the interval is small; value(t); and covered(a, b), whether the interval
/// need not be looked at. Roots are found to @p tolerance.
template <class Polynomial, class Accept>
bool visit_falling_roots(const Polynomial &polynomial, const double a, const double b, const double resolution,
                         const double tolerance, const Accept &accept)
{
  const auto coefficients = polynomial.coefficients(a, b);
  const unsigned variations = sign_variations(coefficients);
  if (variations == 0 || polynomial.covered(a, b))
    return false;
  if (variations == 1)
    return coefficients.front() > 0 &&
           accept(falling_root([&](const double t) { return polynomial.value(t); }, a, b, tolerance));
  const double middle = 0.5 * (a + b);
  if (b - a < resolution || middle <= a || middle >= b)
    return accept(middle);
  return visit_falling_roots(polynomial, a, middle, resolution, tolerance, accept) ||
         visit_falling_roots(polynomial, middle, b, resolution, tolerance, accept);
}

/// The first local minimum of @p f at or after @p a, to @p tolerance; @p b if f falls all the way to b. The search
/// walks in steps of @p step until f no longer falls, and then by golden section; of equal values the first counts.
/// Minima within one step of which there is a deeper one may be passed over.
template <class Function>
double first_local_minimum(const Function &f, const double a, const double b, const double step, const double tolerance)
{
  // Always left <= middle <= right, and f(middle) is the smallest of the three.
  double left = a, middle = a, right = std::min(a + step, b), f_middle = f(a);
  for (double f_right = f(right); f_right < f_middle && right > middle; f_right = f(right))
  {
    left = middle;
    middle = right;
    f_middle = f_right;
    right = std::min(right + step, b);
  }
  constexpr double golden = 0.3819660112501051;
  while (right - left > tolerance)
  {
    const bool before = middle - left > right - middle;
    const double x = middle + golden * ((before ? left : right) - middle), fx = f(x);
    if (fx < f_middle || (before && fx == f_middle))
    {
      (before ? right : left) = middle;
      middle = x;
      f_middle = fx;
    }
    else
    {
      (before ? left : right) = x;
    }
  }
  return middle;
}
} // namespace ddfem
