#include "dd/fmm/solid_harmonics.h"

#include "dd/elasticity/gauss.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ddfem::fmm
{
namespace
{
/// Factors of the recurrences, for all degrees up to max_order.
template <class Scalar> struct Recurrence
{
  std::array<Scalar, max_order + 1> diagonal{};                 ///< S_mm from S_m-1,m-1
  std::array<Scalar, n_harmonics(max_order)> first{}, second{}; ///< S_l from S_l-1 and S_l-2

  Recurrence()
  {
    for (int m = 1; m <= max_order; ++m)
      diagonal[static_cast<std::size_t>(m)] =
          static_cast<Scalar>(m == 1 ? 1.0 : std::sqrt((2.0 * m - 1.0) / (2.0 * m)));
    for (int l = 1; l <= max_order; ++l)
      for (int m = 0; m < l; ++m)
      {
        const double root = std::sqrt(static_cast<double>(l * l - m * m));
        first[harmonic_index(l, m)] = static_cast<Scalar>((2.0 * l - 1.0) / root);
        second[harmonic_index(l, m)] =
            static_cast<Scalar>(std::sqrt(static_cast<double>((l - 1) * (l - 1) - m * m)) / root);
      }
  }
};

/// All degrees for one m (and -m), upwards from l = m.
template <class Rows>
DDFEM_FMM_INLINE void raise_degree(const Recurrence<typename Rows::Scalar> &factor, int order, int m, int sign,
                                   const typename Rows::Row &z, const typename Rows::Row &r2, typename Rows::Row *s)
{
  for (int l = m + 1; l <= order; ++l)
  {
    const std::size_t k = harmonic_index(l, m);
    typename Rows::Row value = factor.first[k] * z * s[harmonic_index(l - 1, sign * m)];
    if (l > m + 1)
      value -= factor.second[k] * r2 * s[harmonic_index(l - 2, sign * m)];
    s[harmonic_index(l, sign * m)] = value;
  }
}

template <class Rows>
DDFEM_FMM_INLINE void evaluate_rows(const Recurrence<typename Rows::Scalar> &factor, int order,
                                    const typename Rows::Row *points, typename Rows::Row *s)
{
  using Row = typename Rows::Row;
  const Row x = points[0], y = points[1], z = points[2];
  const Row r2 = x * x + y * y + z * z;
  s[0] = Row{} + typename Rows::Scalar{1};
  raise_degree<Rows>(factor, order, 0, 1, z, r2, s);
  for (int m = 1; m <= order; ++m)
  {
    const typename Rows::Scalar f = factor.diagonal[static_cast<std::size_t>(m)];
    const Row c = s[harmonic_index(m - 1, m - 1)];
    const Row d = m == 1 ? Row{} : s[harmonic_index(m - 1, 1 - m)];
    s[harmonic_index(m, m)] = f * (x * c - y * d);
    s[harmonic_index(m, -m)] = f * (x * d + y * c);
    raise_degree<Rows>(factor, order, m, 1, z, r2, s);
    raise_degree<Rows>(factor, order, m, -1, z, r2, s);
  }
}

DDFEM_FMM_EVERY_PROCESSOR
void evaluate(const Recurrence<double> &factor, int order, const Row *points, Row *s)
{
  evaluate_rows<DoubleRows>(factor, order, points, s);
}

DDFEM_FMM_EVERY_PROCESSOR
void evaluate(const Recurrence<float> &factor, int order, const WideSingleRows::Row *points, WideSingleRows::Row *s)
{
  evaluate_rows<WideSingleRows>(factor, order, points, s);
}

/// Adds weight a_i b_j to the two blocks of degree @p l; returns the end of the blocks.
double *add_products(const int l, const double weight, const double *a, const double *b, double *entry)
{
  for (const int sign : {1, -1})
    for (int row = (1 - sign) / 2; row <= l; ++row)
    {
      const double factor = weight * a[harmonic_index(l, sign * row)];
      for (int column = (1 - sign) / 2; column <= l; ++column)
        *entry++ += factor * b[harmonic_index(l, sign * column)];
    }
  return entry;
}
} // namespace

void regular_harmonics(const int order, const Row *points, Row *values)
{
  static const Recurrence<double> factor;
  evaluate(factor, order, points, values);
}

void regular_harmonics(const int order, const WideSingleRows::Row *points, WideSingleRows::Row *values)
{
  static const Recurrence<float> factor;
  evaluate(factor, order, points, values);
}

std::array<std::vector<GradientTerm>, 3> gradient_terms(const int order)
{
  std::array<std::vector<GradientTerm>, 3> terms;
  const auto add = [&](const std::size_t axis, int l, int m, int m_to, double factor)
  {
    if (std::abs(m_to) < l && factor != 0.0)
      terms[axis].push_back({static_cast<std::uint16_t>(harmonic_index(l, m)),
                             static_cast<std::uint16_t>(harmonic_index(l - 1, m_to)), factor});
  };
  for (int l = 1; l <= order; ++l)
  {
    const double to_one = std::sqrt(0.5 * l * (l - 1));
    add(0, l, 0, 1, -to_one);
    add(1, l, 0, -1, -to_one);
    add(2, l, 0, 0, l);
    for (int m = 1; m <= l; ++m)
    {
      // d/dx (cos, sin)_m = (cos, sin)_m-1 down - (cos, sin)_m+1 up; d/dy mixes the two.
      const double down = std::sqrt((m == 1 ? 2.0 : 1.0) * (l + m) * (l + m - 1)) / 2;
      const double up = std::sqrt(static_cast<double>((l - m) * (l - m - 1))) / 2;
      const double along_z = std::sqrt(static_cast<double>(l * l - m * m));
      add(0, l, m, m - 1, down);
      add(0, l, m, m + 1, -up);
      add(0, l, -m, -(m + 1), -up);
      add(1, l, m, -(m + 1), -up);
      add(1, l, -m, m - 1, down);
      add(1, l, -m, m + 1, up);
      if (m > 1) // there is no sine with m = 0
      {
        add(0, l, -m, -(m - 1), down);
        add(1, l, m, -(m - 1), -down);
      }
      add(2, l, m, m, along_z);
      add(2, l, -m, -m, along_z);
    }
  }
  return terms;
}

std::vector<double> rotation_about_y(const int order, const double cos_theta, const double sin_theta)
{
  // D_ij = (2l+1)/(4 pi) int C_i(R u) C_j(u) du over the sphere, by a product rule that is exact to rounding for polynomials
  // of degree 2 order: simple, and stable at any order. Two Gauss rules, of -1 < z < 0 and 0 < z < 1, reach orders that one
  // of max_gauss_points does not.
  std::size_t size = 0;
  for (int l = 0; l <= order; ++l)
    size += static_cast<std::size_t>((l + 1) * (l + 1) + l * l);
  std::vector<double> blocks(size, 0.0);
  // The integrand is even in y: half the circle.
  const GaussRule rule = gauss_rule(std::min(order + 1, max_gauss_points));
  const int n_phi = 2 * order + 1;
  const std::size_t n = n_harmonics(order);
  RowBuffer harmonics(n);
  std::vector<double> at_u(n), at_image(n);
  for (std::size_t k = 0; k < 2 * rule.points.size(); ++k)
    for (int j = 0; j <= order; ++j)
    {
      const double z = (k % 2 == 0 ? 1 : -1) * rule.points[k / 2], rho = std::sqrt(1 - z * z);
      const double phi = 2 * std::numbers::pi * j / n_phi, x = rho * std::cos(phi), y = rho * std::sin(phi);
      // Lane 0 holds u, lane 1 holds R u.
      const Row points[3] = {Row{x, cos_theta * x - sin_theta * z}, Row{y, y}, Row{z, sin_theta * x + cos_theta * z}};
      regular_harmonics(order, points, harmonics.rows());
      for (std::size_t h = 0; h < n; ++h)
      {
        at_u[h] = harmonics(h, 0);
        at_image[h] = harmonics(h, 1);
      }
      const double weight = (j == 0 ? 0.5 : 1.0) * rule.weights[k / 2] / n_phi;
      double *entry = blocks.data();
      for (int l = 0; l <= order; ++l)
        entry = add_products(l, (2 * l + 1) * weight, at_image.data(), at_u.data(), entry);
    }
  return blocks;
}
} // namespace ddfem::fmm
