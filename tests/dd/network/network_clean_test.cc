#include "dd/common/morton.h"
#include "dd/network/network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace
{
using namespace ddfem;

/// Closed loops of random points; objects are inserted in the order that @p seed shuffles, with ids that do not depend
/// on it.
Network random_network(unsigned seed, bool with_holes)
{
  constexpr std::size_t n_loops = 40, n_per_loop = 7;
  std::mt19937 fixed(1), shuffler(seed);
  std::uniform_real_distribution<double> coordinate(-500, 500);
  std::vector<Vec3> positions(n_loops * n_per_loop);
  for (Vec3 &x : positions)
    x = Vec3(coordinate(fixed), coordinate(fixed), coordinate(fixed));
  std::vector<std::size_t> order(positions.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    order[k] = k;
  std::ranges::shuffle(order, shuffler);

  Network network;
  std::vector<NodeIndex> at(positions.size());
  for (const std::size_t k : order)
  {
    if (with_holes && k % 3 == 0)
      network.erase(network.insert(Node{Vec3(1, 2, 3)}, 100000 + k));
    at[k] = network.insert(Node{positions[k]}, k);
  }
  std::ranges::shuffle(order, shuffler);
  for (const std::size_t k : order)
  {
    const std::size_t loop = k / n_per_loop, next = loop * n_per_loop + (k + 1 - loop * n_per_loop) % n_per_loop;
    network.insert(Segment{at[k], at[next], Vec3(0.25, 0, 0), {}}, k);
  }
  return network;
}

TEST(NetworkClean, MortonIndexInterleavesTheBitsOfTheCell)
{
  EXPECT_EQ(morton_index(std::uint64_t{1}, 0, 0), 1u);
  EXPECT_EQ(morton_index(std::uint64_t{0}, 1, 0), 2u);
  EXPECT_EQ(morton_index(std::uint64_t{0}, 0, 1), 4u);
  EXPECT_EQ(morton_index(std::uint64_t{3}, 0, 1), 13u);
  constexpr std::uint64_t last = (std::uint64_t{1} << morton_bits) - 1;
  EXPECT_EQ(morton_index(last, last, last), (std::uint64_t{1} << 63) - 1);
  EXPECT_EQ(morton_index(Vec3(10, 10, 10), Vec3(0, 0, 0), 10), (std::uint64_t{1} << 63) - 1); // upper corner belongs
  EXPECT_EQ(morton_index(Vec3(5, 5, 5), Vec3(5, 5, 5), 0), 0u);
}

TEST(NetworkClean, ArraysAreCompactAndInMortonOrder)
{
  Network network = random_network(3, true);
  network.clean();
  EXPECT_EQ(network.node_capacity(), network.n_nodes());
  EXPECT_EQ(network.segment_capacity(), network.n_segments());
  Vec3 lower = Vec3::Constant(1e9), upper = -lower;
  for (const NodeIndex i : network.nodes())
  {
    lower = lower.cwiseMin(network.position(i));
    upper = upper.cwiseMax(network.position(i));
  }
  std::vector<std::uint64_t> keys;
  for (const NodeIndex i : network.nodes())
    keys.push_back(morton_index(network.position(i), lower, (upper - lower).maxCoeff()));
  EXPECT_TRUE(std::ranges::is_sorted(keys));
  EXPECT_LT(keys.front(), keys.back());
}

TEST(NetworkClean, IdsContentAndChecksumAreKept)
{
  Network network = random_network(3, true);
  const Network before = network;
  const std::uint64_t number = network.checksum();
  network.clean();
  EXPECT_EQ(network.checksum(), number);
  EXPECT_TRUE(network.violations().empty());
  EXPECT_EQ(network.next_node_id(), before.next_node_id());
  for (const NodeIndex i : before.nodes())
  {
    const auto j = network.find_node(before.id(i));
    ASSERT_TRUE(j.has_value());
    EXPECT_EQ(network.position(*j), before.position(i));
    EXPECT_EQ(network.degree(*j), before.degree(i));
  }
  for (const SegmentIndex s : before.segments())
  {
    const auto t = network.find_segment(before.id(s));
    ASSERT_TRUE(t.has_value());
    EXPECT_EQ(network.id(network.start(*t)), before.id(before.start(s)));
    EXPECT_EQ(network.id(network.end(*t)), before.id(before.end(s)));
    EXPECT_EQ(network.find(network.start(*t), network.end(*t)), t);
  }
  EXPECT_FALSE(network.find_node(100000).has_value()); // what was erased stays so
}

TEST(NetworkClean, ChecksumDoesNotDependOnMemoryOrderButOnEveryBit)
{
  Network a = random_network(3, true), b = random_network(8, false);
  EXPECT_EQ(a.checksum(), b.checksum());
  const NodeIndex i = b.nodes()[17];
  const Vec3 x = b.position(i);
  b.set_position(i, Vec3(std::nextafter(x[0], 1e9), x[1], x[2]));
  EXPECT_NE(a.checksum(), b.checksum());
  b.set_position(i, x);
  EXPECT_EQ(a.checksum(), b.checksum());
  b.set_constraint(i, NodeConstraint::pinned);
  EXPECT_NE(a.checksum(), b.checksum());
}

TEST(NetworkClean, MemoryOrderAfterwardsIsAFunctionOfTheContent)
{
  Network a = random_network(3, true), b = random_network(8, false);
  a.clean();
  b.clean();
  ASSERT_EQ(a.node_capacity(), b.node_capacity());
  for (const NodeIndex i : a.nodes())
  {
    EXPECT_EQ(a.id(i), b.id(i));
    EXPECT_TRUE(std::ranges::equal(a.connected_segments(i), b.connected_segments(i)));
  }
  for (const SegmentIndex s : a.segments())
    EXPECT_EQ(a.id(s), b.id(s));
}

TEST(NetworkClean, EmptyAndSingleNodeNetworksAreFine)
{
  Network network;
  network.clean();
  EXPECT_EQ(network.n_nodes(), 0u);
  network.erase(network.insert(Node{Vec3(1, 1, 1)}));
  const NodeIndex kept = network.insert(Node{Vec3(1, 1, 1), NodeConstraint::pinned});
  EXPECT_EQ(kept.value, 1u);
  network.clean();
  EXPECT_EQ(network.find_node(1)->value, 0u);
}
} // namespace
