#include "dd/fmm/stress_expansion.h"

#include "dd/elasticity/gauss.h"
#include "dd/fmm/expansion_loops.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ddfem::fmm
{
namespace
{
constexpr int n_fields = 8;

/// Eight lines side by side; missing ones have no strength.
struct LineBlock
{
  alignas(row_size) Row middle[3] = {};
  Row half[3] = {};             ///< (x' - centre)/size = middle + z half, -1 <= z <= 1
  Row strength[row_width] = {}; ///< of the eight fields, one row per line
  Row q = {};
  double longest = 0; ///< length over box size

  LineBlock(const Vec3 &centre, const double size, const std::span<const LineSource> sources)
  {
    for (std::size_t i = 0; i < sources.size(); ++i)
    {
      const LineSource &l = sources[i];
      const Vec3 d = l.end - l.start, x = 0.5 * (l.start + l.end) - centre;
      for (int c = 0; c < 3; ++c)
      {
        middle[c][i] = x[c] / size;
        half[c][i] = 0.5 * d[c] / size;
      }
      set_strength(i, d, l.burgers, x);
      longest = std::max(longest, d.norm() / size);
    }
  }

  LineBlock() = default;

  /// Of element @p d (nm) at @p x from the centre, with Burgers vector @p b.
  void set_strength(const std::size_t i, const Vec3 &d, const Vec3 &b, const Vec3 &x)
  {
    const Vec3 p = b.cross(d);
    const double third = b.dot(d) / 3;
    const auto sym = [&](int m, int k) { return 0.5 * (b[m] * d[k] + b[k] * d[m]); };
    strength[i] = Row{p[0], p[1], p[2], sym(0, 0) - third, sym(1, 1) - third, sym(0, 1), sym(0, 2), sym(1, 2)};
    q[i] = p.dot(x); // the same all along the line, since p is normal to it
  }
};

/// First derivatives of P and S that make up the stress, one harmonic: g[i] is the row of d/dx_i.
void add_first_derivatives(const double m, const double factor, const Row (&g)[3], double *const stress)
{
  const auto P = [&](int i, int c) { return g[i][static_cast<std::size_t>(c)]; };
  const auto S = [&](int i, int a, int b)
  {
    constexpr std::size_t field[6] = {3, 4, 0, 5, 6, 7};
    const std::size_t c = component[a][b];
    return c == 2 ? -(g[i][3] + g[i][4]) : g[i][field[c]];
  };
  // eps_ima d_i S_mb is the curl over the first index.
  const auto curl = [&](int a, int b)
  {
    const int i = (a + 1) % 3, j = (a + 2) % 3;
    return S(i, j, b) - S(j, i, b);
  };
  const double div = P(0, 0) + P(1, 1) + P(2, 2);
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b)
      stress[component[a][b]] +=
          factor * (curl(a, b) + curl(b, a) + (m - 0.5) * (P(a, b) + P(b, a)) + (a == b ? (1 - 2 * m) * div : 0.0));
}

} // namespace

void add_moments(const int order, const double tolerance, const Vec3 &centre, const double size,
                 const std::span<const LineSource> sources, const ExpansionView &moments)
{
  const std::size_t n = n_harmonics(order);
  RowBuffer values(n), line_moments(n);
  for (std::size_t begin = 0; begin < sources.size(); begin += row_width)
  {
    const LineBlock block(centre, size, sources.subspan(begin, std::min(row_width, sources.size() - begin)));
    line_moments.set_zero();
    const GaussRule rule = gauss_rule(n_points_along(order, tolerance, block.longest));
    for (std::size_t k = 0; k < rule.points.size(); ++k)
    {
      const double z = 2 * rule.points[k] - 1;
      Row points[3];
      for (int c = 0; c < 3; ++c)
        points[c] = block.middle[c] + z * block.half[c];
      regular_harmonics(order, points, values.rows());
      add_weighted(n, rule.weights[k], values.rows(), line_moments.rows());
    }
    add_outer_products(n, line_moments.rows(), block.strength, &block.q, moments.fields, moments.q);
  }
}

void add_local_of_rays(const int order, const Vec3 &centre, const double size, const std::span<const RaySource> rays,
                       const ExpansionView &local)
{
  // Irregular harmonics by inversion, C_lm/r^(l+1) = S_lm(x/r^2)/r, and the ray t = h z/(1-z), 0 < z < 1, with h the distance
  // of its origin: for l > 0 the integrand is smooth up to the end.
  const std::size_t n = n_harmonics(order);
  const GaussRule rule = gauss_rule(std::min(order + 8, max_gauss_points));
  RowBuffer values(n), ray_moments(n);
  for (std::size_t begin = 0; begin < rays.size(); begin += row_width)
  {
    const auto some = rays.subspan(begin, std::min(row_width, rays.size() - begin));
    LineBlock block;
    for (std::size_t i = 0; i < some.size(); ++i)
      block.set_strength(i, size * some[i].direction, some[i].burgers, some[i].origin - centre);
    ray_moments.set_zero();
    for (std::size_t k = 0; k < rule.points.size(); ++k)
    {
      const double z = rule.points[k];
      alignas(row_size) Row points[3] = {};
      Row weight = {};
      for (std::size_t i = 0; i < some.size(); ++i)
      {
        const Vec3 origin = (some[i].origin - centre) / size;
        const double h = origin.norm();
        const Vec3 x = origin + h * z / (1 - z) * some[i].direction;
        for (int c = 0; c < 3; ++c)
          points[c][i] = x[c] / x.squaredNorm();
        weight[i] = rule.weights[k] * h / ((1 - z) * (1 - z)) / x.norm();
      }
      regular_harmonics(order, points, values.rows());
      for (std::size_t j = 1; j < n; ++j)
        ray_moments.rows()[j] += weight * values.rows()[j];
    }
    add_outer_products(n, ray_moments.rows(), block.strength, &block.q, local.fields, local.q);
  }
}

LocalStress::LocalStress(const IsotropicMedium &medium, const int order, const Vec3 &centre_, const double size_,
                         const Row *fields, const double *q)
    : LocalExpansion(std::max(order - 1, 0), centre_, size_)
{
  const auto &axis = known_gradient_terms(order);
  const std::size_t n = n_harmonics(order);
  RowBuffer potentials(n), first[3];
  std::copy(fields, fields + n, potentials.rows());
  for (std::size_t i = 0; i < 3; ++i)
    first[i] = derivative(axis[i], potentials);
  // Fields 0 to 2 are P, and field 3 becomes Q with the dipole of the core.
  const double core = 0.5 * medium.a * medium.a / size;
  for (std::size_t k = 0; k < n; ++k)
    potentials(k, 3) = q[k] - core * (first[0](k, 0) + first[1](k, 1) + first[2](k, 2));

  const double m = 1 / (1 - medium.nu), scale = medium.mu / (4 * std::numbers::pi * size * size);
  for (std::size_t k = 0; k < n_harmonics(degree); ++k)
  {
    const Row g[3] = {first[0].rows()[k], first[1].rows()[k], first[2].rows()[k]};
    add_first_derivatives(m, scale, g, &coefficients(3 * k, 0));
  }
  for (std::size_t a = 0; a < 3; ++a)
  {
    const RowBuffer slope = derivative(axis[a], potentials);
    for (std::size_t b = a; b < 3; ++b)
    {
      const RowBuffer second = derivative(axis[b], slope);
      const std::size_t c = component[a][b];
      for (std::size_t k = 0; k < n_harmonics(degree); ++k)
      {
        coefficients(3 * k, c) -= m * scale / size * second(k, 3);
        for (std::size_t i = 0; i < 3; ++i)
          coefficients(3 * k, 6 + 6 * i + c) = m * scale * second(k, i);
      }
    }
  }
}
} // namespace ddfem::fmm
