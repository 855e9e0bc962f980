// Collisions over a whole step: outcome against the reference algorithm, order, termination, independence of the numbering.
#include "dd/topology/collisions/continuous_collisions.h"
#include "dd/topology/motion.h"
#include "dd/topology/proximity_collisions.h"
#include "tests/dd/topology/topology_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>
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

TEST(ContinuousCollisions, FrontsFormTheStraightJunctionOfSubsteppedProximity)
{
  for (const double offset : {0.0, 0.2, 0.5})
  {
    FrontsThatMeet continuous(offset), reference(offset);
    const auto report = continuous.move_continuously();
    reference.move_by_proximity(std::getenv("NSUB") ? std::atoi(std::getenv("NSUB")) : 80);
    if (std::getenv("DUMP"))
      for (auto *f : {&continuous, &reference})
      {
        std::cout << "net\n";
        for (const SegmentIndex q : f->network.segments())
          std::cout << f->network.position(f->network.start(q)).transpose() << " -> "
                    << f->network.position(f->network.end(q)).transpose() << " b " << f->network.burgers(q).transpose()
                    << "\n";
      }
    const auto j = continuous.junction(b1 + b2), k = reference.junction(b1 + b2);
    std::cout << offset << ": " << j.left << " " << j.right << " " << j.length << " " << j.waviness << " | " << k.left
              << " " << k.right << " " << k.length << " " << k.waviness << " events " << report.handled << " refused "
              << report.refused << " rounds " << report.rounds << " det " << report.detected << "\n";
  }
}
