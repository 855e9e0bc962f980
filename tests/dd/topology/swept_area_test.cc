#include "dd/topology/growth.h"
#include "dd/topology/line_operations.h"
#include "dd/topology/motion.h"
#include "dd/topology/remesh.h"
#include "topology_fixture.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace ddfem
{
namespace
{
const Vec3 b(0.25, 0, 0);

std::vector<Vec3> polygon(const double radius, const int corners)
{
  std::vector<Vec3> points;
  for (int k = 0; k < corners; ++k)
    points.emplace_back(radius * std::cos(2 * M_PI * k / corners), radius * std::sin(2 * M_PI * k / corners), 0);
  return points;
}

TEST(SweptArea, GrowingLoopSweepsTheDifferenceOfItsAreas)
{
  TopologyFixture f;
  const auto nodes = add_line(f.network, polygon(50, 24), b, f.horizontal(), true, NodeConstraint::free);
  auto c = f.context();
  for (const NodeIndex i : nodes)
    c.remaining[i.value] = 0.2 * f.network.position(i);
  move_nodes(c, 1.0);
  const double area = 0.5 * 24 * std::sin(2 * M_PI / 24) * 50 * 50 * (1.2 * 1.2 - 1);
  EXPECT_NEAR((inside_area(f.swept, b) - Vec3(0, 0, area)).norm(), 0, 1e-9 * area);
}

TEST(SweptArea, PlasticStrainIsTheWorkOfThePeachKoehlerForce)
{
  // Edge b = ex, line +z, moved along +x under sigma_xy > 0: f_x = (sigma.b) x xi = sigma_xy b > 0, so the work
  // sigma : strain V = sigma_xy b L dx, hence 2 strain_xy V = b L dx.
  TopologyFixture f;
  const PlaneIndex plane = f.network.planes().find_or_insert({0, 1, 0}, Vec3::UnitY(), Vec3(Vec3::Zero()));
  const auto nodes = add_line(f.network, {Vec3(0, 0, 0), Vec3(0, 0, 20)}, b, plane, false, NodeConstraint::pinned);
  auto c = f.context();
  for (const NodeIndex i : nodes)
    move_node(c, i, f.network.position(i) + Vec3(3, 0, 0));
  const SymTensor strain = plastic_strain_volume(f.swept);
  EXPECT_NEAR(strain[3], 0.5 * 0.25 * 20 * 3, 1e-12);
  EXPECT_NEAR(strain.norm(), std::abs(strain[3]), 1e-12);
}

TEST(SweptArea, DisplacementOfTheSumOfMovesIsThatOfTheFinalLoop)
{
  // A loop grown from nothing, moved at random and remeshed: the books must agree with the loop created at once, up to
  // multiples of b (none for a point off the swept plane).
  TopologyFixture f;
  add_line(f.network, polygon(60, 40), b, f.horizontal(), true, NodeConstraint::free);
  f.swept = grown_area(f.network, nullptr, RayDirection::normal);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(-2, 2);
  for (int step = 0; step < 20; ++step)
  {
    auto c = f.context();
    for (Vec3 &d : c.remaining)
      d = Vec3(shift(random), shift(random), 0);
    move_nodes(c, 1.0);
    remesh(c);
  }
  f.network.check_invariants();
  EXPECT_GT(f.counts.coarsenings + f.counts.refinements, 0U);
  const SweptArea at_once = grown_area(f.network, nullptr, RayDirection::normal);
  const auto displacement = [](const SweptArea &area, const Vec3 &x)
  {
    Vec3 u = Vec3::Zero();
    for (const SweptTriangle &t : area.triangles())
      u += triangle_displacement(0.3, x, t.vertices[0], t.vertices[1], t.vertices[2], t.burgers);
    return u;
  };
  for (const Vec3 &x : {Vec3(10, 20, 30), Vec3(-80, 5, 11), Vec3(100, -70, -200)})
    EXPECT_NEAR((displacement(f.swept, x) - displacement(at_once, x)).norm(), 0, 1e-11);
  EXPECT_NEAR((inside_area(f.swept, b) - inside_area(at_once, b)).norm(), 0, 1e-8);
}

TEST(SweptArea, LoopThatHasLeftTheGrainHasSweptTheWholeSection)
{
  // A loop grows until it has left a box through its four sides: the area booked inside is the section of the plane, and the
  // displacement jumps by exactly b across it.
  for (const bool round : {false, true})
  {
    const BoxShape box(Vec3(-60, -50, -100), Vec3(60, 50, 100));
    const CylinderShape cylinder(Vec3(0, 0, -100), 55, 200);
    TopologyFixture f;
    f.shape = round ? static_cast<const GrainShape *>(&cylinder) : &box;
    add_line(f.network, polygon(20, 12), b, f.horizontal(), true, NodeConstraint::free);
    f.swept = grown_area(f.network, f.shape, RayDirection::normal);
    for (int step = 0; step < 200 && f.network.n_segments() > 0; ++step)
    {
      auto c = f.context();
      for (const NodeIndex i : f.network.nodes())
        c.remaining[i.value] = 3 * f.network.position(i).normalized();
      move_nodes(c, 1.0);
      remesh(c);
      f.network.check_invariants();
    }
    ASSERT_EQ(f.network.n_nodes(), 0U);
    // The box ends in corners, which the last chords cut at a tenth of L_min^2; the circle is cut by halved chords.
    const double section = round ? M_PI * 55 * 55 : 120 * 100;
    EXPECT_NEAR(inside_area(f.swept, b)[2], section, 0.005 * section);
    const auto displacement = [&](const Vec3 &x)
    {
      Vec3 u = Vec3::Zero();
      for (const SweptTriangle &t : f.swept.triangles())
        u += triangle_displacement(0.3, x, t.vertices[0], t.vertices[1], t.vertices[2], t.burgers);
      return u;
    };
    // Grown counter-clockwise about +z: plastic strain -b x A, the side of +z moves by -b relative to the other.
    for (const Vec3 &x : {Vec3(30, 20, 1e-3), Vec3(-10, -40, 1e-3)})
    {
      const Vec3 jump = displacement(x) - displacement(Vec3(x[0], x[1], -x[2]));
      EXPECT_NEAR((jump + b).norm(), 0, 1e-3 * b.norm()) << jump.transpose();
    }
  }
}
} // namespace
} // namespace ddfem
