// Junctions of bcc iron: pinned straight lines of 100 nm, 400 b, that cross relax. Reactions: Hirth & Lothe, Theory of
// Dislocations, 2nd ed. 1982, ch. 22; Madec & Kubin, Scripta Mater. 58 (2008) 767; Queyreau, Monnet & Devincre,
// Int. J. Plast. 25 (2009) 361; with three lines: Bulatov et al., Nature 440 (2006) 1174.
#include "crossing_lines.h"
#include "tests/dd/crystal/point_group.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace ddfem
{
namespace
{
const Material &iron = find_material("iron");
const SlipSystems bcc = slip_systems_of(iron);
constexpr double length = 100;
const std::vector<BurgersType> half_111_and_100{BurgersType::half_111, BurgersType::full_100};

/// a/2[111] in (10-1) and a/2[1-1-1] in @p second_plane: along parallel line senses they make a[100].
CrossingPair pair_of(const Miller &second_plane)
{
  return CrossingPair::attractive(system_of(bcc, {1, 0, -1}, {1, 1, 1}), system_of(bcc, second_plane, {1, -1, -1}));
}
CrossingPair glissile()
{
  return pair_of({1, 1, 0}); // meets (10-1) along [1-11], which spans (011) with [100]
}
CrossingPair sessile()
{
  return pair_of({1, 0, 1}); // meets (10-1) along [010], which spans (001) with [100]
}

void expect_cube_junction(const CrossingPair &pair, const double degrees)
{
  CrossingLines c(iron, bcc, length, pair.at(degrees, -degrees));
  c.relax_to_rest();
  const Vec3 b = pair.product();
  EXPECT_NEAR(b.squaredNorm(), iron.lattice_parameter * iron.lattice_parameter, 1e-12); // 3/4 + 3/4 -> 1
  expect_sound(c, half_111_and_100);
  expect_junction(c, b, product_plane(bcc, pair.e, b));
  const double least = junction_length_of_least_energy(c.settings.medium, pair, pair.at(degrees, -degrees), length);
  EXPECT_NEAR(c.length_with(b), least, open_end_tolerance * least) << degrees;
}

TEST(BccJunctions, BurgersVectorsOfTwoLinesAddUpToACubeVectorWhereTheSensesAgree)
{
  const CrossingPair p = glissile();
  EXPECT_LT((p.product() - iron.lattice_parameter * Vec3::UnitX()).norm(), 1e-12);
  EXPECT_LT((sessile().product() - iron.lattice_parameter * Vec3::UnitX()).norm(), 1e-12);
  EXPECT_NEAR(p.energy_change(), -0.5 * iron.lattice_parameter * iron.lattice_parameter, 1e-12);
}

TEST(BccJunctions, CubeJunctionAlongABodyDiagonalGlidesAndHasTheLengthOfLeastEnergy)
{
  const CrossingPair p = glissile();
  const auto plane = product_plane(bcc, p.e, p.product());
  ASSERT_TRUE(plane.has_value());
  EXPECT_EQ(bcc.planes()[*plane].miller, (Miller{0, 1, 1}));
  for (const double degrees : {15.0, 30.0})
    expect_cube_junction(p, degrees);
}

TEST(BccJunctions, CubeJunctionAlongACubeAxisIsSessileAndHasTheLengthOfLeastEnergy)
{
  const CrossingPair p = sessile();
  EXPECT_FALSE(product_plane(bcc, p.e, p.product()).has_value());
  for (const double degrees : {15.0, 30.0})
    expect_cube_junction(p, degrees);
}

TEST(BccJunctions, SessileJunctionIsStraightAlongTheIntersectionOfThePlanes)
{
  const CrossingPair p = sessile();
  CrossingLines c(iron, bcc, length, p.at(20, -20));
  c.relax_to_rest();
  ASSERT_GT(c.length_with(p.product()), 30);
  for (const SegmentIndex s : c.segments_with(p.product()))
  {
    EXPECT_LT(c.network.direction(s).cross(p.e).norm(), 1e-6 * c.network.length(s));
    EXPECT_LT(c.network.position(c.network.start(s)).cross(p.e).norm(), 1e-5); // the planes meet at the origin
  }
}

TEST(BccJunctions, GlissileJunctionBowsUnderStressAndTheSessileOneDoesNot)
{
  for (const CrossingPair &p : {glissile(), sessile()})
  {
    CrossingLines c(iron, bcc, length, p.at(15, -15));
    c.relax_to_rest();
    const Vec3 b = p.product();
    const auto offset = [&]
    {
      double largest = 0;
      for (const SegmentIndex s : c.segments_with(b))
        largest = std::max(largest, c.network.position(c.network.start(s)).cross(p.e).norm());
      return largest;
    };
    const double before = offset();
    const Vec3 n = p.e.cross(b).normalized();
    c.applied = 300 * 2 * symmetric_part(b.normalized() * n.transpose()); // 300 MPa on the plane of b and e
    c.relax(0.05, 1);
    expect_sound(c, half_111_and_100);
    if (product_plane(bcc, p.e, b))
    {
      EXPECT_GT(offset(), before + 1);
    }
    else
    {
      EXPECT_LT(offset(), 1e-5);
    }
  }
}

TEST(BccJunctions, LinesThatRepelDoNotReact)
{
  // a/2[111] - a/2[1-1-1] = a[011]: 2 > 3/4 + 3/4.
  const auto [first, second] = sessile().system;
  const CrossingPair p(first, second, 1, -1);
  EXPECT_NEAR(p.energy_change(), 0.5 * iron.lattice_parameter * iron.lattice_parameter, 1e-12);
  for (const double degrees : {15.0, 30.0})
    for (const double push : {0.0, 300.0}) // MPa, on the second line towards the first
    {
      CrossingLines c(iron, bcc, length, p.at(degrees, -degrees, push > 0 ? 4 : 0.5));
      c.applied = push * second.schmid_tensor();
      c.relax_to_rest();
      expect_sound(c, {BurgersType::half_111});
      expect_separate_lines(c);
      EXPECT_EQ(c.counts.collisions, 0U);
      if (push > 0) // the first line gives way
      {
        EXPECT_GT(c.length_with(c.lines[0].burgers), 1.08 * length);
      }
    }
}

TEST(BccJunctions, LinesOfTheSameBurgersVectorOnPlanesOfItsZoneAnnihilate)
{
  const SlipSystem &first = system_of(bcc, {1, 0, -1}, {1, 1, 1});
  for (const Miller &plane : {Miller{1, -1, 0}, Miller{1, 1, -2}, Miller{2, -1, -1}})
    for (const double degrees :
         {15.0, 30.0}) // small angles: segments fall on each other; large ones: the crossing splits
    {
      const CrossingPair p = CrossingPair::attractive(first, system_of(bcc, plane, {1, 1, 1}));
      EXPECT_EQ(p.product().norm(), 0);
      CrossingLines c(iron, bcc, length, p.at(degrees, -degrees));
      c.relax_to_rest();
      expect_sound(c, {BurgersType::half_111});
      expect_annihilated(c);
      const double shortest = shortest_way_to_intersection(degrees, length);
      EXPECT_NEAR(c.length_with(first.burgers), shortest, 0.02 * shortest);
    }
}

TEST(BccJunctions, DissolveUnderStressAndTheLinesRecoverTheirBurgersVectorsAndPlanes)
{
  for (const CrossingPair &p : {glissile(), sessile()})
  {
    CrossingLines c(iron, bcc, length, p.at(30, -30));
    c.relax_to_rest();
    ASSERT_GT(c.length_with(p.product()), 20);
    c.applied = 800 * (p.sign[0] * p.system[0].schmid_tensor() + 0.5 * p.sign[1] * p.system[1].schmid_tensor());
    for (int k = 0; k < 500 && c.nodes_with_degree(3) + c.nodes_with_degree(4) > 0; ++k)
      c.step(0.01);
    EXPECT_EQ(c.length_with(p.product()), 0);
    expect_sound(c, {BurgersType::half_111});
    expect_separate_lines(c);
    EXPECT_EQ(c.counts.annihilations,
              0U); // they let go of each other where they cross, none is pinched off around the other
  }
}

/// a/2[-111] in (01-1), a/2[1-11] in (10-1), a/2[11-1] in (1-10): all three planes hold e = [111], and all four <111>
/// balance: b1 + b2 + b3 = a/2[111].
std::vector<CrossingLine> three_lines(const std::array<double, 3> &degrees, const std::array<double, 3> &gaps)
{
  const Vec3 e = Vec3(1, 1, 1).normalized();
  const std::array<Miller, 3> planes{{{0, 1, -1}, {1, 0, -1}, {1, -1, 0}}},
      directions{{{-1, 1, 1}, {1, -1, 1}, {1, 1, -1}}};
  std::vector<CrossingLine> lines;
  for (std::size_t k = 0; k < 3; ++k)
  {
    const SlipSystem &s = system_of(bcc, planes[k], directions[k]);
    lines.push_back(line_at(s, s.burgers.dot(to_vector(directions[k])) > 0 ? 1 : -1, e, degrees[k], gaps[k]));
  }
  return lines;
}
const Vec3 sum_of_three = 0.5 * iron.lattice_parameter * Vec3(1, 1, 1);

void expect_all_body_diagonals(const CrossingLines &c, const NodeIndex i)
{
  const auto arms = c.network.connected_segments(i);
  for (const Vec3 &b : {sum_of_three, c.lines[0].burgers, c.lines[1].burgers, c.lines[2].burgers})
    EXPECT_EQ(std::count_if(arms.begin(), arms.end(), [&](const SegmentIndex s) { return c.carries(s, b); }), 1);
}

TEST(BccJunctions, ThreeLinesMakeAJunctionOfTheFourthBodyDiagonalBetweenTwoMultiNodes)
{
  CrossingLines c(iron, bcc, length, three_lines({20, 20, -20}, {0, 0.5, -0.5}));
  c.relax_to_rest();
  expect_sound(c, half_111_and_100);
  EXPECT_GT(c.length_with(sum_of_three), 0.5 * length);
  EXPECT_EQ(c.nodes_with_degree(3), 0U);
  ASSERT_EQ(c.nodes_with_degree(4), 2U);
  for (const NodeIndex i : c.network.nodes())
    if (c.network.degree(i) == 4)
      expect_all_body_diagonals(c, i);
}

TEST(BccJunctions, ThirdLineTurnsACubeJunctionIntoTheFourthBodyDiagonal)
{
  const auto lines = three_lines({15, -15, 0}, {0, 0.5, 4});
  const Vec3 cube = lines[0].burgers + lines[1].burgers; // a[001], on the plane of the third line
  CrossingLines c(iron, bcc, length, {lines[0], lines[1]});
  c.relax_to_rest();
  expect_junction(c, cube, lines[2].system.plane);
  const double before = c.length_with(cube);
  ASSERT_GT(before, 0.6 * length);
  EXPECT_EQ(c.length_with(sum_of_three), 0);
  // a[001] + a/2[11-1] -> a/2[111]: 1 + 3/4 -> 3/4. The junction attracts the third line, which was straight and 4 nm
  // away.
  c.add(lines[2]);
  c.relax_to_rest();
  expect_sound(c, half_111_and_100);
  EXPECT_LT(c.length_with(cube), 0.15 * before);
  EXPECT_GT(c.length_with(sum_of_three), 0.8 * length);
}

TEST(BccJunctions, CrystallographicImagesOfLinesReactToTheImageOfTheJunction)
{
  const CrossingPair p = glissile();
  const auto lines = p.at(20, -35);
  CrossingLines c(iron, bcc, length, lines);
  c.relax_to_rest();
  ASSERT_GT(c.length_with(p.product()), 40);
  const auto group = test::point_group(Lattice::bcc);
  for (std::size_t k = 1; k < group.size(); k += 6)
  {
    const Mat3 &g = group[k];
    CrossingLines image(iron, bcc, length, {image_of(lines[0], bcc, g), image_of(lines[1], bcc, g)});
    image.relax_to_rest();
    // The same operations in the same order: only rounding, 1e-12 nm measured, and the motion to rest does not amplify
    // it.
    EXPECT_LT(largest_deviation(c, image, g), 1e-9) << g;
  }
}
} // namespace
} // namespace ddfem
