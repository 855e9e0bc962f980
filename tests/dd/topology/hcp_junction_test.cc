// Junctions of zirconium: pinned straight lines of 100 nm, 310 b, that cross relax. Which reactions are expected:
// Hirth & Lothe, Theory of Dislocations, 2nd ed. 1982, ch. 22, by Frank's criterion; on which plane the product
// glides: product_plane().
#include "crossing_lines.h"
#include "tests/dd/crystal/point_group.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace ddfem
{
namespace
{
const Material &zirconium = find_material("zirconium");
const SlipSystems hcp = slip_systems_of(zirconium);
constexpr double length = 100;

struct Reaction
{
  const char *first, *second; ///< names of the systems; the product is that of parallel lines that attract
  double gain;                ///< of Frank's criterion, b1^2 + b2^2 - b^2 in a^2
  BurgersType type;
  std::optional<SlipFamily> family; ///< on which the product glides; empty: sessile
};

CrossingPair pair_of(const char *first, const char *second)
{
  return CrossingPair::attractive(hcp[hcp.find(first).value()], hcp[hcp.find(second).value()]);
}

const double c_over_a_squared = *zirconium.c_over_a * *zirconium.c_over_a;

const std::vector<Reaction> reactions{
    // <a> + <a> -> <a>
    {"(10-10)[-12-10]", "(1-100)[11-20]", 1, BurgersType::a, SlipFamily::prismatic},
    {"(10-10)[-12-10]", "(0001)[2-1-10]", 1, BurgersType::a, SlipFamily::basal},
    {"(10-10)[-12-10]", "(1-10-1)[11-20]", 1, BurgersType::a, SlipFamily::pyramidal_a},
    {"(0001)[2-1-10]", "(10-1-1)[-12-10]", 1, BurgersType::a, SlipFamily::basal},
    // <c+a> + <a> -> <c>
    {"(10-10)[-12-10]", "(1-10-1)[-12-1-3]", 2, BurgersType::c, {}},
    {"(0001)[2-1-10]", "(10-1-1)[2-1-13]", 2, BurgersType::c, {}},
    // <c+a> + <a> -> <c+a>
    {"(10-10)[-12-10]", "(10-1-1)[2-1-13]", 1, BurgersType::c_plus_a, SlipFamily::pyramidal_ca},
    {"(0001)[2-1-10]", "(01-1-1)[-12-13]", 1, BurgersType::c_plus_a, SlipFamily::pyramidal_ca},
    {"(0001)[2-1-10]", "(10-1-1)[11-23]", 1, BurgersType::c_plus_a, {}},
    // <c+a> + <c+a> -> <a>
    {"(10-1-1)[2-1-13]", "(1-10-1)[-12-1-3]", 1 + 2 * c_over_a_squared, BurgersType::a, SlipFamily::pyramidal_a},
};

class HcpJunction : public testing::TestWithParam<Reaction>
{
};

TEST_P(HcpJunction, HasTheExpectedProductAndTheLengthOfLeastEnergy)
{
  const Reaction &r = GetParam();
  const CrossingPair p = pair_of(r.first, r.second);
  const Vec3 b = p.product();
  const double a = zirconium.lattice_parameter;
  EXPECT_EQ(hcp.burgers_type(b), r.type);
  EXPECT_NEAR(-p.energy_change(), r.gain * a * a, 1e-12);
  const auto plane = product_plane(hcp, p.e, b);
  ASSERT_EQ(plane.has_value(), r.family.has_value());
  if (plane)
  {
    EXPECT_EQ(hcp.family(b, *plane), r.family);
  }

  CrossingLines c(zirconium, hcp, length, p.at(15, -15));
  c.relax_to_rest();
  expect_sound(c, {*hcp.burgers_type(p.system[0].burgers), *hcp.burgers_type(p.system[1].burgers), r.type});
  expect_junction(c, b, plane);
  const double least = junction_length_of_least_energy(c.settings.medium, p, p.at(15, -15), length);
  EXPECT_NEAR(c.length_with(b), least, open_end_tolerance * least);
}

INSTANTIATE_TEST_SUITE_P(Reactions, HcpJunction, testing::ValuesIn(reactions),
                         [](const auto &parameter) { return std::to_string(parameter.index); });

TEST(HcpJunctions, LinesOfTheSameBurgersVectorOnTwoPlanesAnnihilate)
{
  for (const auto &[first, second] :
       {std::array{"(10-10)[-12-10]", "(0001)[-12-10]"}, std::array{"(10-10)[-12-10]", "(10-1-1)[-12-10]"},
        std::array{"(10-1-1)[2-1-13]", "(2-1-1-2)[2-1-13]"}})
  {
    const CrossingPair p = pair_of(first, second);
    EXPECT_EQ(p.product().norm(), 0);
    for (const double degrees : {15.0, 30.0})
    {
      CrossingLines c(zirconium, hcp, length, p.at(degrees, -degrees));
      c.relax_to_rest();
      expect_sound(c, {*hcp.burgers_type(p.system[0].burgers)});
      expect_annihilated(c);
      const double shortest = shortest_way_to_intersection(degrees, length);
      EXPECT_NEAR(c.length_with(p.system[0].burgers), shortest, 0.02 * shortest);
    }
  }
}

/// The pair with the sense of the second Burgers vector reversed.
CrossingPair repulsive(const char *first, const char *second)
{
  CrossingPair p = pair_of(first, second);
  p.sign[1] = -p.sign[1];
  return p;
}

TEST(HcpJunctions, LinesThatRepelDoNotReact)
{
  // Parallel <a> at 60 degrees: |a1 + a2|^2 = 3 > 1 + 1.
  for (const auto &p : {repulsive("(10-10)[-12-10]", "(1-100)[11-20]"), repulsive("(10-10)[-12-10]", "(0001)[2-1-10]")})
    for (const double degrees : {10.0, 20.0})
    {
      EXPECT_NEAR(p.product().squaredNorm(), 3 * std::pow(zirconium.lattice_parameter, 2), 1e-12);
      CrossingLines c(zirconium, hcp, length, p.at(degrees, -degrees));
      c.relax_to_rest();
      expect_sound(c, {BurgersType::a});
      expect_separate_lines(c);
    }
}

TEST(HcpJunctions, LinesThatRepelWhenParallelMayCrossButMakeNoJunction)
{
  // <a> and <c+a> with b1 . b2 > 0: at 30 degrees and more the crossing point attracts, and the lines stay crossed.
  const CrossingPair p = repulsive("(0001)[2-1-10]", "(10-1-1)[2-1-13]");
  EXPECT_GT(p.energy_change(), 0);
  for (const double degrees : {15.0, 30.0})
  {
    CrossingLines c(zirconium, hcp, length, p.at(degrees, -degrees));
    c.relax_to_rest();
    expect_sound(c, {BurgersType::a, BurgersType::c_plus_a});
    EXPECT_EQ(c.nodes_with_degree(3), 0U);
    EXPECT_EQ(c.nodes_with_degree(4), 1U);
  }
}

TEST(HcpJunctions, CrystallographicImagesOfLinesReactToTheImageOfTheJunction)
{
  const CrossingPair p = pair_of("(10-10)[-12-10]", "(1-10-1)[-12-1-3]");
  const auto lines = p.at(15, -25);
  CrossingLines c(zirconium, hcp, length, lines);
  c.relax_to_rest();
  ASSERT_GT(c.length_with(p.product()), 40);
  const auto group = test::point_group(Lattice::hcp);
  for (std::size_t k = 1; k < group.size(); k += 4)
  {
    const Mat3 &g = group[k];
    CrossingLines image(zirconium, hcp, length, {image_of(lines[0], hcp, g), image_of(lines[1], hcp, g)});
    image.relax_to_rest();
    // The same operations in the same order: only rounding, which the motion to rest does not amplify.
    EXPECT_LT(largest_deviation(c, image, g), 1e-9) << g;
  }
}
} // namespace
} // namespace ddfem
