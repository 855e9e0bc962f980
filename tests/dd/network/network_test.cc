#include "dd/network/network.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <numeric>
#include <stdexcept>

namespace
{
using namespace ddfem;

const Vec3 b_x(0.25, 0, 0);

/// A closed square loop of four free nodes with b along x in the plane z = 0.
struct SquareLoop
{
  Network network;
  std::array<NodeIndex, 4> nodes;
  std::array<SegmentIndex, 4> segments;
  PlaneIndex plane;

  SquareLoop()
  {
    plane = network.planes().find_or_insert({0, 0, 1}, Vec3(0, 0, 1), 0.0);
    const std::array<Vec3, 4> xs = {Vec3(0, 0, 0), Vec3(10, 0, 0), Vec3(10, 10, 0), Vec3(0, 10, 0)};
    for (std::size_t k = 0; k < 4; ++k)
      nodes[k] = network.insert(Node{xs[k]});
    for (std::size_t k = 0; k < 4; ++k)
      segments[k] = network.insert(Segment{nodes[k], nodes[(k + 1) % 4], b_x, plane});
  }
};

std::string all_messages(const Network &network)
{
  std::string text;
  for (const InvariantViolation &v : network.violations())
    text += v.message + "\n";
  return text;
}

void expect_message(const Network &network, const std::string &part)
{
  EXPECT_NE(all_messages(network).find(part), std::string::npos)
      << "wanted: " << part << "\ngot: " << all_messages(network);
}

TEST(Network, InsertedObjectsAreReadBackAndCounted)
{
  SquareLoop loop;
  EXPECT_EQ(loop.network.n_nodes(), 4u);
  EXPECT_EQ(loop.network.n_segments(), 4u);
  EXPECT_EQ(loop.network.at(loop.nodes[2]).position, Vec3(10, 10, 0));
  EXPECT_EQ(loop.network[loop.segments[1]].start, loop.nodes[1]);
  EXPECT_EQ(loop.network.direction(loop.segments[1]), Vec3(0, 10, 0));
  EXPECT_DOUBLE_EQ(loop.network.length(loop.segments[3]), 10);
  EXPECT_EQ(loop.network.normal(loop.segments[0]), Vec3(0, 0, 1));
  EXPECT_EQ(loop.network.other_end(loop.segments[0], loop.nodes[1]), loop.nodes[0]);
  EXPECT_EQ(loop.network.find_node(2), loop.nodes[2]);
  EXPECT_EQ(loop.network.find_segment(3), loop.segments[3]);
  EXPECT_TRUE(loop.network.violations().empty()) << all_messages(loop.network);
}

TEST(Network, BurgersVectorReversesWithTheLineSense)
{
  SquareLoop loop;
  EXPECT_EQ(loop.network.burgers_from(loop.segments[0], loop.nodes[0]), b_x);
  EXPECT_EQ(loop.network.burgers_from(loop.segments[0], loop.nodes[1]), -b_x);
}

TEST(Network, FindJoinsTwoNodesInEitherSense)
{
  SquareLoop loop;
  EXPECT_EQ(loop.network.find(loop.nodes[3], loop.nodes[0]), loop.segments[3]);
  EXPECT_EQ(loop.network.find(loop.nodes[0], loop.nodes[3]), loop.segments[3]);
  EXPECT_FALSE(loop.network.find(loop.nodes[0], loop.nodes[2]).has_value());
}

TEST(Network, AnIndexKeepsItsMeaningAndAnErasedOneSaysSo)
{
  SquareLoop loop;
  Network &network = loop.network;
  network.erase(loop.segments[0]);
  network.erase(loop.segments[1]);
  network.erase(loop.nodes[1]);
  const NodeIndex added = network.insert(Node{Vec3(5, -5, 0)});
  EXPECT_NE(added, loop.nodes[1]); // the slot is not recycled
  EXPECT_FALSE(network.contains(loop.nodes[1]));
  EXPECT_FALSE(network.contains(loop.segments[0]));
  EXPECT_TRUE(network.contains(loop.nodes[2]));
  EXPECT_EQ(network.position(loop.nodes[2]), Vec3(10, 10, 0));
  EXPECT_EQ(network.id(added), 4u); // ids are not reused either
  EXPECT_FALSE(network.find_node(1).has_value());
  EXPECT_THROW(network.at(loop.nodes[1]), std::out_of_range);
  EXPECT_THROW(network.at(loop.segments[0]), std::out_of_range);
  EXPECT_THROW(network.erase(loop.segments[0]), std::out_of_range);
  EXPECT_EQ(network.nodes().size(), 4u);
  EXPECT_EQ(network.node_capacity(), 5u);
}

TEST(Network, ArmsKeepTheOrderOfInsertionBeyondTheInlineCapacity)
{
  Network network;
  const NodeIndex hub = network.insert(Node{Vec3::Zero(), NodeConstraint::pinned});
  std::vector<SegmentIndex> expected;
  for (int k = 0; k < 9; ++k)
    expected.push_back(network.insert(Segment{hub, network.insert(Node{Vec3(k + 1, 0, 0)}), b_x, {}}));
  const auto equal = [&]()
  {
    const auto arms = network.connected_segments(hub);
    return std::equal(arms.begin(), arms.end(), expected.begin(), expected.end());
  };
  EXPECT_TRUE(equal());
  for (const std::size_t k : {4u, 0u, 6u, 2u, 1u, 1u}) // down to three, from the middle
  {
    network.erase(expected[k]);
    expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(k));
    EXPECT_TRUE(equal());
  }
  expected.push_back(network.insert(Segment{hub, network.insert(Node{Vec3(0, 1, 0)}), b_x, {}}));
  EXPECT_TRUE(equal());
}

TEST(Network, ImpossibleEditsAreRefusedAndLeaveNoTrace)
{
  SquareLoop loop;
  Network &network = loop.network;
  const std::uint64_t before = network.checksum();
  EXPECT_THROW(network.erase(loop.nodes[0]), std::invalid_argument);
  EXPECT_THROW(network.insert(Segment{loop.nodes[1], loop.nodes[0], b_x, loop.plane}), std::invalid_argument);
  EXPECT_THROW(network.insert(Segment{loop.nodes[1], loop.nodes[1], b_x, loop.plane}), std::invalid_argument);
  EXPECT_THROW(network.insert(Segment{loop.nodes[1], NodeIndex{77}, b_x, loop.plane}), std::invalid_argument);
  EXPECT_THROW(network.insert(Segment{loop.nodes[0], loop.nodes[2], b_x, PlaneIndex{9}}), std::invalid_argument);
  EXPECT_THROW(network.insert(Segment{loop.nodes[0], loop.nodes[2], b_x, loop.plane}, 3), std::invalid_argument);
  EXPECT_THROW(network.insert(Node{Vec3::Zero()}, 3), std::invalid_argument);
  EXPECT_THROW(network.set(loop.segments[0], Segment{loop.nodes[1], loop.nodes[0], b_x, {}}), std::invalid_argument);
  EXPECT_THROW(network.set_next_ids(2, 9), std::invalid_argument);
  EXPECT_EQ(network.checksum(), before);
  EXPECT_EQ(network.n_segments(), 4u);
  EXPECT_TRUE(network.violations().empty());
}

TEST(Network, IdsGivenAtRestartAreKeptAndNeverGivenAgain)
{
  Network network;
  const NodeIndex a = network.insert(Node{Vec3::Zero(), NodeConstraint::pinned}, 41);
  const NodeIndex b = network.insert(Node{Vec3(1, 0, 0), NodeConstraint::pinned}, 7);
  network.insert(Segment{a, b, b_x, {}}, 100);
  EXPECT_EQ(network.next_node_id(), 42u);
  EXPECT_EQ(network.next_segment_id(), 101u);
  network.set_next_ids(50, 200);
  EXPECT_EQ(network.id(network.insert(Node{Vec3(2, 0, 0)})), 50u);
}

TEST(Network, PhysicalNodesAreEndsJunctionsConstraintsAndChangesOfBurgersVectorOrPlane)
{
  SquareLoop loop;
  Network &network = loop.network;
  for (const NodeIndex i : network.nodes())
    EXPECT_FALSE(network.is_physical(i));
  Segment changed = network.get(loop.segments[0]);
  changed.plane = network.planes().find_or_insert({0, 1, 0}, Vec3(0, 1, 0), 0.0);
  network.set(loop.segments[0], changed); // cross-slipped: both ends see two planes
  EXPECT_TRUE(network.is_physical(loop.nodes[0]));
  EXPECT_TRUE(network.is_physical(loop.nodes[1]));
  EXPECT_FALSE(network.is_physical(loop.nodes[2]));
  network.set_constraint(loop.nodes[2], NodeConstraint::pinned);
  EXPECT_TRUE(network.is_physical(loop.nodes[2]));
  network.insert(Segment{loop.nodes[3], loop.nodes[1], b_x, {}});
  EXPECT_TRUE(network.is_physical(loop.nodes[3]));
}

TEST(Network, PeriodicSegmentRunsToTheNearestImageOfItsEnd)
{
  Network network;
  network.set_period(Vec3(100, 0, 0));
  const NodeIndex a = network.insert(Node{Vec3(95, 0, 0), NodeConstraint::pinned});
  const NodeIndex b = network.insert(Node{Vec3(5, 70, 0), NodeConstraint::pinned});
  const SegmentIndex s = network.insert(Segment{a, b, b_x, {}});
  EXPECT_EQ(network.direction(s), Vec3(10, 70, 0));
  EXPECT_THROW(network.set_period(Vec3(-1, 0, 0)), std::invalid_argument);
}

TEST(Network, TraversalsVisitEachLiveObjectOnceWithAnyNumberOfThreads)
{
  Network network;
  std::vector<NodeIndex> nodes;
  for (int k = 0; k < 1000; ++k)
    nodes.push_back(network.insert(Node{Vec3(k, 0, 0)}));
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k)
    network.insert(Segment{nodes[k], nodes[k + 1], b_x, {}});
  for (const std::uint32_t k : {0u, 499u, 998u})
    network.erase(SegmentIndex{k});
  network.erase(nodes[0]);
  const int threads_before = omp_get_max_threads();
  for (const int n_threads : {1, 2})
  {
    omp_set_num_threads(n_threads);
    std::vector<int> of_node(network.node_capacity()), of_segment(network.segment_capacity()),
        of_star(network.node_capacity()), of_loop(network.node_capacity());
    network.for_each_node([&](NodeIndex i) { ++of_node[i.value]; });
    network.for_each_segment([&](SegmentIndex s, NodeIndex start, NodeIndex end)
                             { of_segment[s.value] += start == network.start(s) && end == network.end(s) ? 1 : 100; });
    network.for_each_node_with_segments([&](NodeIndex i, std::span<const SegmentIndex> arms)
                                        { of_star[i.value] += arms.size() == network.degree(i) ? 1 : 100; });
#pragma omp parallel
    {
#pragma omp for
      for (const NodeIndex i : network.nodes())
        ++of_loop[i.value];
    }
    for (std::uint32_t k = 0; k < network.node_capacity(); ++k)
    {
      const int expected = network.contains(NodeIndex{k}) ? 1 : 0;
      EXPECT_EQ(of_node[k], expected);
      EXPECT_EQ(of_star[k], expected);
      EXPECT_EQ(of_loop[k], expected);
    }
    for (std::uint32_t k = 0; k < network.segment_capacity(); ++k)
      EXPECT_EQ(of_segment[k], network.contains(SegmentIndex{k}) ? 1 : 0);
  }
  omp_set_num_threads(threads_before);
}

TEST(Network, ExceptionOfATraversedFunctionReachesTheCaller)
{
  SquareLoop loop;
  EXPECT_THROW(loop.network.for_each_node(
                   [](NodeIndex i)
                   {
                     if (i.value == 2)
                       throw std::domain_error("two");
                   }),
               std::domain_error);
}

TEST(Network, ViolationsNameTheNodeWhereBurgersVectorsDoNotBalance)
{
  SquareLoop loop;
  Segment s = loop.network.get(loop.segments[1]);
  s.burgers = Vec3(0.25, 0.1, 0);
  loop.network.set(loop.segments[1], s);
  EXPECT_EQ(loop.network.violations().size(), 2u);
  expect_message(loop.network, "free node 1 at (10, 0, 0) nm: the Burgers vectors that leave it add up to (0, 0.1, 0)");
  loop.network.set_constraint(loop.nodes[1], NodeConstraint::pinned);
  EXPECT_EQ(loop.network.violations().size(), 1u); // pinned nodes need not balance
  EXPECT_THROW(loop.network.check_invariants(), std::runtime_error);
}

TEST(Network, ViolationsNameEveryKindOfBrokenInvariant)
{
  {
    SquareLoop loop;
    loop.network.set_position(loop.nodes[2], Vec3(10, 10, 1e-3));
    expect_message(loop.network, "segment 1 from free node 1 at (10, 0, 0) nm to free node 2 at (10, 10, 0.001) nm: "
                                 "the line leaves the glide plane");
    expect_message(loop.network, "its end is 0.001 nm off the glide plane");
    expect_message(loop.network, "its start is 0.001 nm off the glide plane");
  }
  {
    SquareLoop loop;
    for (const SegmentIndex s : loop.network.segments())
      loop.network.set(s, Segment{loop.network.start(s), loop.network.end(s), Vec3(0.25, 0, 0.01), loop.plane});
    expect_message(loop.network, "its Burgers vector (0.25, 0, 0.01) nm leaves the glide plane by 0.01 nm");
  }
  {
    SquareLoop loop;
    loop.network.set_position(loop.nodes[1], Vec3(0, 0, 0));
    expect_message(loop.network, "segment 0 from free node 0 at (0, 0, 0) nm to free node 1 at (0, 0, 0) nm: its "
                                 "length");
    loop.network.set_position(loop.nodes[1], Vec3(std::nan(""), 0, 0));
    expect_message(loop.network, "its position is not finite");
  }
  {
    SquareLoop loop;
    loop.network.set_constraint(loop.nodes[0], NodeConstraint::surface);
    expect_message(loop.network, "surface node 0 at (0, 0, 0) nm: a surface node must have one arm, this one has 2");
    loop.network.erase(loop.segments[0]);
    expect_message(loop.network, "free node 1 at (10, 0, 0) nm: a free node must have at least two arms");
  }
}
} // namespace
