// Remeshing: lengths, no oscillation, planes, physical nodes, booked area.
#include "dd/topology/line_operations.h"
#include "dd/topology/motion.h"
#include "dd/topology/remesh.h"
#include "tests/dd/topology/random_networks.h"
#include "tests/dd/topology/topology_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <vector>

namespace ddfem
{
namespace
{
const Vec3 b(0.25, 0, 0);
/// A wandering line in the plane z = 0 with segments of length @p low to @p high and bends up to @p bend (rad).
std::vector<Vec3> wandering_line(Random &random, const int n, const double low, const double high, const double bend)
{
  std::vector<Vec3> points{Vec3::Zero()};
  double angle = 0;
  for (int k = 0; k < n; ++k)
  {
    angle += uniform(random, -bend, bend);
    points.push_back(points.back() + uniform(random, low, high) * Vec3(std::cos(angle), std::sin(angle), 0));
  }
  return points;
}

double loop_area(const Network &network, const NodeIndex first)
{
  Vec3 sum = Vec3::Zero();
  NodeIndex i = first;
  do
  {
    SegmentIndex next = network.connected_segments(i)[0];
    if (network.burgers_from(next, i) != b)
      next = network.connected_segments(i)[1];
    const NodeIndex j = network.other_end(next, i);
    sum += 0.5 * network.position(i).cross(network.position(j));
    i = j;
  } while (i != first);
  return sum[2];
}

TEST(Remesh, ASecondCallChangesNothing)
{
  Random random(1);
  for (const double ratio : {2.0, 2.5, 3.0, 5.0, 10.0})
    for (int trial = 0; trial < 40; ++trial)
    {
      TopologyFixture f;
      f.settings = {10, 10 * ratio, 1, 1.25};
      f.settings.max_area = 0.2 * f.settings.max_segment * f.settings.max_segment;
      add_line(f.network, wandering_line(random, 60, 0.5, 15 * ratio, 0.9), b, f.horizontal(), false,
               NodeConstraint::pinned);
      auto c = f.context();
      remesh(c);
      const std::uint64_t once = f.network.checksum();
      const TopologyCounts counts = f.counts;
      remesh(c);
      EXPECT_EQ(f.network.checksum(), once)
          << ratio << ", trial " << trial << ": " << f.counts.refinements - counts.refinements << " divided, "
          << f.counts.coarsenings - counts.coarsenings << " joined";
    }
}

TEST(Remesh, LengthsAreBetweenTheLimitsExceptNextToSharpCorners)
{
  Random random(2);
  TopologyFixture f;
  f.settings.max_area = 180;
  add_line(f.network, wandering_line(random, 3000, 0.5, 120, 0.5), b, f.horizontal(), false, NodeConstraint::pinned);
  auto c = f.context();
  remesh(c);
  for (const SegmentIndex s : f.network.segments())
  {
    EXPECT_GE(f.network.length(s), 0.999 * f.settings.min_segment);
    EXPECT_LE(f.network.length(s), 1.001 * f.settings.max_segment);
  }
  f.network.check_invariants();
}

TEST(Remesh, AJoinedSegmentIsNotDividedInTheNextStepAndADividedOneNotJoined)
{
  Random random(3);
  for (int trial = 0; trial < 50; ++trial)
  {
    TopologyFixture f; // L_max = 3 L_min
    f.settings.max_area = 180;
    const bool dividing = trial % 2 != 0;
    add_line(f.network, dividing ? wandering_line(random, 40, 32, 60, 0.3) : wandering_line(random, 80, 1, 9.9, 0.3), b,
             f.horizontal(), false, NodeConstraint::pinned);
    auto c = f.context();
    remesh(c);
    ASSERT_GT(dividing ? f.counts.refinements : f.counts.coarsenings, 10U);
    ASSERT_EQ(dividing ? f.counts.coarsenings : f.counts.refinements, 0U);
    const TopologyCounts before = f.counts;
    c.remaining.assign(f.network.node_capacity(), Vec3::Zero());
    for (const NodeIndex i : f.network.nodes())
      if (f.network.constraint(i) == NodeConstraint::free)
      {
        // Dividing halves at 30 / 2 = 15: joined again below 10; what was joined, up to 20, is divided above 30.
        const double angle = uniform(random, 0, 2 * std::numbers::pi), size = uniform(random, 0, dividing ? 2.4 : 4.99);
        c.remaining[i.value] = size * Vec3(std::cos(angle), std::sin(angle), 0);
      }
    move_nodes(c, 1);
    remesh(c);
    EXPECT_EQ(dividing ? f.counts.coarsenings : f.counts.refinements,
              dividing ? before.coarsenings : before.refinements);
  }
}

TEST(Remesh, BooksExactlyTheAreaThatTheLineSweeps)
{
  Random random(4);
  for (int trial = 0; trial < 50; ++trial)
  {
    TopologyFixture f;
    std::vector<Vec3> points;
    for (int k = 0; k < 40; ++k)
    {
      const double angle = 2 * std::numbers::pi * (k + uniform(random, 0, 0.9)) / 40;
      points.push_back(uniform(random, 40, 200) * Vec3(std::cos(angle), std::sin(angle), 0));
    }
    const auto nodes = add_line(f.network, points, b, f.horizontal(), true, NodeConstraint::free);
    const double before = loop_area(f.network, nodes[0]);
    auto c = f.context();
    remesh(c);
    const double after = loop_area(f.network, f.network.nodes()[0]);
    EXPECT_NEAR(inside_area(f.swept, b)[2], after - before, 1e-10 * std::abs(before));
    f.network.check_invariants();
  }
}

TEST(Remesh, PhysicalNodesStayWhereTheyAre)
{
  // A junction node 3 nm from another, with short arms all around: only discretisation nodes go.
  TopologyFixture f;
  const PlaneIndex p = f.horizontal();
  const Vec3 b2(-0.125, 0.25 * std::sqrt(0.75), 0);
  Network &n = f.network;
  const NodeIndex left = n.insert(Node{Vec3(0, 0, 0)}), right = n.insert(Node{Vec3(3, 0, 0)});
  n.insert(Segment{left, right, b + b2, p});
  const auto arm = [&](const NodeIndex from, const Vec3 &direction, const Vec3 &burgers)
  {
    NodeIndex last = from;
    for (int k = 1; k <= 6; ++k)
    {
      const NodeIndex next = n.insert(Node{n.position(from) + 4.0 * k * direction + Vec3(0, k % 2, 0),
                                           k == 6 ? NodeConstraint::pinned : NodeConstraint::free});
      n.insert(Segment{last, next, burgers, p});
      last = next;
    }
  };
  arm(left, Vec3(-0.8, 0.6, 0), -b);
  arm(left, Vec3(-0.8, -0.6, 0), -b2);
  arm(right, Vec3(0.8, 0.6, 0), b);
  arm(right, Vec3(0.8, -0.6, 0), b2);
  n.check_invariants();
  std::set<ObjectId> physical;
  for (const NodeIndex i : n.nodes())
    if (n.is_physical(i))
      physical.insert(n.id(i));
  auto c = f.context();
  remesh(c);
  n.check_invariants();
  EXPECT_GT(f.counts.coarsenings, 8U);
  EXPECT_EQ(physical.size(), 6U);
  for (const ObjectId id : physical)
    ASSERT_TRUE(n.find_node(id));
  EXPECT_EQ(n.position(*n.find_node(n.id(left))), Vec3(0, 0, 0));
  EXPECT_EQ(n.position(*n.find_node(n.id(right))), Vec3(3, 0, 0));
}

TEST(Remesh, ALineThatLosesItsLastInteriorNodeBetweenTwoSurfaceNodesLeaves)
{
  // A small half loop whose two ends are at one point of the surface.
  const BoxShape box(Vec3::Zero(), Vec3(100, 100, 100));
  TopologyFixture f;
  f.shape = &box;
  add_line(f.network, {Vec3(100, 50, 50), Vec3(97, 48, 50), Vec3(97, 52, 50), Vec3(100, 50, 50)}, b, f.horizontal(50),
           false, NodeConstraint::surface);
  auto c = f.context();
  remesh(c);
  EXPECT_EQ(f.network.n_nodes(), 0U);
  EXPECT_NEAR(std::abs(inside_area(f.swept, b)[2]), 6, 1e-12);
}

TEST(Remesh, SharpBendsAreResolvedByShorterSegments)
{
  TopologyFixture f;
  f.settings = {2, 30, 0.04, 0.25};
  f.settings.max_area = 0.2 * 30 * 30;
  add_line(f.network, {Vec3(-90, 0, 0), Vec3(-29, 0, 0), Vec3(0, 0, 0), Vec3(0, 29, 0), Vec3(0, 90, 0)}, b,
           f.horizontal(), false, NodeConstraint::pinned);
  auto c = f.context();
  remesh(c);
  for (const NodeIndex i : f.network.nodes())
  {
    if (f.network.position(i).norm() > 1e-9)
      continue;
    for (const SegmentIndex s : f.network.connected_segments(i))
      EXPECT_LT(f.network.length(s), 15);
  }
}
} // namespace
} // namespace ddfem
