#include "dd/elasticity/distance.h"
#include "dd/elasticity/gauss.h"
#include "tests/dd/elasticity/elasticity_test_helpers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace ddfem
{
namespace
{
using test::RandomVectors;

TEST(GaussRule, IntegratesPolynomialsOfDegreeTwoNMinusOneExactly)
{
  for (int n = 1; n <= max_gauss_points; ++n)
  {
    const GaussRule rule = gauss_rule(n);
    ASSERT_EQ(rule.points.size(), static_cast<std::size_t>(n));
    for (int degree = 0; degree <= 2 * n - 1; ++degree)
    {
      double integral = 0.0;
      for (std::size_t i = 0; i < rule.points.size(); ++i)
        integral += rule.weights[i] * std::pow(rule.points[i], degree);
      EXPECT_NEAR(integral, 1.0 / (degree + 1), 2e-15) << "n " << n << " degree " << degree;
    }
    EXPECT_TRUE(std::is_sorted(rule.points.begin(), rule.points.end()));
  }
  EXPECT_THROW(gauss_rule(0), std::out_of_range);
  EXPECT_THROW(gauss_rule(max_gauss_points + 1), std::out_of_range);
}

TEST(Distance, OfSegmentsIsTheSmallestOverAFineSampling)
{
  RandomVectors random(1);
  for (int i = 0; i < 50; ++i)
  {
    const Vec3 x1 = random.vector(), x2 = random.vector(), x3 = random.vector();
    // Every other pair parallel, where the minimum is not unique.
    const Vec3 x4 = i % 2 == 0 ? random.vector() : Vec3(x3 + random.number() * (x2 - x1));
    const PairDistance result = distance_segment_segment(x1, x2, x3, x4);
    const Vec3 gap = x1 + result.first * (x2 - x1) - x3 - result.second * (x4 - x3);
    EXPECT_NEAR(gap.norm(), std::sqrt(result.squared), 1e-14);
    double sampled = 1e300;
    for (int k = 0; k <= 1000; ++k)
      sampled = std::min(sampled, distance_point_segment(x1 + k / 1000.0 * (x2 - x1), x3, x4).squared);
    EXPECT_LE(result.squared, sampled + 1e-15) << "case " << i;
    EXPECT_LT(std::sqrt(sampled) - std::sqrt(result.squared), 2e-3) << "case " << i;
  }
}

TEST(Distance, ToARayIsTheDistanceToALongSegment)
{
  RandomVectors random(2);
  for (int i = 0; i < 100; ++i)
  {
    const Vec3 x1 = random.vector(), x2 = random.vector(), origin = random.vector();
    const Vec3 direction = random.vector().normalized(), end = origin + 100.0 * direction;
    EXPECT_NEAR(distance_segment_ray(x1, x2, origin, direction).squared,
                distance_segment_segment(x1, x2, origin, end).squared, 1e-13);
    EXPECT_NEAR(distance_point_ray(x1, origin, direction).squared, distance_point_segment(x1, origin, end).squared,
                1e-13);
  }
}

TEST(Distance, OfCrossingSegmentsIsTheirGapForAnyAngle)
{
  for (const double angle : {1.0, 1e-2, 1e-5, 1e-7})
  {
    const Vec3 along(std::cos(angle), std::sin(angle), 0.0);
    const PairDistance result =
        distance_segment_segment({-1, 0, 0}, {2, 0, 0}, Vec3(0, 0, 0.25) - along, Vec3(0, 0, 0.25) + 3.0 * along);
    EXPECT_NEAR(result.squared, 0.0625, 1e-15) << angle;
  }
}

TEST(Distance, OfSegmentsWithoutLengthIsThatOfPoints)
{
  const Vec3 p(1, 2, 3), q(1, 2, 5);
  EXPECT_EQ(distance_segment_segment(p, p, q, q).squared, 4.0);
  EXPECT_EQ(distance_point_segment(p, q, q).squared, 4.0);
}
} // namespace
} // namespace ddfem
