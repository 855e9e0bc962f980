// The paths of nodes within a step, and what collisions see of them.
#include "dd/integrators/node_paths.h"
#include "dd/topology/collisions/moving_lines.h"
#include "tests/dd/topology/topology_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace ddfem
{
namespace
{
TEST(NodePaths, PartsAreAsStraightAsAskedAndAddUpToTheWhole)
{
  // Node 1 goes along half a circle of radius 10, at first fast; the others go straight.
  const std::vector<Vec3> start{Vec3(0, 0, 0), Vec3(10, 0, 0), Vec3(5, 5, 5)};
  const std::vector<Vec3> end{Vec3(1, 2, 3), Vec3(-10, 0, 0), Vec3(5, 5, 5)};
  NodePaths paths;
  std::vector<std::pair<double, Vec3>> way;
  for (int k = 1; k <= 64; ++k)
  {
    const double t = std::pow(k / 64.0, 2), angle = M_PI * k / 64;
    way.emplace_back(t, Vec3(10 * std::cos(angle), 10 * std::sin(angle), 0));
    paths.add(NodeIndex{1}, t, way.back().second);
  }
  for (const double deviation : {20.0, 3.0, 0.5})
  {
    std::vector<MotionPart> parts;
    ASSERT_TRUE(paths.divide(start, end, deviation, parts));
    if (deviation > 10)
    {
      EXPECT_TRUE(parts.empty());
      continue;
    }
    std::vector<Vec3> x = start;
    double time = 0;
    for (const MotionPart &p : parts)
    {
      const Vec3 from = x[1], to = from + p.displacement[1];
      for (const auto &[t, at] : way)
        if (t > time && t < time + p.duration)
        {
          const Vec3 d = to - from;
          EXPECT_LE((at - from - d * ((at - from).dot(d) / d.squaredNorm())).norm(), deviation + 1e-9);
        }
      for (std::size_t i = 0; i < 3; ++i)
        x[i] += p.displacement[i];
      time += p.duration;
    }
    EXPECT_NEAR(time, 1, 1e-15);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_LT((x[i] - end[i]).norm(), 1e-12);
  }
  std::vector<MotionPart> parts;
  EXPECT_FALSE(paths.divide(start, end, 1e-6, parts));
}

/// A line that goes to and fro over another one within a step, which ends where it began.
TEST(MotionInParts, ContactOnTheWayForthAndBackIsFound)
{
  for (const bool in_parts : {false, true})
  {
    TopologyFixture f;
    std::vector<Vec3> points, others;
    for (int k = 0; k <= 4; ++k)
    {
      points.emplace_back(20.0 * k - 40, -15, 0);
      others.emplace_back(3, 0, 20.0 * k - 40);
    }
    const auto moving = add_line(f.network, points, Vec3(0.25, 0, 0), f.horizontal(), false, NodeConstraint::pinned);
    for (const NodeIndex i : add_line(f.network, others, Vec3(0, 0.25, 0), PlaneIndex{}, false, NodeConstraint::pinned))
      f.network.set_constraint(i, NodeConstraint::pinned);
    std::vector<Vec3> forth(f.network.node_capacity(), Vec3::Zero()), back = forth;
    for (std::size_t k = 1; k + 1 < moving.size(); ++k)
    {
      forth[moving[k].value] = Vec3(0, 30, 0);
      back[moving[k].value] = Vec3(0, -30, 0);
    }
    TopologyContext c = f.context();
    CandidateList candidates;
    std::vector<MotionPart> parts;
    if (in_parts)
      parts = {{0.25, forth}, {0.75, back}};
    move_lines(c, candidates, parts);
    EXPECT_EQ(f.counts.collisions, in_parts ? 1U : 0U);
    // Nodes that have not met anything are back.
    EXPECT_LT((f.network.position(moving[1]) - points[1]).norm(), 1e-12);
    EXPECT_EQ(f.network.violations().size(), 0U);
  }
}

TEST(MotionInParts, MergedNodesGoOnAtTheSpeedThatTheCollisionGaveThem)
{
  // Two fronts meet in the first of two parts of different length; what is left moves as in one part of the whole.
  std::vector<Picture> pictures;
  for (const bool in_parts : {false, true})
  {
    TopologyFixture f;
    std::vector<Vec3> low, high;
    for (int k = 0; k <= 6; ++k)
    {
      low.emplace_back(20.0 * k, -4, 0);
      high.emplace_back(20.0 * k + 7, 4, 0);
    }
    const auto a = add_line(f.network, low, Vec3(0.25, 0, 0), f.horizontal(), false, NodeConstraint::pinned);
    const auto b = add_line(f.network, high, Vec3(0, 0.25, 0), f.horizontal(), false, NodeConstraint::pinned);
    std::vector<Vec3> d(f.network.node_capacity(), Vec3::Zero());
    for (std::size_t k = 1; k < 6; ++k)
    {
      d[a[k].value] = Vec3(0, 32, 0);
      d[b[k].value] = Vec3(0, 16, 0);
    }
    TopologyContext c = f.context();
    c.remaining = d;
    CandidateList candidates;
    std::vector<MotionPart> parts;
    if (in_parts)
      for (const double part : {0.75, 0.25})
      {
        parts.push_back({part, d});
        for (Vec3 &x : parts.back().displacement)
          x *= part;
      }
    move_lines(c, candidates, parts);
    EXPECT_GT(f.counts.collisions, 3U);
    pictures.push_back(picture_of(f.network));
  }
  ASSERT_EQ(pictures[0].size(), pictures[1].size());
  for (auto p = pictures[0].begin(), q = pictures[1].begin(); p != pictures[0].end(); ++p, ++q)
    for (std::size_t k = 0; k < 9; ++k)
      EXPECT_NEAR((*p)[k], (*q)[k], 1e-9);
}
} // namespace
} // namespace ddfem
