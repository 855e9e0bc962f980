// Families of slip systems against the symmetry of the crystal.
#include "dd/crystal/slip_systems.h"
#include "tests/dd/crystal/point_group.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

namespace
{
using namespace ddfem;

constexpr double a0 = 0.32316, ratio = 1.5929;

SlipSystems crystal(const Lattice lattice, const double c_over_a = ratio)
{
  if (lattice == Lattice::hcp)
    return {lattice, a0, Orientation(UnitCell::hexagonal(c_over_a))};
  return {lattice, a0, Orientation(), {lattice == Lattice::bcc}};
}

constexpr std::array<Lattice, 3> lattices = {Lattice::fcc, Lattice::bcc, Lattice::hcp};

/// Slip systems and those of products.
std::vector<SlipSystem> all_systems(const SlipSystems &systems)
{
  std::vector<SlipSystem> all(systems.begin(), systems.end());
  all.insert(all.end(), systems.product_systems().begin(), systems.product_systems().end());
  return all;
}

/// Index of the system with this plane and Burgers vector up to their senses; all.size() if there is none.
std::size_t index_of(const std::vector<SlipSystem> &all, const Vec3 &normal, const Vec3 &burgers)
{
  std::size_t s = 0;
  while (s < all.size() && !(all[s].normal.cross(normal).norm() < 1e-12 &&
                             std::min((all[s].burgers - burgers).norm(), (all[s].burgers + burgers).norm()) < 1e-12))
    ++s;
  return s;
}

/// Number of independent strains that these families provide: the rank of their Schmid tensors.
int independent_strains(const SlipSystems &systems, const std::set<SlipFamily> &families)
{
  Eigen::MatrixXd tensors(6, 0);
  for (const SlipSystem &s : systems)
    if (families.contains(s.family))
    {
      tensors.conservativeResize(6, tensors.cols() + 1);
      tensors.col(tensors.cols() - 1) = s.schmid_tensor();
    }
  Eigen::FullPivLU<Eigen::MatrixXd> lu(tensors);
  lu.setThreshold(1e-10);
  return static_cast<int>(lu.rank());
}

TEST(PointGroup, HasTheOrderOfItsClass)
{
  EXPECT_EQ(test::point_group(Lattice::fcc).size(), 48u);
  EXPECT_EQ(test::point_group(Lattice::hcp).size(), 24u);
}

TEST(SlipFamilies, HaveTheKnownNumbersOfSystemsPlanesAndDirections)
{
  struct Count
  {
    std::size_t systems, planes, directions;
    auto operator<=>(const Count &) const = default;
  };
  const std::map<SlipFamily, Count> known = {
      {SlipFamily::fcc_111, {12, 4, 6}},      {SlipFamily::bcc_110, {12, 6, 4}},
      {SlipFamily::bcc_112, {12, 12, 4}},     {SlipFamily::bcc_123, {24, 24, 4}},
      {SlipFamily::bcc_110_100, {6, 6, 3}},   {SlipFamily::prismatic, {3, 3, 3}},
      {SlipFamily::basal, {3, 1, 3}},         {SlipFamily::pyramidal_a, {6, 6, 3}},
      {SlipFamily::pyramidal_ca, {12, 6, 6}}, {SlipFamily::pyramidal2_ca, {6, 6, 6}}};
  std::map<SlipFamily, std::set<Miller>> planes, directions;
  std::map<SlipFamily, std::size_t> systems;
  std::set<std::string> names;
  for (const Lattice lattice : lattices)
    for (const SlipSystem &s : all_systems(crystal(lattice)))
    {
      ++systems[s.family];
      planes[s.family].insert(without_sense(s.plane_miller));
      directions[s.family].insert(without_sense(s.direction));
      names.insert(name_of(lattice) + s.name + name_of(s.family));
    }
  EXPECT_EQ(systems.size(), known.size());
  for (const auto &[family, count] : known)
  {
    EXPECT_EQ(systems[family], count.systems) << name_of(family);
    EXPECT_EQ(planes[family].size(), count.planes) << name_of(family);
    EXPECT_EQ(directions[family].size(), count.directions) << name_of(family);
  }
  EXPECT_EQ(names.size(), 12u + 48 + 6 + 30);
  EXPECT_EQ(crystal(Lattice::bcc).planes().size(), 42u);
  EXPECT_EQ(crystal(Lattice::hcp).planes().size(), 16u);
}

TEST(SlipFamilies, AreTheOrbitsOfThePointGroup)
{
  for (const Lattice lattice : lattices)
    for (const double c_over_a : {1.5929, 1.6236, 1.886})
    {
      const std::vector<SlipSystem> all = all_systems(crystal(lattice, c_over_a));
      for (std::size_t s = 0; s < all.size(); ++s)
      {
        std::set<std::size_t> orbit, family;
        for (const Mat3 &g : test::point_group(lattice))
        {
          const std::size_t image = index_of(all, g * all[s].normal, g * all[s].burgers);
          ASSERT_LT(image, all.size()) << all[s].name << " has an image that is no slip system";
          orbit.insert(image);
        }
        for (std::size_t t = 0; t < all.size(); ++t)
          if (all[t].family == all[s].family)
            family.insert(t);
        EXPECT_EQ(orbit, family) << all[s].name;
      }
    }
}

TEST(SlipFamilies, BurgersVectorsLieInTheirPlanesAndAreTranslations)
{
  const double c = ratio * a0;
  const std::map<SlipFamily, double> length = {{SlipFamily::fcc_111, a0 / std::sqrt(2.0)},
                                               {SlipFamily::bcc_110, a0 * std::sqrt(3.0) / 2},
                                               {SlipFamily::bcc_112, a0 * std::sqrt(3.0) / 2},
                                               {SlipFamily::bcc_123, a0 * std::sqrt(3.0) / 2},
                                               {SlipFamily::bcc_110_100, a0},
                                               {SlipFamily::prismatic, a0},
                                               {SlipFamily::basal, a0},
                                               {SlipFamily::pyramidal_a, a0},
                                               {SlipFamily::pyramidal_ca, std::sqrt(a0 * a0 + c * c)},
                                               {SlipFamily::pyramidal2_ca, std::sqrt(a0 * a0 + c * c)}};
  for (const Lattice lattice : lattices)
  {
    const SlipSystems systems = crystal(lattice);
    for (const SlipSystem &s : all_systems(systems))
    {
      EXPECT_EQ(dot(s.plane_miller, s.direction), 0) << s.name;
      EXPECT_NEAR(s.burgers.dot(s.normal), 0, 1e-16) << s.name;
      EXPECT_NEAR(s.normal.norm(), 1, 1e-15);
      EXPECT_NEAR(s.burgers.norm(), length.at(s.family), 1e-15) << s.name;
      EXPECT_EQ(systems.family(s.burgers, s.plane), s.family) << s.name;
      const auto type = systems.burgers_type(s.burgers);
      ASSERT_TRUE(type.has_value()) << s.name;
      EXPECT_NE(systems.glissile_types().find(name_of(*type)), std::string::npos) << s.name;
    }
  }
}

TEST(SlipFamilies, HexagonalPlanesEncloseTheirAnglesWithTheBasalPlane)
{
  // tan of the angle to the basal plane: {10-11} 2 r/sqrt(3), {11-22} r, with r = c/a; 90 degrees for {10-10}.
  for (const double r : {1.5929, 1.886})
    for (const SlipSystem &s : crystal(Lattice::hcp, r))
    {
      const double tangent = std::hypot(s.normal[0], s.normal[1]) / std::abs(s.normal[2]);
      if (s.family == SlipFamily::basal)
        EXPECT_EQ(s.normal, Vec3::UnitZ());
      else if (s.family == SlipFamily::prismatic)
        EXPECT_EQ(s.normal[2], 0);
      else
        EXPECT_NEAR(tangent, s.family == SlipFamily::pyramidal2_ca ? r : 2 * r / std::sqrt(3.0), 1e-14) << s.name;
    }
  // Zirconium: 61.5 degrees for {10-11}, 57.9 for {11-22}.
  EXPECT_NEAR(std::atan(2 * ratio / std::sqrt(3.0)) * 180 / std::numbers::pi, 61.5, 0.1);
}

TEST(SlipFamilies, ProvideTheIndependentStrainsOfGrovesAndKelly)
{
  // Groves & Kelly, Phil. Mag. 8 (1963) 877: fcc and bcc 5, basal 2, prismatic 2, both 4, pyramidal <a> 4 and no more
  // with any other <a> slip, <c+a> 5.
  using enum SlipFamily;
  const SlipSystems fcc = crystal(Lattice::fcc), bcc = crystal(Lattice::bcc), hcp = crystal(Lattice::hcp);
  EXPECT_EQ(independent_strains(fcc, {fcc_111}), 5);
  for (const SlipFamily family : {bcc_110, bcc_112, bcc_123})
    EXPECT_EQ(independent_strains(bcc, {family}), 5) << name_of(family);
  EXPECT_EQ(independent_strains(hcp, {basal}), 2);
  EXPECT_EQ(independent_strains(hcp, {prismatic}), 2);
  EXPECT_EQ(independent_strains(hcp, {basal, prismatic}), 4);
  EXPECT_EQ(independent_strains(hcp, {pyramidal_a}), 4);
  EXPECT_EQ(independent_strains(hcp, {basal, prismatic, pyramidal_a}), 4);
  EXPECT_EQ(independent_strains(hcp, {pyramidal_ca}), 5);
  EXPECT_EQ(independent_strains(hcp, {pyramidal2_ca}), 5);
}

TEST(SlipFamilies, SchmidFactorsAlongTheHexagonalAxesAreTheClosedForms)
{
  const SlipSystems systems = crystal(Lattice::hcp);
  const auto largest = [&](const SlipFamily family, const Vec3 &axis)
  {
    double value = 0;
    for (const SlipSystem &s : systems)
      if (s.family == family)
        value = std::max(value, std::abs(s.schmid_factor(axis)));
    return value;
  };
  const Vec3 c = Vec3::UnitZ(), a = Vec3::UnitX(), normal_to_a = Vec3::UnitY();
  for (const SlipFamily family : {SlipFamily::basal, SlipFamily::prismatic, SlipFamily::pyramidal_a})
    EXPECT_NEAR(largest(family, c), 0, 1e-15) << name_of(family); // <a> slip does not extend c
  // b and n of {11-22}<11-23> lie in one plane with c, at tan = 1/r and r from it.
  EXPECT_NEAR(largest(SlipFamily::pyramidal2_ca, c), ratio / (1 + ratio * ratio), 1e-15); // 0.450 for zirconium
  const double t = 2 * ratio / std::sqrt(3.0);
  EXPECT_NEAR(largest(SlipFamily::pyramidal_ca, c), ratio / std::hypot(1, ratio) / std::hypot(1, t), 1e-15); // 0.404
  EXPECT_NEAR(largest(SlipFamily::prismatic, a), std::sqrt(3.0) / 4, 1e-15);
  EXPECT_NEAR(largest(SlipFamily::prismatic, normal_to_a), std::sqrt(3.0) / 4, 1e-15);
  EXPECT_NEAR(largest(SlipFamily::basal, a + c), 0.5, 1e-15);
  const SlipSystems bcc = crystal(Lattice::bcc);
  EXPECT_NEAR(bcc.largest_schmid_factor(Vec3(0, 0, 1)), std::sqrt(2.0) / 3, 1e-15); // {112}, as without {123}
}

TEST(SlipFamilies, BurgersVectorsGlideOnAllTheirPlanesAndSessileOnesOnNone)
{
  const SlipSystems fcc = crystal(Lattice::fcc), bcc = crystal(Lattice::bcc), hcp = crystal(Lattice::hcp);
  const auto n_planes = [](const SlipSystems &systems, const Miller &direction)
  {
    return systems
        .glissile_planes(
            shortest_translation(systems.lattice(), systems.lattice_parameter(), systems.orientation(), direction))
        .size();
  };
  EXPECT_EQ(n_planes(fcc, {1, 1, 0}), 2u);
  EXPECT_EQ(n_planes(fcc, {1, 0, 0}), 0u);
  EXPECT_EQ(n_planes(bcc, {1, 1, 1}), 3u + 3 + 6);
  EXPECT_EQ(n_planes(bcc, {1, 0, 0}), 2u);
  EXPECT_EQ(n_planes(bcc, {1, 1, 0}), 0u);
  EXPECT_EQ(n_planes(hcp, {1, 0, 0}), 1u + 1 + 2);
  EXPECT_EQ(n_planes(hcp, {1, 0, 1}), 2u + 1);
  EXPECT_EQ(n_planes(hcp, {0, 0, 1}), 0u);
}

TEST(SlipFamilies, OrientationAndLatticeMustAgree)
{
  EXPECT_THROW(SlipSystems(Lattice::hcp, a0), std::invalid_argument);
  EXPECT_THROW(SlipSystems(Lattice::fcc, a0, Orientation(UnitCell::hexagonal(1.6))), std::invalid_argument);
  EXPECT_THROW(SlipSystems(Lattice::fcc, a0, {}, {true}), std::invalid_argument);
}

TEST(SlipFamilies, NamesOfHexagonalSystemsHaveFourIndices)
{
  const SlipSystems hcp = crystal(Lattice::hcp);
  for (const char *name : {"(0001)[11-20]", "(0001)[2-1-10]", "(1-100)[11-20]", "(1-101)[11-20]", "(11-2-2)[11-23]"})
    EXPECT_TRUE(hcp.find(name).has_value()) << name;
  EXPECT_EQ(hcp[*hcp.find("(0001)[11-20]")].family, SlipFamily::basal);
}
} // namespace
