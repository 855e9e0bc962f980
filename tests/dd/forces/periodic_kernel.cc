// The periodic R function behind the far images.
#include "dd/forces/periodic_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

namespace ddfem
{
namespace
{
constexpr double pi = std::numbers::pi;
const Vec3 cell(90.0, 100.0, 120.0);

std::vector<Vec3> random_differences(std::size_t n)
{
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> coordinate(-1.2, 1.2);
  std::vector<Vec3> points(n);
  for (Vec3 &x : points)
    for (int c = 0; c < 3; ++c)
      x[c] = coordinate(generator) * cell[c];
  return points;
}

// Components in the order of ThirdDerivatives.
template <typename Function> ThirdDerivatives third_derivatives(const Function &component)
{
  ThirdDerivatives d{};
  std::size_t c = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      for (int k = j; k < 3; ++k)
        d[c++] = component(i, j, k);
  return d;
}

// d_i d_j d_k |r|.
ThirdDerivatives of_distance(const Vec3 &r)
{
  const double d = r.norm();
  const Vec3 e = r / d;
  return third_derivatives(
      [&](int i, int j, int k)
      { return (3 * e[i] * e[j] * e[k] - (i == j) * e[k] - (i == k) * e[j] - (j == k) * e[i]) / (d * d); });
}

// Fourier sum of R_per convolved with a Gaussian of variance width^2. Away from the lattice points this adds
// (width^2 / 2) lap R exactly.
ThirdDerivatives blurred_fourier_sum(const Vec3 &x, double width)
{
  ThirdDerivatives sum{};
  const double largest = 8.5 / width;
  const Vec3 limit = largest / (2 * pi) * cell;
  for (int nx = -int(limit[0]); nx <= int(limit[0]); ++nx)
    for (int ny = -int(limit[1]); ny <= int(limit[1]); ++ny)
      for (int nz = -int(limit[2]); nz <= int(limit[2]); ++nz)
      {
        const Vec3 k = 2 * pi * Vec3(nx, ny, nz).cwiseQuotient(cell);
        const double k2 = k.squaredNorm();
        if ((nx == 0 && ny == 0 && nz == 0) || k2 > largest * largest)
          continue;
        const double w = -8 * pi / (k2 * k2 * cell.prod()) * std::exp(-0.5 * k2 * width * width) * std::sin(k.dot(x));
        const ThirdDerivatives d = third_derivatives([&](int i, int j, int l) { return w * k[i] * k[j] * k[l]; });
        std::transform(sum.begin(), sum.end(), d.begin(), sum.begin(), std::plus<>());
      }
  return sum;
}

TEST(PeriodicKernel, DoesNotDependOnTheSplitting)
{
  const PeriodicKernel kernel(cell);
  for (const double alpha : {0.008, 0.013, 0.03})
  {
    const PeriodicKernel other(cell, alpha);
    for (const Vec3 &x : random_differences(50))
    {
      const ThirdDerivatives a = kernel(x), b = other(x);
      for (std::size_t c = 0; c < 10; ++c)
        EXPECT_NEAR(a[c], b[c], 1e-12 * 1e-4) << "alpha " << alpha << " component " << c; // |F| is of order 1e-4
    }
  }
}

TEST(PeriodicKernel, WithTheNearImagesItIsTheFourierSumWithoutTheMean)
{
  const PeriodicKernel kernel(cell);
  const double narrow = 5.0, wide = 6.0;
  for (const Vec3 &fraction : {Vec3(0.5, 0.31, -0.22), Vec3(-0.4, 0.45, 0.1), Vec3(0.1, -0.2, 0.47)})
  {
    const Vec3 x = fraction.cwiseProduct(cell);
    ThirdDerivatives value = kernel(x);
    for (const Vec3 &shift : near_image_shifts(cell))
    {
      const ThirdDerivatives d = of_distance(x - shift);
      std::transform(value.begin(), value.end(), d.begin(), value.begin(), std::plus<>());
    }
    const ThirdDerivatives f1 = blurred_fourier_sum(x, narrow), f2 = blurred_fourier_sum(x, wide);
    for (std::size_t c = 0; c < 10; ++c)
    {
      const double unblurred = (wide * wide * f1[c] - narrow * narrow * f2[c]) / (wide * wide - narrow * narrow);
      EXPECT_NEAR(value[c], unblurred, 1e-11 * 1e-4) << "component " << c << " at " << x.transpose();
    }
  }
}

TEST(PeriodicKernel, IsRegularWhereTheRemovedImagesAreSingular)
{
  const PeriodicKernel kernel(cell);
  for (const Vec3 &shift : near_image_shifts(cell))
  {
    const Vec3 h(1e-4, 2e-4, -1e-4);
    const ThirdDerivatives at = kernel(shift), before = kernel(shift - h), after = kernel(shift + h);
    for (std::size_t c = 0; c < 10; ++c)
      EXPECT_NEAR(at[c], 0.5 * (before[c] + after[c]), 1e-13) << shift.transpose();
  }
  for (const double component : kernel(Vec3::Zero()))
    EXPECT_NEAR(component, 0.0, 1e-18);
}

TEST(PeriodicKernel, DroppingTheMeanLeavesAUniformBackground)
{
  // lap lap R_per = -8 pi (sum of delta functions - 1/V).
  const PeriodicKernel kernel(cell);
  for (const Vec3 &x : random_differences(5))
  {
    double divergence = 0;
    const double h = 0.5;
    const auto gradient_of_laplacian = [&](const Vec3 &y)
    {
      const ThirdDerivatives d = kernel(y);
      return Vec3(d[0] + d[3] + d[5], d[1] + d[6] + d[8], d[2] + d[7] + d[9]);
    };
    for (int c = 0; c < 3; ++c)
    {
      const Vec3 e = h * Vec3::Unit(c);
      divergence += (8 * (gradient_of_laplacian(x + e)[c] - gradient_of_laplacian(x - e)[c]) -
                     (gradient_of_laplacian(x + 2 * e)[c] - gradient_of_laplacian(x - 2 * e)[c])) /
                    (12 * h);
    }
    EXPECT_NEAR(divergence * cell.prod() / (8 * pi), 1.0, 1e-7);
  }
}

TEST(PeriodicKernel, NearImagesAreThe27BoxesWithTheCellItselfFirst)
{
  const std::vector<Vec3> shifts = near_image_shifts(cell);
  ASSERT_EQ(shifts.size(), 27u);
  EXPECT_EQ(shifts[0], Vec3::Zero());
  Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
  for (const Vec3 &s : shifts)
  {
    sum += s;
    squares += s.cwiseProduct(s).cwiseQuotient(cell.cwiseProduct(cell));
  }
  EXPECT_EQ(sum, Vec3::Zero());
  EXPECT_EQ(squares, Vec3::Constant(18.0));
}

TEST(PeriodicKernel, RefusesAnImpossibleCell)
{
  EXPECT_THROW(PeriodicKernel(Vec3(1, 0, 1)), std::invalid_argument);
  EXPECT_THROW(PeriodicKernel(Vec3(1, 1, -1)), std::invalid_argument);
  EXPECT_THROW(PeriodicKernel(Vec3(1, 1, 1), -1.0), std::invalid_argument);
}
} // namespace
} // namespace ddfem
