// Candidate pairs against all pairs, over many steps of random motion and random edits.
#include "dd/elasticity/distance.h"
#include "dd/topology/collisions/candidate_list.h"
#include "tests/dd/topology/random_lines.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace
{
using namespace ddfem;
using IndexPair = std::pair<std::uint32_t, std::uint32_t>;

/// All pairs that are within @p radius at some of the sampled moments of the step.
std::set<IndexPair> pairs_within(RandomLines &sample, double radius)
{
  const Network &network = sample.network;
  const auto segments = network.segments();
  std::set<IndexPair> found;
  for (int k = 0; k < RandomLines::n_moments; ++k)
  {
    const std::vector<double> part = sample.parts(k);
    std::vector<std::pair<Vec3, Vec3>> ends;
    std::vector<double> length;
    for (const SegmentIndex s : segments)
    {
      ends.push_back(sample.ends(s, part));
      length.push_back((ends.back().second - ends.back().first).norm());
    }
    for (std::size_t i = 0; i < segments.size(); ++i)
      for (std::size_t j = i + 1; j < segments.size(); ++j)
      {
        const Vec3 apart = 0.5 * (ends[j].first + ends[j].second - ends[i].first - ends[i].second);
        const Vec3 near = network.minimum_image(apart);
        const double reach = 0.5 * (length[i] + length[j]) + radius;
        if (near.squaredNorm() > reach * reach)
          continue;
        const Vec3 shift = near - apart;
        const double d2 =
            distance_segment_segment(ends[i].first, ends[i].second, ends[j].first + shift, ends[j].second + shift)
                .squared;
        if (d2 <= radius * radius && !adjacent(network, segments[i], segments[j]))
          found.insert(std::minmax(segments[i].value, segments[j].value));
      }
  }
  return found;
}

std::set<IndexPair> as_set(const CandidateList &list)
{
  std::set<IndexPair> pairs;
  for (const CandidatePair &p : list.pairs())
    pairs.insert(std::minmax(p.first.value, p.second.value));
  return pairs;
}

/// What holds for any list: live segments without a common node, each pair once, sorted, and near each other.
void expect_sound(const Network &network, const CandidateList &list, double farthest)
{
  std::pair<ObjectId, ObjectId> last{0, 0};
  for (const CandidatePair &p : list.pairs())
  {
    ASSERT_TRUE(network.contains(p.first) && network.contains(p.second));
    ASSERT_FALSE(adjacent(network, p.first, p.second));
    const std::pair ids(network.id(p.first), network.id(p.second));
    ASSERT_LT(ids.first, ids.second);
    ASSERT_LT(last, ids);
    last = ids;
    const Vec3 d = network.minimum_image(network.position(network.start(p.first)) + 0.5 * network.direction(p.first) -
                                         network.position(network.start(p.second)) - 0.5 * network.direction(p.second));
    ASSERT_LE(d.norm(), 0.5 * (network.length(p.first) + network.length(p.second)) + farthest);
  }
}

/// Asks for the neighbours of a random ball and compares with all segments, at sampled moments of the step.
std::size_t expect_neighbours(RandomLines &sample, const CandidateList &list, const std::set<SegmentIndex> &unknown,
                              double radius)
{
  const Network &network = sample.network;
  const Vec3 centre = sample.image(network.position(network.start(sample.any_segment())) + sample.vector(10));
  const double ball = sample.uniform(0, 15);
  std::vector<SegmentIndex> found{SegmentIndex{7}}; // what is there already stays
  list.neighbours(network, centre, ball, radius, found);
  EXPECT_EQ(found.front().value, 7U);
  const std::set<SegmentIndex> neighbours(found.begin() + 1, found.end());
  EXPECT_EQ(neighbours.size(), found.size() - 1) << "a segment was returned twice";
  for (const SegmentIndex s : neighbours)
    EXPECT_TRUE(network.contains(s));
  for (int k = 0; k < RandomLines::n_moments; ++k)
  {
    const std::vector<double> part = sample.parts(k);
    for (const SegmentIndex s : network.segments())
    {
      if (unknown.contains(s))
        continue;
      const auto [a, b] = sample.ends(s, part);
      const Vec3 apart = centre - 0.5 * (a + b);
      const Vec3 shift = apart - network.minimum_image(apart);
      const double d = std::sqrt(distance_point_segment(centre, a + shift, b + shift).squared);
      EXPECT_TRUE(d > ball + radius || neighbours.contains(s));
    }
  }
  return neighbours.size();
}

struct Case
{
  const char *name;
  double box;
  Vec3 period;
  double motion;
  std::size_t rare;
  double radius;
  std::size_t n_lines;
};

void PrintTo(const Case &c, std::ostream *out)
{
  *out << c.name;
}

class CandidateListCase : public testing::TestWithParam<Case>
{
};

INSTANTIATE_TEST_SUITE_P(Cells, CandidateListCase,
                         testing::Values(Case{"Free", 150, Vec3::Zero(), 0.5, 1000, 2, 40},
                                         Case{"FreeSparse", 900, Vec3::Zero(), 1, 50, 5, 40},
                                         Case{"FreeFast", 150, Vec3::Zero(), 2, 20, 2, 40},
                                         Case{"PeriodicX", 150, {150, 0, 0}, 0.5, 1000, 2, 25},
                                         Case{"PeriodicXZ", 150, {150, 0, 130}, 0.5, 200, 2, 25},
                                         Case{"PeriodicXYZ", 400, {400, 350, 380}, 0.5, 1000, 2, 40},
                                         Case{"PeriodicFewCells", 70, {55, 70, 95}, 0.3, 1000, 2, 20},
                                         Case{"PeriodicWide", 70, {55, 70, 300}, 0.3, 300, 8, 20}),
                         [](const testing::TestParamInfo<Case> &tested) { return tested.param.name; });

TEST_P(CandidateListCase, ContainsEveryPairThatMeetsInTheStep)
{
  const Case &c = GetParam();
  RandomLines sample(7, c.n_lines, 15, c.box, c.period);
  CandidateList list;
  std::size_t n_met = 0;
  for (int step = 0; step < 50; ++step)
  {
    sample.draw_motion(c.motion, c.rare);
    list.update(sample.network, sample.displacement, c.radius);
    ASSERT_NO_FATAL_FAILURE(expect_sound(sample.network, list, c.radius + 2 * list.statistics().skin + 120 * c.motion));
    const std::set<IndexPair> met = pairs_within(sample, c.radius), listed = as_set(list);
    n_met += met.size();
    ASSERT_TRUE(std::ranges::includes(listed, met)) << "in step " << step;
    sample.move();
    sample.edit();
    if (step % 20 == 13)
      sample.network.clean();
  }
  EXPECT_GT(n_met, c.box < 300 ? 500U : 20U);
}

TEST_P(CandidateListCase, IsTheSameForAnyNumberOfThreads)
{
  const Case &c = GetParam();
  RandomLines sample(11, 200, 15, 1.7 * c.box, 1.7 * c.period);
  ASSERT_GT(sample.network.n_segments(), least_for_threads);
  CandidateList one, two;
  for (int step = 0; step < 20; ++step)
  {
    sample.draw_motion(c.motion, c.rare);
    const int n_threads = omp_get_max_threads();
    omp_set_num_threads(1);
    one.update(sample.network, sample.displacement, c.radius);
    omp_set_num_threads(3);
    two.update(sample.network, sample.displacement, c.radius);
    omp_set_num_threads(n_threads);
    ASSERT_TRUE(std::ranges::equal(one.pairs(), two.pairs(),
                                   [](const CandidatePair &a, const CandidatePair &b)
                                   { return a.first == b.first && a.second == b.second; }));
    ASSERT_EQ(one.statistics().sphere_tests, two.statistics().sphere_tests);
    ASSERT_EQ(one.statistics().skin, two.statistics().skin);
    sample.move();
    for (int k = 0; k < 20; ++k) // many, so that they are shared out, too
      sample.edit();
  }
}

TEST_P(CandidateListCase, NeighboursOfABallAreComplete)
{
  const Case &c = GetParam();
  RandomLines sample(13, c.n_lines, 15, c.box, c.period);
  CandidateList list;
  std::size_t n_found = 0;
  for (int step = 0; step < 25; ++step)
  {
    sample.draw_motion(c.motion, c.rare);
    list.update(sample.network, sample.displacement, c.radius);
    // Within the step: some segments go, some are born; every second of these is made known.
    std::set<SegmentIndex> unknown;
    for (int k = 0; k < 6; ++k)
    {
      const std::size_t before = sample.network.segment_capacity();
      const Vec3 moved = sample.vector(c.motion);
      sample.network.erase(sample.any_segment());
      sample.split(sample.any_segment());
      sample.displacement.resize(sample.network.node_capacity(), moved);
      for (std::size_t s = before; s < sample.network.segment_capacity(); ++s)
      {
        const SegmentIndex born{static_cast<std::uint32_t>(s)};
        if (!sample.network.contains(born))
          continue;
        const auto [a, b] = sample.ends(born, std::vector<double>(sample.network.node_capacity(), 0.5));
        const double room = std::max(sample.displacement[sample.network.start(born).value].norm(),
                                     sample.displacement[sample.network.end(born).value].norm());
        if (k % 2 == 0)
          list.insert_in_step(sample.network, born, sample.image(0.5 * (a + b)), 0.5 * (b - a).norm() + 0.5 * room);
        else
          unknown.insert(born);
      }
    }
    for (int k = 0; k < 20; ++k)
      n_found += expect_neighbours(sample, list, unknown, c.radius);
    sample.move();
    sample.edit();
  }
  EXPECT_GT(n_found, 100U);
  EXPECT_LT(n_found, 25 * 20 * sample.network.n_segments() / 2) << "no selection takes place";
}

TEST(CandidateList, IsRebuiltOnlyWhenNodesLeaveTheirSkin)
{
  RandomLines sample(3, 60, 20, 300, Vec3::Zero());
  CandidateList list;
  list.update(sample.network, {}, 1);
  ASSERT_EQ(list.statistics().builds, 1U);
  const double skin = list.statistics().skin;
  for (int step = 0; step < 20; ++step) // to the limit, back, and to the limit again
  {
    sample.shift(Vec3::UnitX() * (step % 2 == 0 ? 0.499 : -0.499) * skin);
    list.update(sample.network, sample.displacement, 1);
    sample.move();
  }
  EXPECT_EQ(list.statistics().builds, 1U);
  EXPECT_EQ(list.statistics().insertions, 0U);
  // A single node that goes far costs the segments at it, not a build.
  sample.displacement[5] = Vec3(0, 3 * skin, 0);
  list.update(sample.network, sample.displacement, 1);
  EXPECT_EQ(list.statistics().builds, 1U);
  EXPECT_EQ(list.statistics().insertions, sample.network.degree(NodeIndex{5}));
  // All of them do.
  sample.shift(Vec3::UnitX() * 0.51 * skin);
  list.update(sample.network, sample.displacement, 1);
  EXPECT_EQ(list.statistics().builds, 2U);
  EXPECT_EQ(list.statistics().updates, 23U);
  // A larger radius needs new pairs, a smaller one does not; new indices do.
  sample.shift(Vec3::Zero());
  list.update(sample.network, sample.displacement, 2);
  EXPECT_EQ(list.statistics().builds, 3U);
  list.update(sample.network, sample.displacement, 1);
  EXPECT_EQ(list.statistics().builds, 3U);
  sample.network.clean();
  list.update(sample.network, sample.displacement, 1);
  EXPECT_EQ(list.statistics().builds, 4U);
}

TEST(CandidateList, DoesNotMindNodesThatMoveToAnotherImage)
{
  RandomLines sample(3, 30, 20, 300, Vec3(300, 0, 250));
  CandidateList list;
  list.update(sample.network, {}, 1);
  const std::set<IndexPair> before = as_set(list);
  for (const NodeIndex i : sample.network.nodes())
    sample.network.set_position(i, sample.image(sample.network.position(i)));
  list.update(sample.network, {}, 1);
  EXPECT_EQ(list.statistics().builds, 1U);
  EXPECT_EQ(list.statistics().insertions, 0U);
  EXPECT_EQ(as_set(list), before);
}

TEST(CandidateList, FollowsIndicesThatCleaningHasExchanged)
{
  Network network;
  std::vector<NodeIndex> nodes;
  for (const double x : {0.0, 10.0})
    for (const double z :
         {0.2, 0.0}) // nearer to each other than the skin is wide: the position does not tell them apart
      nodes.push_back(network.insert({Vec3(x, 0, z)}));
  for (const std::size_t k : {0U, 1U})
    network.insert(Segment{nodes[k], nodes[k + 2], Vec3::UnitX(), {}});
  CandidateList list;
  list.update(network, {}, 1);
  network.clean();
  ASSERT_EQ(network.id(SegmentIndex{0}), 1U) << "not exchanged";
  list.update(network, {}, 1);
  expect_sound(network, list, 10);
  EXPECT_EQ(list.pairs().size(), 1U);
}

TEST(CandidateList, ForgetsTheBallsOfAStepWithIt)
{
  Network network;
  const NodeIndex a = network.insert({Vec3(0, 0, 0)}), b = network.insert({Vec3(10, 0, 0)});
  const SegmentIndex s = network.insert(Segment{a, b, Vec3::UnitX(), {}});
  const Vec3 far(500, 0, 0);
  const auto is_near = [&](const CandidateList &list)
  {
    std::vector<SegmentIndex> found;
    list.neighbours(network, far, 1, 1, found);
    return !found.empty();
  };
  CandidateList list;
  list.update(network, {}, 1);
  EXPECT_FALSE(is_near(list));
  list.insert_in_step(network, s, far + Vec3(0, 3, 0), 1.5);
  EXPECT_TRUE(is_near(list));
  list.update(network, {}, 1);
  EXPECT_FALSE(is_near(list));
}

TEST(CandidateList, SaysWhichNodeHasNoFinitePosition)
{
  RandomLines sample(5, 3, 5, 100, Vec3::Zero());
  sample.draw_motion(1, 10);
  sample.displacement[4][1] = NAN;
  CandidateList list;
  EXPECT_THROW(list.update(sample.network, sample.displacement, 1), std::invalid_argument);
  sample.displacement[4][1] = 0;
  list.update(sample.network, sample.displacement, 1);
  EXPECT_EQ(list.statistics().builds, 2U) << "goes on with a list that was left half built";
  sample.displacement[3][2] = INFINITY;
  EXPECT_THROW(list.update(sample.network, sample.displacement, 1), std::invalid_argument);
}

TEST(CandidateList, OfAnEmptyNetworkIsEmpty)
{
  Network network;
  CandidateList list;
  list.update(network, {}, 1);
  EXPECT_TRUE(list.pairs().empty());
  const NodeIndex a = network.insert({Vec3(1, 2, 3)}), b = network.insert({Vec3(1, 2, 9)});
  const SegmentIndex s = network.insert(Segment{a, b, Vec3::UnitX(), {}});
  list.update(network, {}, 1);
  std::vector<SegmentIndex> found;
  list.neighbours(network, Vec3(1, 3, 5), 0.5, 0.6, found);
  EXPECT_EQ(found, std::vector{s});
}
} // namespace
