// Collisions over a whole step: outcome against the reference algorithm, order, termination, independence of the numbering.
#include "dd/topology/collisions/continuous_collisions.h"
#include "dd/topology/collisions/proximity_collisions.h"
#include "dd/topology/motion.h"
#include "tests/dd/topology/topology_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

using namespace ddfem;

namespace
{
const Vec3 b1(0.286, 0, 0), b2(-0.143, 0.248, 0); // of one plane, 120 degrees apart: their sum is a third of this kind

/// Two lines of one plane that move towards each other and meet front to front (Durocher, thesis, Bordeaux 2018, section
/// III.3.2.1, fig. III.9): v dt = 2 L, capture radius 0.025 L. Their middle parts are straight; their ends are pinned.
struct FrontsThatMeet : TopologyFixture
{
  static constexpr double L = 10;
  static constexpr int half = 12; ///< segments on each side of the middle
  std::vector<Vec3> displacement;
  CandidateList candidates;

  explicit FrontsThatMeet(const double offset = 0, const Vec3 &second_burgers = b2)
  {
    settings.collision_radius = 0.025 * L;
    const PlaneIndex plane = horizontal();
    for (const int side : {-1, 1})
    {
      std::vector<Vec3> points;
      for (int k = -half; k <= half; ++k)
      {
        const bool inner = std::abs(k) < half;
        points.emplace_back(L * (k + (inner && side > 0 ? offset : 0.0)), side * L, 0);
      }
      const auto nodes =
          add_line(network, points, side < 0 ? b1 : second_burgers, plane, false, NodeConstraint::pinned);
      displacement.resize(network.node_capacity(), Vec3::Zero());
      for (const NodeIndex i : nodes)
      {
        const double taper = std::clamp((half - std::abs(network.position(i)[0]) / L) / 6, 0.0, 1.0);
        displacement[i.value] = Vec3(0, -side * 2 * L * taper, 0);
      }
    }
  }

  TopologyContext moving_context()
  {
    TopologyContext c = context();
    c.remaining = displacement;
    return c;
  }

  CollisionReport move_continuously(const CollisionSettings &s = {})
  {
    TopologyContext c = moving_context();
    const CollisionReport report = collide_continuously(c, candidates, s);
    move_nodes(c, 1);
    network.check_invariants();
    return report;
  }

  void move_by_proximity(const unsigned parts)
  {
    TopologyContext c = moving_context();
    for (unsigned k = 0; k < parts; ++k)
    {
      collide(c);
      move_nodes(c, 1.0 / parts);
    }
    collide(c);
    network.check_invariants();
  }

  struct Junction
  {
    double left = 1e9, right = -1e9, length = 0, waviness = 0;
  };
  Junction junction(const Vec3 &b) const
  {
    Junction j;
    for (const SegmentIndex s : network.segments())
      if ((network.burgers(s) - b).norm() < 1e-9 || (network.burgers(s) + b).norm() < 1e-9)
      {
        j.length += network.length(s);
        for (const NodeIndex i : {network.start(s), network.end(s)})
        {
          j.left = std::min(j.left, network.position(i)[0]);
          j.right = std::max(j.right, network.position(i)[0]);
          j.waviness = std::max(j.waviness, std::abs(network.position(i)[1]));
        }
      }
    return j;
  }
};
} // namespace

namespace
{
void expect_same_junction(const FrontsThatMeet::Junction &j, const FrontsThatMeet::Junction &reference, const double r)
{
  EXPECT_NEAR(j.left, reference.left, r);
  EXPECT_NEAR(j.right, reference.right, r);
  EXPECT_NEAR(j.length, reference.length, 2 * r); // no gap, no line left double
}

/// Area of closed lines about the z axis, weighted with their Burgers vectors along @p b; its change is the area swept by
/// lines in z = 0 whose ends stay where they are.
double area_functional(const Network &n, const Vec3 &b)
{
  double area = 0;
  for (const SegmentIndex s : n.segments())
    area += 0.5 * n.burgers(s).dot(b) / b.squaredNorm() * n.position(n.start(s)).cross(n.position(n.end(s)))[2];
  return area;
}

} // namespace

TEST(ContinuousCollisions, FrontsThatMeetFormTheStraightJunctionOfSubsteppedProximity)
{
  // Where the nodes of the two lines face each other, or alternate, proximity at 1/80 of the step is a reference. For other
  // offsets it misses nodes, because the lines approach by twice the capture radius in such a part: there 1/160.
  for (const auto &[offset, parts] : {std::pair(0.0, 80U), std::pair(0.5, 80U), std::pair(0.2, 160U)})
  {
    FrontsThatMeet continuous(offset), reference(offset);
    const CollisionReport report = continuous.move_continuously();
    reference.move_by_proximity(parts);
    const double r = continuous.settings.collision_radius;
    expect_same_junction(continuous.junction(b1 + b2), reference.junction(b1 + b2), r);
    EXPECT_LT(continuous.junction(b1 + b2).waviness, 2 * r);
    EXPECT_EQ(report.refused, 0U);
    EXPECT_EQ(report.exhausted, 0U);
    EXPECT_EQ(continuous.network.n_segments(), reference.network.n_segments()) << offset;
  }
}

TEST(ContinuousCollisions, WithoutLookingAgainTheJunctionIsNotFormed)
{
  // Durocher, fig. III.12: most contacts of a front only come about through the ones before.
  for (const double offset : {0.2, 0.5})
  {
    FrontsThatMeet whole(offset), blind(offset);
    whole.move_continuously();
    blind.move_continuously({.redetect = false});
    EXPECT_LT(blind.junction(b1 + b2).length, 0.5 * whole.junction(b1 + b2).length) << offset;
  }
}

TEST(ContinuousCollisions, FrontsOfOppositeBurgersVectorAnnihilateAlongTheWholeFront)
{
  FrontsThatMeet f(0.5, -b1);
  const double before = area_functional(f.network, b1);
  f.move_continuously();
  for (const SegmentIndex s : f.network.segments()) // what is left bends round from one line to the other at both ends
    EXPECT_GT(std::abs(f.network.position(f.network.start(s))[0]), 79);
  EXPECT_GE(f.counts.annihilations, 1U);
  EXPECT_NEAR(inside_area(f.swept, b1)[2], area_functional(f.network, b1) - before, 1e-10 * std::abs(before));
}

TEST(ContinuousCollisions, RoundsOfIndependentEventsGiveTheSequentialOutcomeToTheLastBit)
{
  for (const double offset : {0.0, 0.2, 0.5})
  {
    FrontsThatMeet sequential(offset), concurrent(offset);
    const auto one = sequential.move_continuously({.concurrent = false});
    const auto many = concurrent.move_continuously({.concurrent = true});
    EXPECT_EQ(one.handled, many.handled);
    EXPECT_LE(many.rounds, one.rounds);
    EXPECT_TRUE(picture_of(sequential.network) == picture_of(concurrent.network));
  }
}
