#include "dd/crystal/slip_systems.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace
{
using namespace ddfem;

constexpr double a0 = 0.36146;

/// The 24 proper rotations that map a cube onto itself: signed permutations of determinant +1.
std::vector<Mat3> cube_rotations()
{
  std::vector<Mat3> rotations;
  std::array<int, 3> axes = {0, 1, 2};
  do
    for (int signs = 0; signs < 8; ++signs)
    {
      Mat3 r = Mat3::Zero();
      for (int d = 0; d < 3; ++d)
        r(d, axes[static_cast<std::size_t>(d)]) = (signs >> d & 1) != 0 ? -1 : 1;
      if (r.determinant() > 0)
        rotations.push_back(r);
    }
  while (std::ranges::next_permutation(axes).found);
  return rotations;
}

/// Number of systems whose |Schmid factor| is the largest.
std::size_t n_equally_loaded(const SlipSystems &systems, const Vec3 &axis)
{
  const double largest = systems.largest_schmid_factor(axis);
  return static_cast<std::size_t>(std::ranges::count_if(
      systems, [&](const SlipSystem &s) { return std::abs(std::abs(s.schmid_factor(axis)) - largest) < 1e-12; }));
}

TEST(SlipSystems, FccHasTwelveDistinctSystemsWithBurgersVectorsInTheirPlanes)
{
  const SlipSystems systems(Lattice::fcc, a0, Orientation::from_loading_axis({1, 2, 3}));
  ASSERT_EQ(systems.size(), 12u);
  EXPECT_EQ(systems.planes().size(), 4u);
  EXPECT_NEAR(systems.burgers_magnitude(), a0 / std::sqrt(2.0), 1e-16);
  std::set<std::string> names;
  for (const SlipSystem &s : systems)
  {
    EXPECT_EQ(dot(s.plane_miller, s.direction), 0);
    EXPECT_NEAR(s.burgers.dot(s.normal), 0, 1e-16);
    EXPECT_NEAR(s.normal.norm(), 1, 1e-15);
    EXPECT_NEAR(s.burgers.norm(), a0 / std::sqrt(2.0), 1e-15);
    EXPECT_LT((s.normal - systems.orientation().unit_vector(s.plane_miller)).norm(), 1e-15);
    names.insert(s.name);
  }
  EXPECT_EQ(names.size(), 12u);
}

TEST(SlipSystems, FccSystemsCarryTheirSchmidBoasLabels)
{
  const SlipSystems systems(Lattice::fcc, a0);
  std::string labels;
  for (const SlipSystem &s : systems)
    labels += s.schmid_boas + " ";
  EXPECT_EQ(labels, "A2 A3 A6 B2 B4 B5 C1 C3 C5 D1 D4 D6 ");
  EXPECT_EQ(systems[*systems.find("A6")].name, "(-111)[110]");
  EXPECT_EQ(systems[*systems.find("B4")].name, "(111)[-101]");
  EXPECT_EQ(systems[*systems.find("C1")].name, "(-1-11)[011]");
  EXPECT_EQ(systems[*systems.find("(1-11)[110]")].schmid_boas, "D6");
  EXPECT_FALSE(systems.find("E7").has_value());
  EXPECT_FALSE(systems.find("").has_value());
}

TEST(SlipSystems, CubicRotationsMapTheSystemsOntoEachOther)
{
  const std::vector<Mat3> rotations = cube_rotations();
  ASSERT_EQ(rotations.size(), 24u);
  for (const Lattice lattice : {Lattice::fcc, Lattice::bcc})
  {
    const SlipSystems systems(lattice, a0);
    std::set<std::size_t> images_of_first;
    for (const Mat3 &r : rotations)
    {
      std::set<std::size_t> images;
      for (const SlipSystem &s : systems)
      {
        const auto image = systems.find(Vec3(r * s.burgers), Vec3(r * s.normal));
        ASSERT_TRUE(image.has_value()) << s.name;
        images.insert(image->system);
      }
      EXPECT_EQ(images.size(), systems.size());
      const auto first = systems.find(Vec3(r * systems[0].burgers), Vec3(r * systems[0].normal));
      images_of_first.insert(first->system);
    }
    EXPECT_EQ(images_of_first.size(), 12u); // all of a family are equivalent
  }
}

TEST(SlipSystems, SchmidFactorsOfTheSymmetricAxesAreTheTextbookOnes)
{
  const SlipSystems systems(Lattice::fcc, a0);
  EXPECT_NEAR(systems.largest_schmid_factor(Vec3(0, 0, 1)), 1 / std::sqrt(6.0), 1e-15); // 0.408
  EXPECT_EQ(n_equally_loaded(systems, Vec3(0, 0, 1)), 8u);
  EXPECT_NEAR(systems.largest_schmid_factor(Vec3(1, 1, 1)), std::sqrt(6.0) / 9, 1e-15); // 0.272
  EXPECT_EQ(n_equally_loaded(systems, Vec3(1, 1, 1)), 6u);
  EXPECT_NEAR(systems.largest_schmid_factor(Vec3(0, 1, 1)), 1 / std::sqrt(6.0), 1e-15);
  EXPECT_EQ(n_equally_loaded(systems, Vec3(0, 1, 1)), 4u);
  EXPECT_NEAR(systems.largest_schmid_factor(Vec3(1, 2, 3)), 0.467, 5e-4); // 8/(7 sqrt(6))
  EXPECT_EQ(n_equally_loaded(systems, Vec3(1, 2, 3)), 1u);
}

TEST(SlipSystems, SchmidFactorDependsOnTheCrystalDirectionOfTheLoadOnly)
{
  const SlipSystems aligned(Lattice::fcc, a0), turned(Lattice::fcc, a0, Orientation::from_loading_axis({1, 2, 3}));
  for (std::size_t s = 0; s < aligned.size(); ++s)
    EXPECT_NEAR(turned[s].schmid_factor(Vec3(0, 0, 1)), aligned[s].schmid_factor(Vec3(1, 2, 3)), 1e-15);
}

TEST(SlipSystems, ResolvedShearStressOfUniaxialTensionIsSchmidFactorTimesStress)
{
  const SlipSystems systems(Lattice::fcc, a0, Orientation::from_loading_axis({1, 2, 3}));
  SymTensor tension = SymTensor::Zero();
  tension[2] = 50;
  SymTensor pressure = SymTensor::Zero();
  pressure.head<3>().setConstant(-7);
  for (const SlipSystem &s : systems)
  {
    EXPECT_NEAR(s.resolved_shear_stress(tension), 50 * s.schmid_factor(Vec3(0, 0, 1)), 1e-13);
    EXPECT_NEAR(s.resolved_shear_stress(tension), double_contract(s.schmid_tensor(), tension), 1e-13);
    EXPECT_NEAR(s.resolved_shear_stress(pressure), 0, 1e-14);
  }
}

TEST(SlipSystems, SystemIsFoundFromBurgersVectorAndPlaneInEitherSense)
{
  const SlipSystems systems(Lattice::fcc, a0, Orientation::from_loading_axis({1, 1, 1}));
  for (std::size_t s = 0; s < systems.size(); ++s)
  {
    const Miller plane = systems[s].plane_miller;
    for (const int sign : {1, -1})
    {
      const Vec3 b = sign * systems[s].burgers;
      const auto by_name = systems.find(b, Miller{2 * plane[0], 2 * plane[1], 2 * plane[2]});
      const auto by_unit = systems.find(b, Vec3(-systems[s].normal));
      ASSERT_TRUE(by_name && by_unit);
      EXPECT_EQ(by_name->system, s);
      EXPECT_EQ(by_unit->system, s);
      EXPECT_EQ(by_name->burgers_sign, sign);
      EXPECT_EQ(by_unit->burgers_sign, sign);
    }
  }
  EXPECT_FALSE(systems.find(systems[0].burgers, Miller{1, 0, 0}).has_value());
  EXPECT_FALSE(systems.find(Vec3(2 * systems[0].burgers), systems[0].plane_miller).has_value());
}

TEST(SlipSystems, FccBurgersVectorGlidesOnTwoPlanesAndALockOnNone)
{
  const SlipSystems systems(Lattice::fcc, a0);
  for (const SlipSystem &s : systems)
  {
    const auto planes = systems.glissile_planes(s.burgers);
    ASSERT_EQ(planes.size(), 2u);
    EXPECT_TRUE(std::ranges::find(planes, s.plane) != planes.end());
    for (const std::size_t p : planes)
      EXPECT_NEAR(systems.planes()[p].normal.dot(s.burgers), 0, 1e-15);
  }
  EXPECT_TRUE(systems.glissile_planes(Vec3(a0, 0, 0)).empty()); // product of a Hirth junction
}

TEST(SlipSystems, BccHasTwelve110And12_112Systems)
{
  const SlipSystems systems(Lattice::bcc, 0.28665);
  ASSERT_EQ(systems.size(), 24u);
  EXPECT_EQ(systems.planes().size(), 18u);
  for (const SlipSystem &s : systems)
  {
    EXPECT_NEAR(s.burgers.norm(), 0.28665 * std::sqrt(3.0) / 2, 1e-15);
    EXPECT_NEAR(s.burgers.dot(s.normal), 0, 1e-16);
    EXPECT_EQ(systems.glissile_planes(s.burgers).size(), 6u); // three {110} and three {112} per <111>
  }
  EXPECT_NEAR(systems.largest_schmid_factor(Vec3(0, 0, 1)), std::sqrt(2.0) / 3, 1e-15); // {112}<111>: 0.471
}

TEST(SlipSystems, WhatIsNotTabulatedIsRefused)
{
  EXPECT_THROW(SlipSystems(Lattice::hcp, 0.32), std::invalid_argument);
  EXPECT_THROW(SlipSystems(Lattice::fcc, 0), std::invalid_argument);
  EXPECT_THROW(SlipSystems(Lattice::fcc, std::nan("")), std::invalid_argument);
}
} // namespace
