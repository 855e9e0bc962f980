#include "dd/crystal/miller_bravais.h"
#include "dd/crystal/orientation.h"
#include "dd/crystal/unit_cell.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace
{
using namespace ddfem;

constexpr double zirconium = 1.5929; // c/a

/// The hexagonal indices used below: all with |index| <= 2 that are not zero.
std::vector<Miller> small_indices()
{
  std::vector<Miller> all;
  for (int h = -2; h <= 2; ++h)
    for (int k = -2; k <= 2; ++k)
      for (int l = -2; l <= 2; ++l)
        if (h != 0 || k != 0 || l != 0)
          all.push_back({h, k, l});
  return all;
}

TEST(MillerBravais, ThreeAndFourIndicesNameTheSamePlaneOrDirection)
{
  EXPECT_EQ(plane_from_four_indices({1, 0, -1, 1}), (Miller{1, 0, 1}));
  EXPECT_EQ(plane_from_four_indices({1, 1, -2, 2}), (Miller{1, 1, 2}));
  EXPECT_EQ(direction_from_four_indices({2, -1, -1, 0}), (Miller{1, 0, 0}));
  EXPECT_EQ(direction_from_four_indices({1, 1, -2, 0}), (Miller{1, 1, 0}));
  EXPECT_EQ(direction_from_four_indices({0, 1, -1, 0}), (Miller{1, 2, 0}));
  EXPECT_EQ(direction_from_four_indices({1, 1, -2, 3}), (Miller{1, 1, 1}));
  EXPECT_EQ(direction_from_four_indices({0, 0, 0, 1}), (Miller{0, 0, 1}));
  for (const Miller &m : small_indices())
  {
    EXPECT_EQ(plane_from_four_indices(to_four_index_plane(m)), m);
    EXPECT_EQ(direction_from_four_indices(to_four_index_direction(m)), reduced(m)) << to_string(m);
  }
  EXPECT_EQ(to_string(MillerBravais{1, 0, -1, 1}), "10-11");
  EXPECT_EQ(to_string(MillerBravais{9, 1, -10, 2}), "9 1 -10 2");
  EXPECT_THROW(plane_from_four_indices({1, 0, 0, 1}), std::invalid_argument);
  EXPECT_THROW(direction_from_four_indices({1, 1, 2, 0}), std::invalid_argument);
}

TEST(UnitCell, FourIndexDirectionIsTheSumOverThreeBasalAxesAndC)
{
  // The definition of [u v t w]: u a1 + v a2 + t a3 + w c with a3 = -(a1 + a2).
  const UnitCell cell = UnitCell::hexagonal(zirconium);
  const Vec3 a1 = cell.direction({1, 0, 0}), a2 = cell.direction({0, 1, 0}), c = cell.direction({0, 0, 1});
  for (const Miller &m : small_indices())
  {
    const MillerBravais f = to_four_index_direction(m);
    const Vec3 sum = f[0] * a1 + f[1] * a2 - f[2] * (a1 + a2) + f[3] * c;
    EXPECT_LT(sum.normalized().cross(cell.direction(m).normalized()).norm(), 1e-15);
    EXPECT_GT(sum.dot(cell.direction(m)), 0);
  }
}

TEST(UnitCell, HexagonalAxesEncloseSixtyDegreesAndThirtyWithTheNormals)
{
  const UnitCell cell = UnitCell::hexagonal(zirconium);
  EXPECT_FALSE(cell.is_cubic());
  const Vec3 a1 = cell.direction({1, 0, 0}), a2 = cell.direction({0, 1, 0}), c = cell.direction({0, 0, 1});
  EXPECT_EQ(a1, Vec3::UnitX());
  EXPECT_EQ(c, zirconium * Vec3::UnitZ());
  EXPECT_NEAR(a2.norm(), 1, 1e-15);
  EXPECT_NEAR(a1.dot(a2), -0.5, 1e-15);
  EXPECT_NEAR((a1 + a2).norm(), 1, 1e-15); // -a3
  EXPECT_LT((cell.direction({1, 2, 0}).normalized() - Vec3::UnitY()).norm(), 1e-15);
}

TEST(UnitCell, ZoneLawOfIntegersIsOrthogonalityOfNormalAndDirection)
{
  for (const UnitCell &cell : {UnitCell(), UnitCell::hexagonal(zirconium), UnitCell::hexagonal(1.886)})
    for (const Miller &plane : small_indices())
      for (const Miller &direction : small_indices())
        EXPECT_NEAR(cell.normal(plane).dot(cell.direction(direction)), static_cast<double>(dot(plane, direction)),
                    1e-14);
}

TEST(UnitCell, SpacingOfThePlanesIsThatOfTheHexagonalFormula)
{
  // 1/d^2 = 4/3 (h^2 + h k + k^2)/a^2 + l^2/c^2 (any text on diffraction, such as Cullity, appendix 3).
  for (const double ratio : {1.5929, std::sqrt(8.0 / 3)})
    for (const Miller &m : small_indices())
    {
      const double expected = 4.0 / 3 * (m[0] * m[0] + m[0] * m[1] + m[1] * m[1]) + m[2] * m[2] / (ratio * ratio);
      EXPECT_NEAR(UnitCell::hexagonal(ratio).normal(m).squaredNorm(), expected, 1e-13);
    }
}

TEST(UnitCell, CoordinatesUndoTheDirection)
{
  for (const UnitCell &cell : {UnitCell(), UnitCell::hexagonal(zirconium)})
    for (const Miller &m : small_indices())
      EXPECT_LT((cell.coordinates(cell.direction(m)) - to_vector(m)).norm(), 1e-15);
}

TEST(UnitCell, NamesHaveFourIndicesInHexagonalCrystalsOnly)
{
  const UnitCell hexagonal = UnitCell::hexagonal(zirconium);
  EXPECT_EQ(hexagonal.plane_name({1, 0, 1}), "(10-11)");
  EXPECT_EQ(hexagonal.direction_name({1, 1, 1}), "[11-23]");
  EXPECT_EQ(UnitCell().plane_name({1, 0, 1}), "(101)");
  EXPECT_EQ(UnitCell().direction_name({1, -1, 1}), "[1-11]");
}

TEST(UnitCell, AbsurdAxialRatioIsRefused)
{
  for (const double ratio : {0.0, -1.6, 0.4, 4.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(UnitCell::hexagonal(ratio), std::invalid_argument) << ratio;
}

TEST(Orientation, HexagonalDirectionsLieAlongTheSampleAxes)
{
  const UnitCell cell = UnitCell::hexagonal(zirconium);
  EXPECT_EQ(Orientation::from_axes(SampleAxis::x, {1, 0, 0}, SampleAxis::z, {0, 0, 1}, cell).rotation(),
            Mat3::Identity());
  EXPECT_EQ(Orientation(cell).rotation(), Mat3::Identity());
  // c along x, [10-10] along z; then y is along z x x = [1-210].
  const Orientation turned = Orientation::from_axes(SampleAxis::x, {0, 0, 1}, SampleAxis::z, {2, 1, 0}, cell);
  EXPECT_LT((turned.direction({0, 0, 1}) - Vec3::UnitX()).norm(), 1e-15);
  EXPECT_LT((turned.direction({2, 1, 0}) - Vec3::UnitZ()).norm(), 1e-15);
  EXPECT_LT((turned.direction({0, -1, 0}) - Vec3::UnitY()).norm(), 1e-15);
  EXPECT_LT((turned.plane_normal({0, 0, 1}) - Vec3::UnitX()).norm(), 1e-15); // the c axis is normal to (0001)
  // A <c+a> direction and the prismatic direction normal to its a.
  const Orientation tilted = Orientation::from_axes(SampleAxis::z, {1, 0, 1}, SampleAxis::x, {1, 2, 0}, cell);
  EXPECT_LT((tilted.rotation() * tilted.rotation().transpose() - Mat3::Identity()).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_NEAR(tilted.rotation().determinant(), 1, 1e-15);
  EXPECT_NEAR(tilted.direction({0, 0, 1})[2], zirconium / std::hypot(1, zirconium), 1e-15);
}

TEST(Orientation, HexagonalOrthogonalityIsThatOfTheMetric)
{
  const UnitCell cell = UnitCell::hexagonal(zirconium);
  // [100] and [010] are at 120 degrees, [100] and [120] at 90; cubic indices would say the opposite.
  EXPECT_FALSE(cell.orthogonal({1, 0, 0}, {0, 1, 0}));
  EXPECT_TRUE(cell.orthogonal({1, 0, 0}, {1, 2, 0}));
  EXPECT_TRUE(UnitCell().orthogonal({1, 0, 0}, {0, 1, 0}));
  try
  {
    Orientation::from_axes(SampleAxis::x, {1, 0, 0}, SampleAxis::z, {0, 1, 0}, cell);
    FAIL();
  }
  catch (const std::invalid_argument &error)
  {
    EXPECT_STREQ(error.what(), "The crystal directions [2-1-10] and [-12-10] of two sample axes enclose 120.000000 "
                               "degrees; they must be orthogonal.");
  }
}
} // namespace
