#include "dd/mobility/linear_glide.h"
#include "dd/topology/collisions/proximity_collisions.h"
#include "dd/topology/line_operations.h"
#include "dd/topology/motion.h"
#include "dd/topology/node_splitting.h"
#include "dd/topology/remesh.h"
#include "topology_fixture.h"

#include <gtest/gtest.h>

namespace ddfem
{
namespace
{
const Vec3 b(0.25, 0, 0);

const IsotropicMedium aluminium{26500, 0.345, 0.286};

/// Moves every node by its displacement in safe parts, with collisions; returns the number of parts.
unsigned move_and_collide(TopologyContext &c)
{
  const unsigned parts = motion_substeps(c);
  for (unsigned k = 0; k < parts; ++k)
  {
    collide(c);
    move_nodes(c, 1.0 / parts);
  }
  collide(c);
  return parts;
}

void split(TopologyContext &c)
{
  const SplittingModel model{aluminium, aluminium.a, linear_glide(0.01, 0.01)};
  const ForceSettings settings{aluminium, aluminium.a, 1e-5, RayDirection::normal};
  split_nodes(c, model,
              [&](const Network &n) { return compute_nodal_forces(n, settings, ForceEnvironment{}, MPI_COMM_SELF); });
}

TEST(ProximityCollisions, FastLinesDoNotPassThroughEachOther)
{
  // Two crossing lines on planes 0.5 nm apart meet head-on with 40 nm of relative motion in the step.
  TopologyFixture f;
  const auto one =
      add_line(f.network, {Vec3(-20, -20, 0), Vec3(-20, 20, 0)}, b, f.horizontal(), false, NodeConstraint::pinned);
  const auto two =
      add_line(f.network, {Vec3(5, -20, 0), Vec3(3, 20, 0)}, b, f.horizontal(), false, NodeConstraint::pinned);
  for (const NodeIndex i : {one[0], one[1], two[0], two[1]})
    f.network.set_constraint(i, NodeConstraint::free);
  auto c = f.context();
  for (const NodeIndex i : one)
    c.remaining[i.value] = Vec3(40, 0, 0);
  EXPECT_GE(move_and_collide(c), 64U);
  EXPECT_GE(f.counts.collisions, 1U);
}

TEST(ProximityCollisions, OppositeParallelLinesAnnihilate)
{
  TopologyFixture f;
  const auto up = add_line(f.network, {Vec3(0, -30, 0), Vec3(0, 0, 0), Vec3(0, 30, 0)}, b, f.horizontal(), false,
                           NodeConstraint::free);
  const auto down = add_line(f.network, {Vec3(6, 30, 0), Vec3(6, 0, 0), Vec3(6, -30, 0)}, b, f.horizontal(), false,
                             NodeConstraint::free);
  auto c = f.context();
  for (const NodeIndex i : up)
    c.remaining[i.value] = Vec3(5, 0, 0);
  move_and_collide(c);
  EXPECT_EQ(f.network.n_segments(), 0U);
  EXPECT_EQ(f.network.n_nodes(), 0U);
  EXPECT_EQ(f.counts.annihilations, 2U);
  // Swept together: 6 nm x 60 nm, with the line sense along +y and motion along +x: A = dx x xi = +z.
  EXPECT_NEAR(inside_area(f.swept, b)[2], 6 * 60, 1e-9);
}

TEST(ProximityCollisions, TwoBowedArmsOfASourceReconnectIntoALoopAndALine)
{
  // Outside and inside of a kidney-shaped source just before it closes: two antiparallel bulges on one plane.
  // With b across them the arms are nearer to edge than to screw, and their torque adds to the line tension that pulls each
  // pair to its own side; with b along them it would win over it and restore the two bulges.
  const Vec3 across(0, 0.25, 0);
  TopologyFixture f;
  const auto lower =
      add_line(f.network, {Vec3(-40, -30, 0), Vec3(-15, -10, 0), Vec3(0, -0.5, 0), Vec3(15, -10, 0), Vec3(40, -30, 0)},
               across, f.horizontal(), false, NodeConstraint::pinned);
  const auto upper =
      add_line(f.network, {Vec3(40, 30, 0), Vec3(15, 10, 0), Vec3(0, 0.5, 0), Vec3(-15, 10, 0), Vec3(-40, 30, 0)},
               across, f.horizontal(), false, NodeConstraint::pinned);
  auto c = f.context();
  c.remaining[lower[2].value] = Vec3(0, 0.1, 0);
  collide(c);
  ASSERT_EQ(f.counts.collisions, 1U);
  split(c);
  EXPECT_EQ(f.counts.splits, 1U);
  f.network.check_invariants();
  // The lines now run left-left and right-right: from a pinned node one comes back on the same side.
  for (const NodeIndex end : {lower.front(), lower.back()})
  {
    NodeIndex i = end;
    SegmentIndex s = f.network.connected_segments(end)[0];
    while (f.network.constraint(i = f.network.other_end(s, i)) != NodeConstraint::pinned)
    {
      const auto arms = f.network.connected_segments(i);
      ASSERT_EQ(arms.size(), 2U);
      s = arms[0] == s ? arms[1] : arms[0];
    }
    EXPECT_GT(f.network.position(i)[0] * f.network.position(end)[0], 0);
    EXPECT_LT(f.network.position(i)[1] * f.network.position(end)[1], 0);
  }
}

TEST(ProximityCollisions, LinesOnDifferentPlanesMeetOnTheIntersectionOfTheirPlanes)
{
  TopologyFixture f;
  const Vec3 n2 = Vec3(1, 1, 1).normalized();
  const PlaneIndex other = f.network.planes().find_or_insert({1, 1, 1}, n2, Vec3(0, 0, 0.2));
  add_line(f.network, {Vec3(-20, 0, 0), Vec3(20, 0, 0)}, Vec3(0, 0.25, 0), f.horizontal(), false,
           NodeConstraint::pinned);
  const Vec3 t = n2.cross(Vec3(1, -0.2, 0)).normalized();
  const Vec3 x = f.network.planes().project(other, Vec3(0, 0, 0.2));
  const auto second =
      add_line(f.network, {x - 20 * t, x, x + 20 * t}, Vec3(0.2, -0.2, 0), other, false, NodeConstraint::pinned);
  auto c = f.context();
  c.remaining[second[1].value] = Vec3(0, 0, -1);
  collide(c);
  ASSERT_EQ(f.counts.collisions, 1U);
  for (const NodeIndex i : f.network.nodes())
  {
    if (f.network.degree(i) != 4)
      continue;
    for (const SegmentIndex s : f.network.connected_segments(i))
      EXPECT_TRUE(f.network.planes().contains(f.network.plane(s), f.network.position(i), 1e-5));
  }
  f.network.check_invariants(1e-5);
}

TEST(ProximityCollisions, RecedingLinesAreLeftAlone)
{
  TopologyFixture f;
  add_line(f.network, {Vec3(0, -20, 0), Vec3(0, 20, 0)}, b, f.horizontal(), false, NodeConstraint::pinned);
  const auto second =
      add_line(f.network, {Vec3(1, 20, 0), Vec3(1, -20, 0)}, b, f.horizontal(), false, NodeConstraint::pinned);
  auto c = f.context();
  for (const NodeIndex i : second)
    c.remaining[i.value] = Vec3(1, 0, 0);
  collide(c);
  EXPECT_EQ(f.counts.collisions, 0U);
}

TEST(Remesh, KeepsLengthsBetweenTheLimitsAndSmallLoopsVanishWithTheirArea)
{
  TopologyFixture f;
  std::vector<Vec3> triangle{Vec3(0, 0, 0), Vec3(6, 0, 0), Vec3(0, 6, 0)};
  add_line(f.network, triangle, b, f.horizontal(), true, NodeConstraint::free);
  auto c = f.context();
  remesh(c);
  EXPECT_EQ(f.network.n_nodes(), 0U);
  EXPECT_NEAR(inside_area(f.swept, b)[2], -18, 1e-12);

  add_line(f.network, {Vec3(0, 0, 0), Vec3(3, 0.5, 0), Vec3(20, 0, 0), Vec3(95, 0, 0)}, b, f.horizontal(), false,
           NodeConstraint::pinned);
  remesh(c);
  remesh(c);
  for (const SegmentIndex s : f.network.segments())
  {
    EXPECT_GE(f.network.length(s), f.settings.min_segment);
    EXPECT_LE(f.network.length(s), f.settings.max_segment);
  }
  const std::uint64_t once = f.network.checksum();
  remesh(c);
  EXPECT_EQ(f.network.checksum(), once); // no oscillation
}

TEST(Surface, ImpenetrableFaceStopsALineAndLetsItSlide)
{
  BoxShape box(Vec3::Zero(), Vec3(100, 100, 100));
  box.set_face_kind(1, FaceKind::impenetrable);
  TopologyFixture f;
  f.shape = &box;
  const auto nodes = add_line(f.network, {Vec3(95, 20, 50), Vec3(95, 50, 50), Vec3(95, 80, 50)}, b, f.horizontal(50),
                              false, NodeConstraint::pinned);
  auto c = f.context();
  c.remaining[nodes[1].value] = Vec3(20, 3, 0);
  move_nodes(c, 1.0);
  EXPECT_NEAR(f.network.position(nodes[1])[0], 100, 1e-9);
  EXPECT_NEAR(f.network.position(nodes[1])[1], 53, 1e-9);
  EXPECT_EQ(f.network.constraint(nodes[1]), NodeConstraint::free);
  EXPECT_EQ(f.counts.surface_exits, 0U);
}

TEST(Surface, LineThatReachesAFreeFaceIsCutAndContinuesAsTwoRays)
{
  const BoxShape box(Vec3::Zero(), Vec3(100, 100, 100));
  TopologyFixture f;
  f.shape = &box;
  const auto nodes = add_line(f.network, {Vec3(50, 20, 50), Vec3(95, 50, 50), Vec3(50, 80, 50)}, b, f.horizontal(50),
                              false, NodeConstraint::pinned);
  auto c = f.context();
  c.remaining[nodes[1].value] = Vec3(20, 0, 0);
  move_nodes(c, 1.0);
  EXPECT_EQ(f.counts.surface_exits, 1U);
  EXPECT_EQ(f.network.n_nodes(), 4U);
  const auto rays = virtual_rays(f.network, box, RayDirection::normal);
  ASSERT_EQ(rays.size(), 2U);
  EXPECT_NEAR((rays[0].burgers + rays[1].burgers).norm(), 0, 1e-15);
  for (const VirtualRay &r : rays)
  {
    EXPECT_NEAR(r.origin[0], 100, 1e-9);
    EXPECT_EQ(r.direction, Vec3(1, 0, 0));
  }
  f.network.check_invariants();
}

TEST(Surface, ALineThatLeavesAlongItselfIsGone)
{
  // A junction moves outwards along its own direction, and both of its nodes leave through one point.
  const BoxShape box(Vec3::Zero(), Vec3(100, 100, 100));
  for (int k = 0; k < 50; ++k) // rounding decides how far apart the two end up
  {
    TopologyFixture f;
    f.shape = &box;
    const Vec3 along(1, 0.02 * k, 0), end(99.5 - 0.1 * k, 50 + 0.3 * k, 50);
    const auto nodes = add_line(f.network, {Vec3(50, 20, 50), end - 5 * along, end, Vec3(50, 80, 50)}, b,
                                f.horizontal(50), false, NodeConstraint::pinned);
    auto c = f.context();
    c.remaining[nodes[1].value] = c.remaining[nodes[2].value] = 11.7 * along;
    move_nodes(c, 1.0);
    f.network.check_invariants();
    EXPECT_EQ(f.network.n_segments(), 2U);
    EXPECT_EQ(f.network.n_nodes(), 4U);
  }
}

TEST(Surface, EndsOfTwoLinesMeetOnlyToAnnihilate)
{
  const BoxShape box(Vec3::Zero(), Vec3(100, 100, 100));
  for (const bool opposite : {false, true})
  {
    TopologyFixture f;
    f.shape = &box;
    const Vec3 other = opposite ? Vec3(-b) : Vec3(0.125, 0.2, 0);
    std::vector<NodeIndex> ends;
    for (const auto &[y, burgers] : {std::pair(50.0, b), std::pair(51.0, other)})
    {
      ends.push_back(f.network.insert(Node{Vec3(100, y, 50), NodeConstraint::surface}));
      const NodeIndex inner = f.network.insert(Node{Vec3(60, 2 * y - 50.5, 50), NodeConstraint::pinned});
      f.network.insert(Segment{ends.back(), inner, burgers, f.horizontal(50)});
    }
    auto c = f.context();
    c.remaining[ends[0].value] = Vec3(0, 0.5, 0);
    collide(c);
    EXPECT_EQ(f.counts.collisions, opposite ? 1U : 0U);
    EXPECT_EQ(virtual_rays(f.network, box, RayDirection::normal).size(), opposite ? 0U : 2U);
    f.network.check_invariants();
  }
}
} // namespace
} // namespace ddfem
