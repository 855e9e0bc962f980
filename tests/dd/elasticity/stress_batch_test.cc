// The vectorised evaluation against the one point by point.
#include "dd/elasticity/segment_stress.h"
#include "tests/dd/elasticity/elasticity_test_helpers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace ddfem
{
namespace
{
const Vec3 b(0.1, 0.2, -0.3);

/// What rounding may change in the stress at @p x: a relative error of the formula itself, and the error of the distance
/// from the line, a few times the spacing of numbers of the size of x - @p first, times a bound of the stress gradient,
/// mu b/(pi (1-nu) (d^2 + a^2)).
double rounding(const SymTensor &stress, const Vec3 &x, const Vec3 &first, const Vec3 &direction)
{
  const IsotropicMedium &m = test::copper_like;
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const double distance2 = (x - first).cross(direction).squaredNorm();
  const double gradient = m.mu * b.norm() / (std::numbers::pi * (1 - m.nu) * (distance2 + m.a * m.a));
  return 1e-13 * stress.lpNorm<Eigen::Infinity>() + 4 * epsilon * (x - first).norm() * gradient;
}

/// Largest difference of field.add() from field(x), over rounding(), at points near, far, beside and ahead of a line.
template <typename Field> double error_of_batch(const Field &field, const Vec3 &first, const Vec3 &direction)
{
  test::RandomVectors random(11);
  std::vector<Vec3> points;
  for (const double scale : {0.0, 1e-3, 1.0, 30.0, 1e5})
    for (int k = 0; k < 23; ++k) // not a multiple of any vector's width
      points.push_back(first + 40 * random.number() * direction + scale * random.vector());
  const std::size_t n = points.size();
  std::vector<double> x(3 * n), sigma(6 * n, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      x[c * n + i] = points[i][static_cast<Eigen::Index>(c)];
  StressBatch batch{n, {&x[0], &x[n], &x[2 * n]}, {}};
  for (std::size_t c = 0; c < 6; ++c)
    batch.sigma[c] = &sigma[c * n];
  field.add(batch);
  field.add(batch); // adds: twice the stress
  double error = 0;
  for (std::size_t i = 0; i < n; ++i)
  {
    const SymTensor exact = field(points[i]);
    for (std::size_t c = 0; c < 6; ++c)
      error = std::max(error, std::abs(0.5 * sigma[c * n + i] - exact[static_cast<Eigen::Index>(c)]) /
                                  rounding(exact, points[i], first, direction));
  }
  return error;
}
} // namespace

// Both are the same formula; the compiler may contract products and sums.
TEST(StressBatch, OfASegmentIsThatOfItsPoints)
{
  const Vec3 x1(1, -2, 3), x2(11, 20, -17);
  EXPECT_LT(error_of_batch(SegmentStressField(test::copper_like, x1, x2, b), x1, (x2 - x1).normalized()), 1);
}

TEST(StressBatch, OfARayIsThatOfItsPoints)
{
  const Vec3 origin(1, -2, 3), direction = Vec3(1, 2, -2) / 3;
  EXPECT_LT(error_of_batch(RayStressField(test::copper_like, origin, direction, b), origin, direction), 1);
}
} // namespace ddfem
