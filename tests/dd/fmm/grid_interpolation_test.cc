// Interpolation on equispaced grids: exact for polynomials, between positions and between levels.
#include "dd/fmm/grid_interpolation.h"
#include "tests/dd/elasticity/elasticity_test_helpers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace ddfem::fmm
{
namespace
{
using test::RandomVectors;

/// A polynomial of degree n-1 in each direction, of order one in the box and around it.
double polynomial(const std::size_t n, const Vec3 &y)
{
  const auto degree = static_cast<double>(n - 1);
  return std::pow(0.3 + y[0], degree) + std::pow((0.4 - y[0]) * (y[1] + 0.7) * (0.2 + y[2]), degree) + 1;
}

RowBuffer values_on(const GridInterpolation &grid)
{
  RowBuffer values(grid.n_rows());
  for (std::size_t k = 0; k < grid.n_rows(); ++k)
  {
    const std::size_t n = grid.n();
    const Vec3 y(grid.point(k / (n * n)), grid.point(k / n % n), grid.point(k % n));
    values(k, 0) = polynomial(n, y);
    values(k, 5) = 2 * y[0] - y[2];
  }
  return values;
}

TEST(GridInterpolation, ReproducesPolynomialsToRounding)
{
  RandomVectors random(1);
  for (const int n : {2, 5, 8, 16})
  {
    const GridInterpolation grid(n);
    const RowBuffer values = values_on(grid);
    // Rounding times the largest sum of the polynomials' magnitudes: about 2^n/(e n log n) per direction inside, more outside.
    const double tolerance = n < 10 ? 1e-11 : 1e-7;
    for (int k = 0; k < 50; ++k)
    {
      const Vec3 y = 0.6 * random.vector();
      Row value = {};
      grid.add_value(grid.basis(y), values.rows(), value);
      EXPECT_NEAR(value[0], polynomial(grid.n(), y), tolerance) << n;
      EXPECT_NEAR(value[5], 2 * y[0] - y[2], tolerance) << n;
    }
  }
}

TEST(GridInterpolation, MomentsActOnPolynomialsAsTheirSource)
{
  RandomVectors random(2);
  const GridInterpolation grid(7);
  const RowBuffer values = values_on(grid);
  const Vec3 y = 0.7 * random.vector();
  const Row strength = {1, -2, 3, 0, 0, 0.5, 0, 4};
  RowBuffer moments(grid.n_rows());
  grid.add_source(grid.basis(y), strength, moments.rows());
  for (std::size_t c = 0; c < row_width; ++c)
  {
    double sum = 0;
    for (std::size_t k = 0; k < grid.n_rows(); ++k)
      sum += moments(k, c) * values(k, 0);
    EXPECT_NEAR(sum, strength[c] * polynomial(grid.n(), y), 1e-11);
  }
}

TEST(GridInterpolation, MovesBetweenLevelsAreExact)
{
  // The parent's polynomials are of the same degree in the child: nothing is lost but rounding.
  RandomVectors random(3);
  const GridInterpolation grid(6);
  const RowBuffer values = values_on(grid);
  const Row strength = {1, -2, 3, 5, -4, 0.5, 7, 4};
  for (std::size_t octant = 0; octant < 8; ++octant)
  {
    const auto side = [&](int axis) { return (octant >> axis & 1) != 0 ? 0.25 : -0.25; };
    const Vec3 in_child = 0.7 * random.vector(), in_parent = Vec3(side(0), side(1), side(2)) + 0.5 * in_child;
    RowBuffer child(grid.n_rows()), moved(grid.n_rows()), direct(grid.n_rows()), values_of_child(grid.n_rows());
    grid.add_source(grid.basis(in_child), strength, child.rows());
    grid.add_to_parent(octant, child.rows(), moved.rows());
    grid.add_source(grid.basis(in_parent), strength, direct.rows());
    for (std::size_t k = 0; k < grid.n_rows(); ++k)
      for (std::size_t c = 0; c < row_width; ++c)
        EXPECT_NEAR(moved(k, c), direct(k, c), 1e-11);
    grid.add_to_child(octant, values.rows(), values_of_child.rows());
    Row a = {}, b = {};
    grid.add_value(grid.basis(in_child), values_of_child.rows(), a);
    grid.add_value(grid.basis(in_parent), values.rows(), b);
    EXPECT_NEAR(a[0], b[0], 1e-11) << octant;
  }
}

TEST(GridInterpolation, RefusesWhatItCannotDo)
{
  EXPECT_THROW(GridInterpolation(fewest_grid_points - 1), std::invalid_argument);
  EXPECT_THROW(GridInterpolation(most_grid_points + 1), std::invalid_argument);
  EXPECT_THROW(grid_points(1e-7), std::invalid_argument);
  EXPECT_THROW(grid_points(0.5), std::invalid_argument);
  for (const double tolerance : {0.1, 1e-2, 1e-4, 1e-6})
  {
    const int n = grid_points(tolerance);
    EXPECT_LE(grid_error(n), tolerance);
    EXPECT_GT(grid_error(n - 1), tolerance);
  }
}
} // namespace
} // namespace ddfem::fmm
