#include "dd/fmm/grid_interpolation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace ddfem::fmm
{
namespace
{
/// out[i][r] = sum_j matrix[i][j] in[r][j] for @p n_rest r: the last direction becomes the first, so that three calls treat
/// all and restore the order.
DDFEM_FMM_EVERY_PROCESSOR
void multiply_last(const std::size_t n, const std::size_t n_rest, const double *matrix, const Row *in, Row *out)
{
  for (std::size_t r = 0; r < n_rest; ++r)
    for (std::size_t i = 0; i < n; ++i)
    {
      Row sum = {};
      for (std::size_t j = 0; j < n; ++j)
        sum += matrix[i * n + j] * in[r * n + j];
      out[i * n_rest + r] = sum;
    }
}

DDFEM_FMM_EVERY_PROCESSOR
void add_rows(const std::size_t n, const Row *in, Row *out)
{
  for (std::size_t k = 0; k < n; ++k)
    out[k] += in[k];
}

DDFEM_FMM_EVERY_PROCESSOR
void spread(const std::size_t n, const GridBasis &basis, const Row &strength, Row *moments)
{
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
    {
      const Row s = basis.of[0][i] * basis.of[1][j] * strength;
      for (std::size_t k = 0; k < n; ++k)
        moments[(i * n + j) * n + k] += basis.of[2][k] * s;
    }
}

DDFEM_FMM_EVERY_PROCESSOR
void interpolate(const std::size_t n, const GridBasis &basis, const Row *values, Row &value)
{
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
    {
      Row sum = {};
      for (std::size_t k = 0; k < n; ++k)
        sum += basis.of[2][k] * values[(i * n + j) * n + k];
      value += basis.of[0][i] * basis.of[1][j] * sum;
    }
}
/// Width of the grid in box edges. Lines stick out of their box by up to a quarter of it: extrapolation beyond a grid of the width of the
/// box loses less than a wider spacing does up to n = 7, and more from there on (docs/decisions.md, 57).
double grid_width(const int n)
{
  return n < 8 ? 1.0 : 1.2;
}
} // namespace

double grid_error(const int n)
{
  return 3e-2 * std::pow(3.2, 4 - n);
}

int grid_points(const double tolerance)
{
  if (!(tolerance >= 1e-6 && tolerance <= 0.1))
    throw std::invalid_argument("requested error of the far field by grids outside [1e-6, 0.1]");
  int n = fewest_grid_points;
  while (n < most_grid_points && grid_error(n) > tolerance)
    ++n;
  return n;
}

GridInterpolation::GridInterpolation(const int n)
    : n_points(static_cast<std::size_t>(std::max(n, 0))), width(grid_width(n))
{
  if (n < fewest_grid_points || n > most_grid_points)
    throw std::invalid_argument("grids have from " + std::to_string(fewest_grid_points) + " to " +
                                std::to_string(most_grid_points) + " points per direction, not " + std::to_string(n));
  for (int i = 0; i < n; ++i)
  {
    double product = 1;
    for (int j = 0; j < n; ++j)
      product *= j == i ? 1 : i - j;
    scale.push_back(1 / product);
  }
  for (std::size_t half = 0; half < 2; ++half)
  {
    to_parent[half].resize(n_points * n_points);
    to_child[half].resize(n_points * n_points);
    for (std::size_t j = 0; j < n_points; ++j)
    {
      double *const values = to_child[half].data() + j * n_points;
      basis_along(0.5 * point(j) + (half == 0 ? -0.25 : 0.25), values);
      for (std::size_t i = 0; i < n_points; ++i)
        to_parent[half][i * n_points + j] = values[i];
    }
  }
}

double GridInterpolation::point(const std::size_t k) const
{
  return width * (static_cast<double>(k) / (static_cast<double>(n_points) - 1) - 0.5);
}

void GridInterpolation::basis_along(const double y, double *const values) const
{
  // Products of the distances to the points below and above, in spacings: no division, exact at the points.
  const double t = (y / width + 0.5) * (static_cast<double>(n_points) - 1);
  double below = 1;
  for (std::size_t i = 0; i < n_points; ++i)
  {
    values[i] = scale[i] * below;
    below *= t - static_cast<double>(i);
  }
  double above = 1;
  for (std::size_t i = n_points; i-- > 0;)
  {
    values[i] *= above;
    above *= t - static_cast<double>(i);
  }
}

GridBasis GridInterpolation::basis(const Vec3 &y) const
{
  GridBasis b;
  for (int c = 0; c < 3; ++c)
    basis_along(y[c], b.of[c]);
  return b;
}

void GridInterpolation::add_source(const GridBasis &basis, const Row &strength, Row *const moments) const
{
  spread(n_points, basis, strength, moments);
}

void GridInterpolation::add_value(const GridBasis &basis, const Row *const values, Row &value) const
{
  interpolate(n_points, basis, values, value);
}

void GridInterpolation::move(const std::size_t octant, const std::array<std::vector<double>, 2> &matrices,
                             const Row *const from, Row *const to) const
{
  const std::size_t n_rest = n_points * n_points;
  RowBuffer a(n_rows()), b(n_rows());
  multiply_last(n_points, n_rest, matrices[octant >> 2 & 1].data(), from, a.rows());
  multiply_last(n_points, n_rest, matrices[octant >> 1 & 1].data(), a.rows(), b.rows());
  multiply_last(n_points, n_rest, matrices[octant & 1].data(), b.rows(), a.rows());
  add_rows(n_rows(), a.rows(), to);
}

void GridInterpolation::add_to_parent(const std::size_t octant, const Row *const child, Row *const parent) const
{
  move(octant, to_parent, child, parent);
}

void GridInterpolation::add_to_child(const std::size_t octant, const Row *const parent, Row *const child) const
{
  move(octant, to_child, parent, child);
}
} // namespace ddfem::fmm
