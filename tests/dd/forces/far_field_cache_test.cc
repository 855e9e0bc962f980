// A far field that is kept over several evaluations: against one that is new every time.
#include "dd/forces/far_field_cache.h"
#include "dd/forces/nodal_forces.h"
#include "tests/dd/fmm/systems_of_lines.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace ddfem
{
namespace
{
using namespace test;

constexpr double tolerance = 1e-3;

/// Straight lines of 24 segments of 25 nm, of loops of lines that cross the boundaries of a cell of 1000 nm.
LinesOfTest straight_lines(const bool periodic)
{
  const Vec3 origin = Vec3::Constant(-500), lengths = Vec3::Constant(1000);
  LinesOfTest t = periodic ? periodic_loops(0, origin, lengths, 7) : random_loops(0);
  RandomVectors random(8);
  for (int k = 0; k < 140; ++k)
  {
    const Vec3 middle = 500 * random.vector(), half = 300 * random.vector().normalized();
    add_line(t.network, middle - half, middle + half, 24, NodeConstraint::pinned, 0.25 * random.vector().normalized());
  }
  return t;
}

/// Forces on the ends of all segments.
std::vector<Vec3> forces(const LinesOfTest &lines, FarFieldCache *const cache)
{
  ForceSettings settings{copper_like, copper_like.a, 1e-6};
  settings.summation = {SummationMethod::multipole, tolerance};
  ForceEnvironment environment;
  environment.shape = lines.shape.get();
  environment.cell = lines.cell.get();
  environment.images = lines.images.get();
  environment.far_field = cache;
  const NodalForces f = compute_nodal_forces(lines.network, settings, environment, MPI_COMM_SELF);
  std::vector<Vec3> ends;
  for (const SegmentIndex s : lines.network.segments())
  {
    ends.push_back(f.segment_ends[s.value].start);
    ends.push_back(f.segment_ends[s.value].end);
  }
  return ends;
}

double distance(const std::vector<Vec3> &a, const std::vector<Vec3> &b)
{
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum);
}

/// Error of the forces relative to what distant boxes add to them.
double error_of(const LinesOfTest &lines, const std::vector<Vec3> &value)
{
  FarFieldCache none({FarFieldRefresh::never});
  const std::vector<Vec3> exact = forces(lines, nullptr);
  return distance(value, exact) / distance(forces(lines, &none), exact);
}

/// Every node moves at its own velocity, by @p size nm on average.
void move(Network &network, const double size)
{
  for (const NodeIndex i : network.nodes())
  {
    RandomVectors random(static_cast<unsigned>(network.id(i)) + 1);
    if (network.constraint(i) == NodeConstraint::free)
      network.set_position(i, network.position(i) + size * random.vector());
  }
}

void remove_node(Network &network, const NodeIndex i)
{
  const SegmentIndex before = network.connected_segments(i)[0], after = network.connected_segments(i)[1];
  const Segment joined{network.other_end(before, i), network.other_end(after, i), -network.burgers_from(before, i), {}};
  network.erase(before);
  network.erase(after);
  network.erase(i);
  network.insert(joined);
}

void insert_node(Network &network, const SegmentIndex s)
{
  const Segment old = network[s];
  const NodeIndex middle = network.insert({network.position(old.start) + 0.5 * network.direction(s)});
  network.erase(s);
  network.insert(Segment{old.start, middle, old.burgers, {}});
  network.insert(Segment{middle, old.end, old.burgers, {}});
}

class FarFieldCacheIn : public testing::TestWithParam<bool>
{
};

TEST_P(FarFieldCacheIn, GivesTheSameBitsWhereNothingHasMoved)
{
  const LinesOfTest lines = straight_lines(GetParam());
  FarFieldCache cache({FarFieldRefresh::adaptive});
  cache.begin_step();
  const std::vector<Vec3> refreshed = forces(lines, &cache), kept = forces(lines, &cache);
  EXPECT_EQ(cache.counts().kept, 1U);
  EXPECT_TRUE(refreshed == forces(lines, nullptr));
  EXPECT_TRUE(kept == refreshed);
}

TEST_P(FarFieldCacheIn, FollowsNodesThatAreInsertedAndRemoved)
{
  LinesOfTest lines = straight_lines(GetParam());
  FarFieldCache cache({FarFieldRefresh::every_n_steps});
  cache.begin_step();
  forces(lines, &cache);
  const std::vector<NodeIndex> nodes(lines.network.nodes().begin(), lines.network.nodes().end());
  for (std::size_t k = 0; k < nodes.size(); k += 5)
    if (lines.network.degree(nodes[k]) == 2)
      remove_node(lines.network, nodes[k]);
  const std::vector<SegmentIndex> segments(lines.network.segments().begin(), lines.network.segments().end());
  for (std::size_t k = 0; k < segments.size(); k += 7)
    insert_node(lines.network, segments[k]);
  const std::vector<Vec3> kept = forces(lines, &cache);
  EXPECT_EQ(cache.counts().kept, 1U);
  // The lines are where they were: what remains is the error of the method itself.
  EXPECT_LT(error_of(lines, kept), tolerance);std::printf("error %.2e\n",error_of(lines, kept));
}

INSTANTIATE_TEST_SUITE_P(InfiniteAndPeriodic, FarFieldCacheIn, testing::Bool());
} // namespace
} // namespace ddfem
