#include "dd/microstructure/sources.h"
#include "dd/mobility/glide_constraints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

namespace
{
using namespace ddfem;

constexpr double a0 = 0.32316, ratio = 1.5929;

SlipSystems zirconium()
{
  const UnitCell cell = UnitCell::hexagonal(ratio);
  return {Lattice::hcp, a0, Orientation::from_axes(SampleAxis::z, {1, 0, 1}, SampleAxis::x, {1, 2, 0}, cell)};
}

Vec3 burgers(const SlipSystems &systems, const Miller &direction)
{
  return shortest_translation(systems.lattice(), systems.lattice_parameter(), systems.orientation(), direction);
}

/// The irradiation loop of zirconium: b = <a> normal to its habit plane {11-20}.
PolygonLoop a_loop(const SlipSystems &systems, const unsigned corners)
{
  return {{1, 1, 0}, burgers(systems, {1, 1, 0}), Vec3(100, -50, 30), 40, corners};
}

/// Twice the area vector of a closed chain of segments.
Vec3 doubled_area(const Network &network)
{
  Vec3 sum = Vec3::Zero();
  for (const SegmentIndex s : network.segments())
    sum += network.position(network.start(s)).cross(network.position(network.end(s)));
  return sum;
}

std::set<SlipFamily> families_of_sides(const Network &network, const SlipSystems &systems)
{
  std::set<SlipFamily> families;
  for (const SegmentIndex s : network.segments())
    if (network.plane(s).is_valid())
      families.insert(systems[systems.find(network.burgers(s), network.normal(s))->system].family);
  return families;
}

TEST(Loops, PrismaticLoopOfZirconiumHasBasalPrismaticAndPyramidalSides)
{
  const SlipSystems systems = zirconium();
  Network network;
  const PolygonLoop loop = a_loop(systems, 0);
  add_polygon_loop(network, systems, loop, 1000);
  EXPECT_EQ(network.n_segments(), 8u);
  EXPECT_TRUE(network.violations().empty());
  EXPECT_EQ(families_of_sides(network, systems),
            (std::set<SlipFamily>{SlipFamily::basal, SlipFamily::prismatic, SlipFamily::pyramidal_a}));
  for (const SegmentIndex s : network.segments())
  {
    ASSERT_TRUE(network.plane(s).is_valid());
    EXPECT_FALSE(is_zero(network.planes()[network.plane(s)].miller));
    EXPECT_NEAR(std::abs(network.planes().distance(network.plane(s), loop.centre)), loop.radius, 1e-9);
  }
  EXPECT_GT(doubled_area(network).dot(systems.orientation().plane_normal(loop.plane)), 0); // counter-clockwise
}

TEST(Loops, CornersOfALoopOnSlipPlanesGlideAlongTheBurgersVectorOnly)
{
  const SlipSystems systems = zirconium();
  Network network;
  const PolygonLoop loop = a_loop(systems, 0);
  add_polygon_loop(network, systems, loop, 10);
  EXPECT_GT(network.n_segments(), 24u);
  EXPECT_TRUE(network.violations().empty());
  const Vec3 e = loop.burgers.normalized();
  int corners = 0;
  for (const NodeIndex i : network.nodes())
  {
    const Mat3 projector = glide_projector(network, i, nullptr);
    EXPECT_LT((projector * e - e).norm(), 1e-9);
    if (std::abs(projector.trace() - 1) < 1e-9)
      ++corners;
    else
      EXPECT_NEAR(projector.trace(), 2, 1e-9);
  }
  EXPECT_EQ(corners, 8);
}

TEST(Loops, SidesThatLieOnNoSlipPlaneAreSessile)
{
  const SlipSystems systems = zirconium();
  Network network;
  add_polygon_loop(network, systems, a_loop(systems, 12), 1000);
  EXPECT_EQ(network.n_segments(), 12u);
  EXPECT_TRUE(network.violations().empty());
  int sessile = 0;
  for (const SegmentIndex s : network.segments())
    sessile += network.plane(s).is_valid() ? 0 : 1;
  EXPECT_EQ(sessile, 12);
}

TEST(Loops, SideOfARegularPolygonGlidesIfItLiesOnASlipPlaneExactly)
{
  // In (11-20) the traces of the {10-11} planes of a enclose atan(2 r/sqrt(3)) with the basal plane, two pairs of sides
  // of a regular octagon 67.5 degrees.
  const double octagonal = std::sqrt(3.0) / 2 * std::tan(67.5 * std::numbers::pi / 180);
  for (const auto &[c_over_a, glissile] : {std::pair{octagonal, 4}, {octagonal * (1 + 1.4e-4), 0}}) // 5e-5 rad
  {
    const SlipSystems systems(Lattice::hcp, a0, Orientation(UnitCell::hexagonal(c_over_a)));
    Network network;
    add_polygon_loop(network, systems, a_loop(systems, 8), 1000);
    EXPECT_TRUE(network.violations().empty());
    int n = 0;
    for (const SegmentIndex s : network.segments())
      n += network.plane(s).is_valid() ? 1 : 0;
    EXPECT_EQ(n, glissile);
  }
}

TEST(Loops, CubicPrismaticLoopsOnSlipPlanes)
{
  const SlipSystems fcc(Lattice::fcc, 0.4), bcc(Lattice::bcc, 0.3);
  struct Case
  {
    const SlipSystems &systems;
    Miller habit, b;
    std::size_t sides;
  };
  // fcc: two {111}. bcc a/2<111>: three {110} and three {112}; a<100>: two {011}.
  for (const Case &c : {Case{fcc, {1, 1, 0}, {1, 1, 0}, 4}, Case{bcc, {1, 1, 1}, {1, 1, 1}, 12},
                        Case{bcc, {1, 0, 0}, {1, 0, 0}, 4}, Case{bcc, {1, 1, 0}, {1, 1, 1}, 12}})
  {
    Network network;
    add_polygon_loop(network, c.systems, {c.habit, burgers(c.systems, c.b), Vec3(1, 2, 3), 30, 0}, 1000);
    EXPECT_EQ(network.n_segments(), c.sides) << to_string(c.b);
    EXPECT_TRUE(network.violations().empty());
    for (const SegmentIndex s : network.segments())
      EXPECT_TRUE(network.plane(s).is_valid());
    EXPECT_GT(doubled_area(network).dot(to_vector(c.habit)), 0);
  }
}

TEST(Loops, GlideLoopLiesInItsPlane)
{
  const SlipSystems systems = zirconium();
  for (const Miller &plane : {Miller{0, 0, 1}, Miller{1, -1, 0}, Miller{1, -1, 1}})
  {
    Network network;
    add_polygon_loop(network, systems, {plane, burgers(systems, {1, 1, 0}), Vec3(1, 2, 3), 30, 16}, 10);
    EXPECT_TRUE(network.violations().empty());
    for (const SegmentIndex s : network.segments())
      EXPECT_EQ(without_sense(network.planes()[network.plane(s)].miller), without_sense(plane));
  }
}

TEST(Loops, ImpossibleOnesAreRefused)
{
  const SlipSystems systems = zirconium();
  Network network;
  const Vec3 a = burgers(systems, {1, 1, 0}), c = burgers(systems, {0, 0, 1});
  const auto add = [&](const Miller &plane, const Vec3 &b, const double radius, const unsigned corners) {
    add_polygon_loop(network, systems, {plane, b, Vec3::Zero(), radius, corners}, 10);
  };
  EXPECT_THROW(add({1, 1, 0}, a, 30, 2), std::invalid_argument);
  EXPECT_THROW(add({0, 0, 1}, a, 30, 0), std::invalid_argument); // b in the plane: no traces
  EXPECT_THROW(add({0, 0, 1}, c, 30, 0), std::invalid_argument); // <c> has no glide planes
  EXPECT_THROW(add({1, 1, 0}, a, 0, 8), std::invalid_argument);
  EXPECT_EQ(network.n_nodes(), 0u);
}

TEST(Sources, LieOnPlanesOfAHexagonalCrystal)
{
  const SlipSystems systems = zirconium();
  for (const SlipSystem &s : systems)
  {
    Network network;
    add_frank_read_source(network, systems.orientation(), {s.plane_miller, s.burgers, Vec3(5, 6, 7), 100, 30}, 20);
    EXPECT_TRUE(network.violations().empty()) << s.name;
    for (const SegmentIndex segment : network.segments())
    {
      EXPECT_LT(network.normal(segment).cross(s.normal).norm(), 1e-15) << s.name;
      const double cosine = network.direction(segment).normalized().dot(s.burgers.normalized());
      EXPECT_NEAR(cosine, std::cos(std::numbers::pi / 6), 1e-12) << s.name;
    }
  }
}
} // namespace
