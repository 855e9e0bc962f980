#include "dd/fmm/displacement_expansion.h"

#include "dd/elasticity/gauss.h"
#include "dd/fmm/expansion_loops.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace ddfem::fmm
{
namespace
{
/// A triangle as points start + s (a + t (b - a)), 0 <= s, t <= 1, with the shortest edge from a to b: thin triangles need few t.
struct CollapsedTriangle
{
  Vec3 start, a, b; ///< relative to the centre of the box, over its size
  double longest, width;

  CollapsedTriangle(const TriangularLoop &loop, const Vec3 &centre, const double size)
  {
    std::array<Vec3, 3> v;
    for (std::size_t i = 0; i < 3; ++i)
      v[i] = (loop.vertices[i].value - centre) / size;
    std::array<double, 3> opposite;
    for (std::size_t i = 0; i < 3; ++i)
      opposite[i] = (v[(i + 2) % 3] - v[(i + 1) % 3]).norm();
    const auto first = static_cast<std::size_t>(std::min_element(opposite.begin(), opposite.end()) - opposite.begin());
    start = v[first];
    a = v[(first + 1) % 3] - start;
    b = v[(first + 2) % 3] - start;
    longest = std::max(a.norm(), b.norm());
    width = opposite[first];
  }
};

/// Dipole strengths of eight loops at one point of each: S, and y'_i S_ij.
struct StrengthBlock
{
  Row fields[row_width] = {}; ///< xx yy zz xy xz yz of S, then x and y of the other; a row per loop
  Row last = {};              ///< z of it
};

/// Sums moments of dipole strengths over the loops of a box.
class DipoleSum
{
public:
  DipoleSum(const int order_) : order(order_), n(n_harmonics(order_)), values(n), moments(n), moments_last(n, 0.0) {}

  /// @p points: eight, over the box size.
  void add(const Row *points, const StrengthBlock &strength)
  {
    regular_harmonics(order, points, values.rows());
    add_outer_products(n, values.rows(), strength.fields, &strength.last, moments.rows(), moments_last.data());
  }

  /// Turns dipoles into moments of charges: S_k about the centre of a dipole is the derivative of S_k.
  void add_to(const double nu, const double size, const ExpansionView &target) const
  {
    for (std::size_t j = 0; j < 3; ++j)
      for (const GradientTerm &t : known_gradient_terms(order)[j])
      {
        const double factor = t.factor / size;
        const Row &m = moments.rows()[t.to];
        for (std::size_t i = 0; i < 3; ++i)
          target.fields[t.from][i] += factor * m[component[i][j]];
        target.q[t.from] += factor * size * (j < 2 ? m[6 + j] : moments_last[t.to]);
      }
    for (std::size_t k = 0; k < n; ++k)
    {
      const Row &m = moments.rows()[k];
      target.q[k] += (1 - 2 * nu) * (m[0] + m[1] + m[2]);
    }
  }

private:
  int order;
  std::size_t n;
  RowBuffer values, moments;
  std::vector<double> moments_last;
};

/// Strength of loop number @p i at y' (over the box size), with part @p weight of its area.
void set_strength(StrengthBlock &block, const std::size_t i, const TriangularLoop &loop, const double weight,
                  const Vec3 &y)
{
  const Vec3 area =
      0.5 * weight *
      (loop.vertices[1].value - loop.vertices[0].value).cross(loop.vertices[2].value - loop.vertices[0].value);
  const Mat3 product = loop.burgers * area.transpose(), s = 0.5 * (product + product.transpose());
  const Vec3 moved = s * y;
  block.fields[i] = Row{s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(0, 2), s(1, 2), moved[0], moved[1]};
  block.last[i] = moved[2];
}
} // namespace

void add_moments(const int order, const double tolerance, const double nu, const Vec3 &centre, const double size,
                 const std::span<const TriangularLoop> loops, const ExpansionView &moments)
{
  DipoleSum sum(order);
  for (std::size_t begin = 0; begin < loops.size(); begin += row_width)
  {
    const auto some = loops.subspan(begin, std::min(row_width, loops.size() - begin));
    std::vector<CollapsedTriangle> triangles;
    double longest = 0, widest = 0;
    for (const TriangularLoop &l : some)
    {
      triangles.emplace_back(l, centre, size);
      longest = std::max(longest, triangles.back().longest);
      widest = std::max(widest, triangles.back().width);
    }
    // The element of area grows along s, which takes half a point.
    const GaussRule along = gauss_rule(std::min(n_points_along(order, tolerance, longest) + 1, max_gauss_points));
    const GaussRule across = gauss_rule(n_points_along(order, tolerance, widest));
    for (std::size_t p = 0; p < along.points.size(); ++p)
      for (std::size_t q = 0; q < across.points.size(); ++q)
      {
        const double s = along.points[p], t = across.points[q];
        Row points[3] = {};
        StrengthBlock strength;
        for (std::size_t i = 0; i < some.size(); ++i)
        {
          const CollapsedTriangle &triangle = triangles[i];
          const Vec3 y = triangle.start + s * (triangle.a + t * (triangle.b - triangle.a));
          for (std::size_t c = 0; c < 3; ++c)
            points[c][i] = y[static_cast<int>(c)];
          set_strength(strength, i, some[i], 2 * s * along.weights[p] * across.weights[q], y);
        }
        sum.add(points, strength);
      }
  }
  sum.add_to(nu, size, moments);
}

namespace
{
/// P and Q in columns 0 to 3.
RowBuffer beside_each_other(const std::size_t n, const Row *fields, const double *q)
{
  RowBuffer potentials(n);
  std::copy(fields, fields + n, potentials.rows());
  for (std::size_t k = 0; k < n; ++k)
    potentials(k, 3) = q[k];
  return potentials;
}
} // namespace

LocalDisplacement::LocalDisplacement(const double nu, const int order, const Vec3 &centre_, const double size_,
                                     const Row *fields, const double *q)
    : LocalExpansion(order, centre_, size_)
{
  const std::size_t n = n_harmonics(order);
  const RowBuffer potentials = beside_each_other(n, fields, q);
  const double scale = -1 / (8 * std::numbers::pi * (1 - nu) * size);
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t m = 0; m < 3; ++m)
      coefficients(3 * k, m) = scale * (3 - 4 * nu) * potentials(k, m);
  for (std::size_t m = 0; m < 3; ++m)
  {
    const RowBuffer slope = derivative(known_gradient_terms(order)[m], potentials);
    for (std::size_t k = 0; k < n; ++k)
    {
      coefficients(3 * k, m) += scale / size * slope(k, 3);
      for (std::size_t i = 0; i < 3; ++i)
        coefficients(3 * k, 6 + 6 * i + m) = -scale * slope(k, i);
    }
  }
}

// From u to the stress: -8 pi (1-nu)/mu sigma_ab = 4 nu delta_ab div P + (2-4nu) (d_a P_b + d_b P_a) - 2 y_i d_a d_b P_i + 2 d_a d_b Q.
LocalDisplacementStress::LocalDisplacementStress(const IsotropicMedium &medium, const int order, const Vec3 &centre_,
                                                 const double size_, const Row *fields, const double *q)
    : LocalExpansion(std::max(order - 1, 0), centre_, size_)
{
  const auto &axis = known_gradient_terms(order);
  const std::size_t n = n_harmonics(order), n_stress = n_harmonics(degree);
  const RowBuffer potentials = beside_each_other(n, fields, q);
  RowBuffer first[3];
  for (std::size_t a = 0; a < 3; ++a)
    first[a] = derivative(axis[a], potentials);
  const double nu = medium.nu, scale = -medium.mu / (8 * std::numbers::pi * (1 - nu) * size * size);
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = a; b < 3; ++b)
    {
      const RowBuffer second = derivative(axis[b], first[a]);
      const std::size_t c = component[a][b];
      for (std::size_t k = 0; k < n_stress; ++k)
      {
        const double div = first[0](k, 0) + first[1](k, 1) + first[2](k, 2);
        coefficients(3 * k, c) = scale * ((2 - 4 * nu) * (first[a](k, b) + first[b](k, a)) +
                                          (a == b ? 4 * nu * div : 0.0) + 2 / size * second(k, 3));
        for (std::size_t i = 0; i < 3; ++i)
          coefficients(3 * k, 6 + 6 * i + c) = -2 * scale * second(k, i);
      }
    }
}
} // namespace ddfem::fmm
