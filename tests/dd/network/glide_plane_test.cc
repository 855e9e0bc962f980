#include "dd/network/glide_plane.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace
{
using namespace ddfem;

const Vec3 n111 = Vec3(1, 1, 1).normalized();
const Vec3 n11m1 = Vec3(1, 1, -1).normalized();
const Vec3 nm11m1 = Vec3(-1, 1, -1).normalized();

TEST(GlidePlanes, SamePlaneWithRoundingInTheOffsetIsOneObject)
{
  GlidePlanes planes;
  const PlaneIndex p = planes.find_or_insert({1, 1, 1}, n111, 123.456);
  EXPECT_EQ(planes.find_or_insert({1, 1, 1}, n111, 123.456 + 0.4e-6), p);
  EXPECT_EQ(planes.find_or_insert({1, 1, 1}, n111, 123.456 - 0.9e-6), p);
  EXPECT_EQ(planes.size(), 1u);
  EXPECT_NE(planes.find_or_insert({1, 1, 1}, n111, 123.456 + 3e-6), p);
  EXPECT_EQ(planes.size(), 2u);
}

TEST(GlidePlanes, OffsetsOnBothSidesOfAQuantisationBoundaryAreOnePlane)
{
  GlidePlanes planes;
  for (int k = -50; k <= 50; ++k)
  {
    const double boundary = (k * 1000 + 0.5) * GlidePlanes::offset_quantum;
    const PlaneIndex p = planes.find_or_insert({1, 1, 1}, n111, boundary - 1e-9);
    EXPECT_EQ(planes.find_or_insert({1, 1, 1}, n111, boundary + 1e-9), p);
  }
  EXPECT_EQ(planes.size(), 101u);
}

TEST(GlidePlanes, MillerIndicesAreReducedAndTheirSenseDoesNotMatter)
{
  GlidePlanes planes;
  const PlaneIndex p = planes.find_or_insert({1, 1, -1}, n11m1, 5.0);
  EXPECT_EQ(planes.find_or_insert({-3, -3, 3}, -n11m1, -5.0), p);
  const PlaneIndex q = planes.find_or_insert({-2, 2, -2}, nm11m1, 7.0);
  EXPECT_EQ(planes[q].miller, (std::array<int, 3>{1, -1, 1}));
  EXPECT_LT((planes[q].normal + nm11m1).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(planes[q].offset, -7.0);
  EXPECT_EQ(planes.size(), 2u);
}

TEST(GlidePlanes, PlaneThroughAPointContainsIt)
{
  GlidePlanes planes;
  const Vec3 x(1e4, -2e4, 3.3e3);
  const PlaneIndex p = planes.find_or_insert({1, 1, -1}, n11m1, x);
  EXPECT_TRUE(planes.contains(p, x));
  EXPECT_EQ(planes.find({-1, -1, 1}, -n11m1, x), p);
  EXPECT_FALSE(planes.find({1, 1, 1}, n111, x).has_value());
  EXPECT_EQ(planes.find_or_insert_parallel(p, x + Vec3(1, -1, 0)), p);
  EXPECT_NE(planes.find_or_insert_parallel(p, x + Vec3(1, 0, 0)), p);
}

TEST(GlidePlanes, PlanesWithoutMillerIndicesAreGroupedByNormal)
{
  GlidePlanes planes;
  const Vec3 n = Vec3(0.3, -1e-10, 0.8).normalized();
  const Vec3 x = Vec3(10, 20, 30);
  const PlaneIndex p = planes.find_or_insert({0, 0, 0}, n, x);
  EXPECT_EQ(planes.find_or_insert({0, 0, 0}, -n, x), p);
  EXPECT_EQ(planes.find_or_insert({0, 0, 0}, (n + Vec3(0, 2e-10, 0)).normalized(), x), p);
  const PlaneIndex q = planes.find_or_insert({0, 0, 0}, (n + Vec3(0, 1e-3, 0)).normalized(), x);
  EXPECT_NE(q, p);
  EXPECT_FALSE(planes.parallel(p, q));
  EXPECT_TRUE(planes.parallel(p, planes.find_or_insert({0, 0, 0}, n, Vec3(0, 0, 0))));
}

TEST(GlidePlanes, IntersectionDirectionLiesInBothPlanesAndIsEmptyForParallelOnes)
{
  GlidePlanes planes;
  const PlaneIndex p = planes.find_or_insert({1, 1, 1}, n111, 5.0), q = planes.find_or_insert({1, 1, -1}, n11m1, 1.0);
  const auto line = planes.intersection_direction(p, q);
  ASSERT_TRUE(line.has_value());
  EXPECT_LT((*line - Vec3(-1, 1, 0).normalized()).norm(), 1e-14);
  EXPECT_FALSE(planes.intersection_direction(p, planes.find_or_insert({1, 1, 1}, n111, 6.0)).has_value());
}

TEST(GlidePlanes, ProjectionOnSeveralPlanesLiesOnAllAndIsThePointNearest)
{
  GlidePlanes planes;
  const PlaneIndex p = planes.find_or_insert({1, 1, 1}, n111, 5.0), q = planes.find_or_insert({1, 1, -1}, n11m1, 1.0),
                   r = planes.find_or_insert({-1, 1, -1}, nm11m1, -2.0);
  const Vec3 x(3, -4, 11);

  EXPECT_LT((planes.project(p, x) - (x - (x.dot(n111) - 5) * n111)).norm(), 1e-13);

  const std::array<PlaneIndex, 4> two = {p, q, p, PlaneIndex{}};
  const Vec3 y = planes.project_on_intersection(two, x);
  EXPECT_NEAR(planes.distance(p, y), 0, 1e-12);
  EXPECT_NEAR(planes.distance(q, y), 0, 1e-12);
  EXPECT_NEAR((y - x).dot(*planes.intersection_direction(p, q)), 0, 1e-12); // no motion along the line

  const std::array<PlaneIndex, 3> three = {p, q, r};
  const Vec3 z = planes.project_on_intersection(three, x);
  for (const PlaneIndex plane : three)
    EXPECT_NEAR(planes.distance(plane, z), 0, 1e-12);
  EXPECT_EQ(planes.project_on_intersection({}, x), x);
}

TEST(GlidePlanes, MeaninglessPlanesAreRefused)
{
  GlidePlanes planes;
  EXPECT_THROW(planes.find_or_insert({1, 1, 1}, Vec3(1, 1, 1), 0.0), std::invalid_argument);
  EXPECT_THROW(planes.find_or_insert({1, 1, 1}, n111, std::nan("")), std::invalid_argument);
  planes.find_or_insert({1, 1, 1}, n111, 0.0);
  EXPECT_THROW(planes.find_or_insert({1, 1, 1}, n11m1, 0.0), std::invalid_argument);
}
} // namespace
