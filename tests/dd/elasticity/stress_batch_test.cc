// The vectorised evaluation against the one point by point.
#include "dd/elasticity/segment_stress.h"
#include "tests/dd/elasticity/elasticity_test_helpers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace ddfem
{
namespace
{
/// Largest difference of field.add() from field(x) over points near, far, beside and ahead of a line, over the largest
/// stress at each point; the sums start from one.
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
  field.add(batch);
  double error = 0;
  for (std::size_t i = 0; i < n; ++i)
  {
    const SymTensor exact = 2 * field(points[i]);
    // On the line what is left of the stress is that of the distance by rounding, far below the stress around the core.
    const bool on_line = i < 23;
    const double around_core = test::copper_like.mu * 0.37 / (4 * M_PI * test::copper_like.a);
    const double scale = on_line ? around_core : exact.lpNorm<Eigen::Infinity>();
    for (std::size_t c = 0; c < 6; ++c)
      error = std::max(error, std::abs(sigma[c * n + i] - exact[static_cast<Eigen::Index>(c)]) / scale);
  }
  return error;
}
} // namespace

// Both are the same formula; the compiler may contract products and sums.
TEST(StressBatch, OfASegmentIsThatOfItsPoints)
{
  const Vec3 x1(1, -2, 3), x2(11, 20, -17);
  EXPECT_LT(
      error_of_batch(SegmentStressField(test::copper_like, x1, x2, Vec3(0.1, 0.2, -0.3)), x1, (x2 - x1).normalized()),
      1e-12);
}

TEST(StressBatch, OfARayIsThatOfItsPoints)
{
  const Vec3 origin(1, -2, 3), direction = Vec3(1, 2, -2) / 3;
  EXPECT_LT(
      error_of_batch(RayStressField(test::copper_like, origin, direction, Vec3(0.1, 0.2, -0.3)), origin, direction),
      1e-12);
}
} // namespace ddfem
