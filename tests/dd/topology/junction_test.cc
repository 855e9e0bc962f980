// Junctions of fcc: two pinned straight lines of 200 nm that cross at their mid-points relax. Classes of reaction and
// what is expected of them: Madec, Devincre & Kubin, Phys. Rev. Lett. 89 (2002) 255508; Wickham, Schwarz & Stoelken,
// Phys. Rev. Lett. 83 (1999) 4574.
#include "dd/crystal/material.h"
#include "dd/microstructure/sources.h"
#include "samples/dislocation_driver.h"

#include <gtest/gtest.h>

#include <numbers>
#include <set>
#include <string>
#include <vector>

namespace ddfem
{
namespace
{
const Material &aluminium = find_material("aluminium");
const SlipSystems fcc(Lattice::fcc, aluminium.lattice_parameter);
constexpr double length = 200;

DriverSettings coarse()
{
  const double b = aluminium.burgers_magnitude;
  return {{aluminium.mu, aluminium.nu, b},
          b,
          linear_glide(aluminium.drag, aluminium.drag),
          {8, 20, 0.1, 1},
          {0.1, 2, 0.2, 1e-4, 30}};
}

/// Two crossing lines, the second with its Burgers vector times @p sign.
class Pair : public DislocationDriver
{
public:
  Pair(const char *first, const char *second, const double sign, const double angle1, const double angle2)
      : DislocationDriver(coarse(), fcc), systems{fcc[*fcc.find(first)], fcc[*fcc.find(second)]},
        b{systems[0].burgers, sign * systems[1].burgers}
  {
    e = systems[0].normal.cross(systems[1].normal);
    e = e.norm() > 1e-6 ? Vec3(e.normalized()) : Vec3(systems[0].burgers.normalized());
    const std::array<double, 2> angles{angle1, angle2};
    for (std::size_t k = 0; k < 2; ++k)
    {
      const SlipSystem &s = systems[k];
      const PlaneIndex p = network.planes().find_or_insert(s.plane_miller, s.normal, Vec3(Vec3::Zero()));
      const double phi = angles[k] * std::numbers::pi / 180;
      const Vec3 t = std::cos(phi) * e + std::sin(phi) * s.normal.cross(e);
      const Vec3 gap = k == 0 ? Vec3(Vec3::Zero()) : Vec3(0.5 * s.normal.cross(t));
      std::vector<Vec3> points;
      for (int m = 0; m <= 14; ++m)
        points.push_back(network.planes().project(p, gap + (m / 14.0 - 0.5) * length * t));
      const auto nodes = add_line(network, points, b[k], p, false, NodeConstraint::pinned);
      ends.push_back({nodes.front(), nodes.back()});
    }
  }

  void relax_to_rest() { relax(0.3, 1); }

  Vec3 product() const { return b[0] + b[1]; }

  /// Length of all segments with the Burgers vector of the product, either sense.
  double product_length() const
  {
    double l = 0;
    for (const SegmentIndex s : network.segments())
      if (is_product(s))
        l += network.length(s);
    return l;
  }

  bool is_product(const SegmentIndex s) const
  {
    const Vec3 &q = network.burgers(s);
    return (q - product()).norm() < 1e-6 || (q + product()).norm() < 1e-6;
  }

  std::array<SlipSystem, 2> systems;
  std::array<Vec3, 2> b;
  Vec3 e; ///< unit vector along both planes
  std::vector<std::array<NodeIndex, 2>> ends;
};

/// One junction between two nodes of three arms; all of it along the common line of the planes if @p straight.
void expect_junction(const Pair &p, const bool straight)
{
  EXPECT_EQ(p.nodes_with_degree(3), 2U);
  EXPECT_EQ(p.nodes_with_degree(4), 0U);
  for (const SegmentIndex s : p.network.segments())
    if (straight && p.is_product(s))
    {
      EXPECT_LT(p.network.direction(s).cross(p.e).norm(), 1e-6 * p.network.length(s));
    }
}

TEST(Junctions, LomerIsSessileAlongTheIntersectionOfThePlanes)
{
  Pair p("B4", "C1", -1, 30, -30);
  p.relax_to_rest();
  p.network.check_invariants(1e-5);
  expect_junction(p, true);
  EXPECT_NEAR(p.product().dot(p.e), 0, 1e-12); // pure edge
  EXPECT_NEAR(p.product().norm(), aluminium.burgers_magnitude, 1e-12);
  for (const SegmentIndex s : p.network.segments())
    EXPECT_EQ(p.is_product(s), !p.network.plane(s).is_valid());
  // The independent quasi-static solution of examples/lomer_cottrell_lock is 96.86 nm.
  EXPECT_NEAR(p.product_length(), 96.86, 0.01 * 96.86);
}

TEST(Junctions, GlissileIsOnOneOfTheTwoPlanesAndMovesUnderStress)
{
  Pair p("B4", "C5", -1, 30, -30);
  p.relax_to_rest();
  p.network.check_invariants(1e-5);
  expect_junction(p, false);
  EXPECT_GT(p.product_length(), 40);
  const Vec3 n = p.systems[0].normal; // B holds the product b = [0-11], C does not
  EXPECT_NEAR(n.dot(p.product()), 0, 1e-12);
  for (const SegmentIndex s : p.network.segments())
    if (p.is_product(s))
    {
      ASSERT_TRUE(p.network.plane(s).is_valid());
      EXPECT_LT(p.network.normal(s).cross(n).norm(), 1e-12);
    }
  const auto bow = [&]
  {
    double largest = 0;
    for (const NodeIndex i : p.network.nodes())
      if (p.network.degree(i) == 2 && p.is_product(p.network.connected_segments(i)[0]))
        largest = std::max(largest, p.network.position(i).cross(p.e).norm());
    return largest;
  };
  EXPECT_GT(bow(), 0);
  const double before = bow();
  p.applied = 100 * symmetric_part(p.product().normalized() * n.transpose()) * 2;
  p.relax(0.1, 1);
  EXPECT_GT(std::abs(bow() - before), 1);
}

TEST(Junctions, CollinearLinesAnnihilateAndLeaveTwoBentLines)
{
  Pair p("B4", "D4", -1, 30, 30);
  EXPECT_NEAR(p.product().norm(), 0, 1e-12);
  p.relax_to_rest();
  p.network.check_invariants(1e-5);
  EXPECT_EQ(p.nodes_with_degree(3) + p.nodes_with_degree(4), 0U);
  // Each new line joins an end of one old line to an end of the other, and changes its plane where it bends, on e.
  for (const auto &line : p.ends)
    for (const NodeIndex i : line)
    {
      const ObjectId far = p.other_end_of_line(i);
      const auto &other = p.ends[&line == &p.ends[0] ? 1 : 0];
      EXPECT_TRUE(far == p.network.id(other[0]) || far == p.network.id(other[1]));
    }
  double total = 0;
  for (const SegmentIndex s : p.network.segments())
    total += p.network.length(s);
  // Left of 400 nm: the shortest way from each of the four ends to e, L/2 sin(30 deg), were the line tension
  // isotropic.
  EXPECT_NEAR(total, length, 0.02 * length);
}

TEST(Junctions, CoplanarProductStaysInThePlaneAndGlides)
{
  Pair p("B4", "B2", -1, 15, -15);
  p.relax_to_rest();
  p.network.check_invariants(1e-5);
  expect_junction(p, false);
  EXPECT_GT(p.product_length(), 0.5 * length);
  for (const SegmentIndex s : p.network.segments())
  {
    ASSERT_TRUE(p.network.plane(s).is_valid());
    EXPECT_LT(p.network.normal(s).cross(p.systems[0].normal).norm(), 1e-12);
  }
}

TEST(Junctions, HirthIsWeakerThanLomer)
{
  // b = a[001], pure edge; |b|^2 is the sum of those of the two lines, so that nothing is gained but by the angles.
  const auto product_length = [](const char *second, const double sign, const double angle)
  {
    Pair p("B4", second, sign, angle, -angle);
    p.relax_to_rest();
    p.network.check_invariants(1e-5);
    return p.product_length();
  };
  EXPECT_GT(product_length("C3", 1, 0), 0.5 * length);
  EXPECT_EQ(product_length("C3", 1, 20), 0); // crossed, or apart
  EXPECT_GT(product_length("C1", -1, 20), 0.5 * length);
}

TEST(Junctions, LomerDissolvesUnderStressAndTheLinesRecover)
{
  Pair p("B4", "C1", -1, 30, -30);
  p.relax_to_rest();
  ASSERT_GT(p.product_length(), 90);
  p.applied = 400 * (p.systems[0].schmid_tensor() + 0.5 * p.systems[1].schmid_tensor());
  for (int k = 0; k < 2000 && p.nodes_with_degree(3) > 0; ++k)
    p.step(0.01);
  EXPECT_EQ(p.product_length(), 0);
  p.network.check_invariants(1e-5);
  for (std::size_t k = 0; k < 2; ++k)
  {
    EXPECT_EQ(p.other_end_of_line(p.ends[k][0]), p.network.id(p.ends[k][1]));
    const SegmentIndex s = p.network.connected_segments(p.ends[k][0])[0];
    EXPECT_LT((p.network.burgers_from(s, p.ends[k][0]) - p.b[k]).norm(), 1e-12);
    EXPECT_LT(p.network.normal(s).cross(p.systems[k].normal).norm(), 1e-12);
  }
}

TEST(Junctions, LomerPairsReactAtAttractiveAnglesOnly)
{
  // The full map, with the orientation-dependent line tension of Dupuy & Fivel, Acta Mater. 50 (2002) 4873, is in
  // docs/validation.md.
  Pair attractive("B4", "C1", -1, 45, 15), repulsive("B4", "C1", -1, 75, -60);
  attractive.relax_to_rest();
  repulsive.relax_to_rest();
  EXPECT_GT(attractive.product_length(), 40);
  EXPECT_EQ(repulsive.product_length(), 0);
}
} // namespace
} // namespace ddfem
