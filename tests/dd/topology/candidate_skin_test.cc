// The skin of candidate lists: what it must cover, how long it lasts, what it costs.
#include "dd/topology/collisions/candidate_list.h"
#include "tests/dd/topology/random_lines.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

namespace
{
using namespace ddfem;

TEST(CandidateList, ServesAsManyStepsAsTheSkinIsWide)
{
  RandomLines sample(5, 100, 20, 400, Vec3::Zero());
  const double d = 0.05;
  sample.shift(Vec3(0.6, 0.8, 0) * d);
  CandidateList list;
  std::size_t builds = 0, steps = 0;
  double room = 0;
  for (int step = 0; step < 300; ++step)
  {
    list.update(sample.network, sample.displacement, 1);
    sample.move();
    if (list.statistics().builds != builds)
    {
      EXPECT_TRUE(builds == 0 || static_cast<double>(steps + 1) * d >= 0.5 * room * (1 - 1e-9)) << "too early";
      builds = list.statistics().builds;
      room = list.statistics().skin;
      steps = 0;
    }
    ++steps;
    EXPECT_LE(static_cast<double>(steps) * d, 0.5 * room * (1 + 1e-9));
  }
  EXPECT_GT(builds, 1U);
  EXPECT_EQ(list.statistics().insertions, 0U);
}

TEST(CandidateList, ContainsSegmentsThatMeetEndToEndWhenBothHaveUsedUpTheirSkin)
{
  RandomLines sample(23, 0, 0, 1, Vec3::Zero());
  const double radius = 0.5, length = 10;
  // Pairs of collinear segments far from each other, @p gap apart. The nodes of both move towards each other by @p d.
  const auto pairs_of = [&](double gap, double d, Network &network, std::vector<Vec3> &displacement)
  {
    for (int k = 0; k < 200; ++k)
    {
      const Vec3 xi = sample.vector(1).normalized(), x = Vec3(100 * (k % 10), 100 * (k / 10), 0) + sample.vector(20);
      for (const double side : {1.0, -1.0})
      {
        const NodeIndex a = network.insert({x + 0.5 * side * gap * xi});
        const NodeIndex b = network.insert({x + side * (0.5 * gap + length) * xi});
        network.insert(Segment{a, b, Vec3::UnitX(), {}});
        displacement.insert(displacement.end(), 2, -side * d * xi);
      }
    }
  };
  const auto built = [&](const Network &network)
  {
    CandidateList list;
    list.update(network, {}, radius);
    return list;
  };
  Network any, network;
  std::vector<Vec3> displacement;
  pairs_of(1, 0, any, displacement);
  const double skin = built(any).statistics().skin; // depends on the lengths only
  displacement.clear();
  pairs_of(radius + 0.998 * skin, 0.4995 * skin, network, displacement);
  CandidateList list = built(network);
  list.update(network, displacement, radius);
  ASSERT_EQ(list.statistics().builds, 1U);
  EXPECT_EQ(list.statistics().insertions, 0U);
  EXPECT_EQ(list.pairs().size(), 200U);
}

/// Counted cost of a step with a list of the skin @p skin, when all nodes move straight by @p d per step.
double cost_with_fixed_skin(const Network &network, double skin, double d, double radius)
{
  std::vector<Sphere> spheres;
  Vec3 lower = Vec3::Constant(INFINITY), upper = -lower;
  double largest = 0;
  for (const SegmentIndex s : network.segments())
    for (const double part : {0.25, 0.75})
    {
      const Vec3 x = network.position(network.start(s)) + part * network.direction(s);
      spheres.push_back({x, 0.25 * network.length(s) + 0.5 * skin, s});
      lower = lower.cwiseMin(x);
      upper = upper.cwiseMax(x);
      largest = std::max(largest, spheres.back().radius);
    }
  SphereGrid grid;
  SphereGrid::Memory memory;
  grid.build(spheres, CellMap(lower, upper, network.period(), 2 * largest + radius));
  std::size_t tests = 0, pairs = 0;
  for (std::size_t block = 0; block < grid.n_blocks(); ++block)
    tests += grid.pairs_of_block(block, radius, memory,
                                 [&](std::uint32_t i, std::uint32_t j)
                                 {
                                   if (!adjacent(network, grid.segment(i), grid.segment(j)) &&
                                       !std::isnan(grid.nearest_gap(i, j)))
                                     ++pairs;
                                 });
  const auto n = static_cast<double>(network.n_segments());
  return (SkinTuner::build_cost * n + SkinTuner::test_cost * static_cast<double>(tests)) /
             std::max(1.0, std::floor(0.5 * skin / d)) +
         SkinTuner::pair_cost * static_cast<double>(pairs);
}

TEST(CandidateList, ChoosesASkinThatCostsLittleMoreThanTheBest)
{
  const int n_threads = omp_get_max_threads();
  omp_set_num_threads(1);
  for (const double d : {0.02, 0.1, 0.5})
  {
    RandomLines sample(17, 150, 20, 350, Vec3::Zero());
    sample.displacement.assign(sample.network.node_capacity(), Vec3::Zero());
    Vec3 direction = Vec3::UnitX();
    for (const NodeIndex i : sample.network.nodes()) // 21 nodes of a line after each other: lines move as they are
    {
      if (i.value % 21 == 0)
        direction = sample.vector(1).normalized();
      sample.displacement[i.value] = d * direction;
    }
    double best = INFINITY;
    for (double skin = 2.001 * d; skin < 60; skin *= 1.04)
      best = std::min(best, cost_with_fixed_skin(sample.network, skin, d, 1));
    CandidateList list;
    double cost = 0;
    CandidateStatistics start;
    const int n_steps = 200, n_measured = 160;
    for (int step = 0; step < n_steps; ++step)
    {
      if (step == n_steps - n_measured)
        start = list.statistics();
      list.update(sample.network, sample.displacement, 1);
      sample.move();
      if (step >= n_steps - n_measured)
        cost += SkinTuner::pair_cost * static_cast<double>(list.pairs().size());
    }
    const CandidateStatistics &end = list.statistics();
    cost += SkinTuner::build_cost * static_cast<double>((end.builds - start.builds) * sample.network.n_segments()) +
            SkinTuner::test_cost * static_cast<double>(end.sphere_tests - start.sphere_tests);
    EXPECT_LT(cost / n_measured, 1.25 * best) << "displacement " << d << ", skin " << end.skin;
    EXPECT_EQ(end.insertions, 0U);
  }
  omp_set_num_threads(n_threads);
}
} // namespace
