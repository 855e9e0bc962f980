#include "dd/crystal/burgers_vectors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using namespace ddfem;

constexpr double a0 = 0.3, ratio = 1.5929;

Orientation turned(const Lattice lattice)
{
  if (lattice == Lattice::hcp)
    return Orientation::from_axes(SampleAxis::z, {1, 0, 1}, SampleAxis::x, {1, 2, 0}, UnitCell::hexagonal(ratio));
  return Orientation::from_loading_axis({1, 2, 3});
}

/// u, v, w in units of the axes of the cell.
std::optional<BurgersType> type_of(const Lattice lattice, const double u, const double v, const double w)
{
  const Orientation orientation = turned(lattice);
  const UnitCell &cell = orientation.cell();
  const Vec3 b = a0 * (u * cell.direction({1, 0, 0}) + v * cell.direction({0, 1, 0}) + w * cell.direction({0, 0, 1}));
  return burgers_type(lattice, a0, orientation, orientation.to_sample(b));
}

TEST(BurgersVectors, TypesOfCubicLattices)
{
  EXPECT_EQ(type_of(Lattice::fcc, 0.5, 0, -0.5), BurgersType::half_110);
  EXPECT_EQ(type_of(Lattice::fcc, 0, -1, 0), BurgersType::full_100);
  EXPECT_EQ(type_of(Lattice::fcc, 1, 0.5, 0.5), BurgersType::other); // a/2<211> is a translation
  EXPECT_EQ(type_of(Lattice::bcc, 0.5, -0.5, 0.5), BurgersType::half_111);
  EXPECT_EQ(type_of(Lattice::bcc, 0, 0, 1), BurgersType::full_100);
  EXPECT_EQ(type_of(Lattice::bcc, 1, -1, 0), BurgersType::full_110);
  EXPECT_EQ(type_of(Lattice::bcc, 1.5, 0.5, 0.5), BurgersType::other);
}

TEST(BurgersVectors, TypesOfTheHexagonalLattice)
{
  for (const auto &[u, v] : {std::pair{1, 0}, {0, 1}, {1, 1}, {-1, 0}, {0, -1}, {-1, -1}})
  {
    EXPECT_EQ(type_of(Lattice::hcp, u, v, 0), BurgersType::a);
    EXPECT_EQ(type_of(Lattice::hcp, u, v, 1), BurgersType::c_plus_a);
    EXPECT_EQ(type_of(Lattice::hcp, u, v, -1), BurgersType::c_plus_a);
  }
  EXPECT_EQ(type_of(Lattice::hcp, 0, 0, -1), BurgersType::c);
  EXPECT_EQ(type_of(Lattice::hcp, 1, -1, 0), BurgersType::other); // <10-10>, length a sqrt(3)
  EXPECT_EQ(type_of(Lattice::hcp, 0, 0, 2), BurgersType::other);
}

TEST(BurgersVectors, PartialsAndVectorsOfOtherLatticesAreNoTranslations)
{
  const auto none = std::optional<BurgersType>();
  EXPECT_EQ(type_of(Lattice::fcc, 1.0 / 6, 1.0 / 6, 1.0 / 3), none); // Shockley
  EXPECT_EQ(type_of(Lattice::fcc, 1.0 / 3, 1.0 / 3, 1.0 / 3), none); // Frank
  EXPECT_EQ(type_of(Lattice::fcc, 0.5, 0.5, 0.5), none);             // bcc
  EXPECT_EQ(type_of(Lattice::bcc, 0.5, 0.5, 0), none);               // fcc
  EXPECT_EQ(type_of(Lattice::hcp, 1.0 / 3, 2.0 / 3, 0.5), none);     // basal vacancy loop 1/6<20-23>
  EXPECT_EQ(type_of(Lattice::hcp, 0, 0, 0.5), none);
  EXPECT_EQ(type_of(Lattice::fcc, 0, 0, 0), none);
  EXPECT_EQ(type_of(Lattice::fcc, std::nan(""), 0, 0), none);
  EXPECT_EQ(type_of(Lattice::fcc, 0.5 + 2e-4, 0.5, 0), none);
  EXPECT_EQ(type_of(Lattice::fcc, 0.5 + 5e-5, 0.5, 0), BurgersType::half_110); // rounding of a file
}

TEST(BurgersVectors, ShortestTranslationsHaveTheLengthsOfTheLattice)
{
  const auto length = [](const Lattice lattice, const Miller &direction)
  { return shortest_translation(lattice, a0, turned(lattice), direction).norm(); };
  EXPECT_NEAR(length(Lattice::fcc, {1, -1, 0}), a0 / std::sqrt(2.0), 1e-16);
  EXPECT_NEAR(length(Lattice::fcc, {2, 0, 0}), a0, 1e-15);
  EXPECT_NEAR(length(Lattice::fcc, {1, 1, 1}), a0 * std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(length(Lattice::bcc, {1, -1, 1}), a0 * std::sqrt(3.0) / 2, 1e-16);
  EXPECT_NEAR(length(Lattice::bcc, {1, 1, 0}), a0 * std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(length(Lattice::hcp, {-1, -1, 0}), a0, 1e-15);
  EXPECT_NEAR(length(Lattice::hcp, {0, 0, 3}), a0 * ratio, 1e-15);
  EXPECT_NEAR(length(Lattice::hcp, {1, 1, 1}), a0 * std::hypot(1, ratio), 1e-15); // sqrt(a^2 + c^2)
  EXPECT_EQ(burgers_magnitude(Lattice::hcp, a0), a0);
}

TEST(BurgersVectors, NoTranslationAlongTheDirectionIsShorter)
{
  for (const Lattice lattice : {Lattice::fcc, Lattice::bcc, Lattice::hcp})
    for (const Miller &direction :
         {Miller{1, 0, 0}, Miller{1, 1, 0}, Miller{1, 1, 1}, Miller{2, 1, 1}, Miller{1, 2, 0}})
    {
      const Vec3 b = shortest_translation(lattice, a0, turned(lattice), direction);
      EXPECT_TRUE(burgers_type(lattice, a0, turned(lattice), b)) << name_of(lattice) << to_string(direction);
      for (const double part : {1.0 / 2, 1.0 / 3, 1.0 / 6})
        EXPECT_FALSE(burgers_type(lattice, a0, turned(lattice), part * b)) << name_of(lattice) << to_string(direction);
    }
}
} // namespace
