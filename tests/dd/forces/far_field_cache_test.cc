// A far field that is kept over several evaluations: against one that is new every time.
#include "dd/crystal/material.h"
#include "dd/forces/far_field_cache.h"
#include "dd/forces/nodal_forces.h"
#include "samples/dislocation_driver.h"
#include "samples/systems_of_lines.h"
#include "samples/values.h"
#include "tests/dd/topology/random_networks.h"

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
using namespace samples;

constexpr double tolerance = 1e-3;

enum class Surroundings
{
  infinite,
  periodic,
  finite
};

/// Adds a line through a cube of 1000 nm, from face to face.
void add_line_through_cube(Network &network, const Eigen::Index axis, RandomVectors &random)
{
  Vec3 start = 450 * random.vector(), end = start + 250 * random.vector();
  end = end.cwiseMax(-450).cwiseMin(450);
  start[axis] = -500;
  end[axis] = 500;
  add_line(network, start, end, 24, NodeConstraint::surface, 0.25 * random.vector().normalized());
}

/// Straight lines of 24 segments of 25 nm, of which some cross the boundaries of the periodic cell, or of 42 nm, which end at the
/// surface of a finite cube.
SampleLines straight_lines(const Surroundings surroundings)
{
  const Vec3 origin = Vec3::Constant(-500), lengths = Vec3::Constant(1000);
  SampleLines t = surroundings == Surroundings::periodic ? periodic_loops(0, origin, lengths, 7) : random_loops(0);
  RandomVectors random(8);
  if (surroundings == Surroundings::finite)
  {
    t.shape = std::make_unique<BoxShape>(origin, origin + lengths);
    for (Eigen::Index k = 0; k < (sanitized ? 60 : 100); ++k)
      add_line_through_cube(t.network, k % 3, random);
    return t;
  }
  for (int k = 0; k < (sanitized ? 80 : 140); ++k)
  {
    const Vec3 middle = 500 * random.vector(), half = 300 * random.vector().normalized();
    add_line(t.network, middle - half, middle + half, 24, NodeConstraint::pinned, 0.25 * random.vector().normalized());
  }
  return t;
}

/// Forces on the ends of all segments.
std::vector<Vec3> forces(const SampleLines &lines, FarFieldCache *const cache)
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
double error_of(const SampleLines &lines, const std::vector<Vec3> &value)
{
  FarFieldCache none({FarFieldRefresh::never});
  const std::vector<Vec3> exact = forces(lines, nullptr);
  return distance(value, exact) / distance(forces(lines, &none), exact);
}

/// Every node moves at its own velocity, by @p size nm on average; those at the surface along it.
void move(Network &network, const double size)
{
  for (const NodeIndex i : network.nodes())
  {
    RandomVectors random(static_cast<unsigned>(network.id(i)) + 1);
    Vec3 displacement = size * random.vector();
    if (network.constraint(i) == NodeConstraint::surface)
      displacement = (network.position(i).array().abs() > 499.9).select(0, displacement);
    if (network.constraint(i) != NodeConstraint::pinned)
      network.set_position(i, network.position(i) + displacement);
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

class FarFieldCacheIn : public testing::TestWithParam<Surroundings>
{
};

TEST_P(FarFieldCacheIn, GivesTheSameBitsWhereNothingHasMoved)
{
  const SampleLines lines = straight_lines(GetParam());
  FarFieldCache cache({FarFieldRefresh::adaptive});
  cache.begin_step();
  const std::vector<Vec3> refreshed = forces(lines, &cache), kept = forces(lines, &cache);
  EXPECT_EQ(cache.counts().kept, 1U);
  EXPECT_TRUE(refreshed == forces(lines, nullptr));
  EXPECT_TRUE(kept == refreshed);
}

TEST_P(FarFieldCacheIn, FollowsNodesThatAreInsertedAndRemoved)
{
  SampleLines lines = straight_lines(GetParam());
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
  EXPECT_LT(error_of(lines, kept), tolerance);
}

TEST_P(FarFieldCacheIn, HasAnErrorInProportionToTheDisplacement)
{
  SampleLines lines = straight_lines(GetParam());
  FarFieldCache cache({FarFieldRefresh::every_n_steps});
  cache.begin_step();
  forces(lines, &cache);
  std::vector<double> errors;
  for (const double size : {0.25, 0.25, 0.5})
  {
    move(lines.network, size);
    errors.push_back(error_of(lines, forces(lines, &cache)));
  }
  EXPECT_EQ(cache.counts().kept, 3U);
  EXPECT_GT(errors[0], 0.5 * tolerance);
  EXPECT_NEAR(errors[1] / errors[0], 2, 0.3);
  EXPECT_NEAR(errors[2] / errors[1], 2, 0.3);
}

TEST_P(FarFieldCacheIn, ExtrapolatesAlongTheMotionOfTheLines)
{
  SampleLines lines = straight_lines(GetParam());
  FarFieldCache cache({FarFieldRefresh::adaptive});
  const unsigned n_steps = sanitized ? 9 : 40;
  double largest = 0;
  for (unsigned step = 0; step < n_steps; ++step)
  {
    cache.begin_step();
    const std::vector<Vec3> value = forces(lines, &cache);
    if (step % 3 == 2)
      largest = std::max(largest, error_of(lines, value));
    move(lines.network, 0.25); // an error of more than the tolerance without a refresh or extrapolation
  }
  EXPECT_LT(largest, tolerance);
  EXPECT_LT(cache.counts().refreshed, 15U);
  EXPECT_EQ(cache.counts().refreshed + cache.counts().kept, n_steps);
}

TEST_P(FarFieldCacheIn, IsNotChangedByEvaluationsWithinAStep)
{
  SampleLines lines = straight_lines(GetParam());
  FarFieldCache cache({FarFieldRefresh::adaptive}), undisturbed({FarFieldRefresh::adaptive});
  for (int step = 0; step < (sanitized ? 3 : 6); ++step)
  {
    cache.begin_step();
    undisturbed.begin_step();
    const std::vector<Vec3> before = forces(lines, &cache);
    EXPECT_TRUE(before == forces(lines, &undisturbed)) << step;
    for (const double size : {0.1, 2.0}) // attempts that are rejected
    {
      const Network present = lines.network;
      move(lines.network, size);
      forces(lines, &cache);
      lines.network = present;
    }
    EXPECT_TRUE(before == forces(lines, &cache)) << step;
    move(lines.network, 0.1);
  }
  EXPECT_GT(cache.counts().kept, undisturbed.counts().kept);
  EXPECT_GT(cache.counts().without, 0U);
}

TEST_P(FarFieldCacheIn, DoesNotDependOnTheNumberOfThreads)
{
  const int threads = omp_get_max_threads();
  std::vector<std::vector<Vec3>> values;
  for (const int n : {1, 2})
  {
    omp_set_num_threads(n);
    SampleLines lines = straight_lines(GetParam());
    FarFieldCache cache({FarFieldRefresh::adaptive});
    for (int step = 0; step < 4; ++step)
    {
      cache.begin_step();
      values.push_back(forces(lines, &cache));
      move(lines.network, 0.1);
    }
    EXPECT_GT(cache.counts().kept, 0U);
  }
  omp_set_num_threads(threads);
  for (std::size_t step = 0; step < 4; ++step)
    EXPECT_TRUE(values[step] == values[step + 4]) << step;
}

TEST(FarFieldCache, FollowsLinesThatLeaveAndEnterWithTheirRays)
{
  SampleLines lines = straight_lines(Surroundings::finite);
  Network &network = lines.network;
  FarFieldCache cache({FarFieldRefresh::adaptive});
  cache.begin_step();
  forces(lines, &cache);
  const std::vector<SegmentIndex> segments(network.segments().begin(), network.segments().end());
  for (std::size_t k = 48; k < 72; ++k) // the third line
    network.erase(segments[k]);
  RandomVectors random(9);
  add_line_through_cube(network, 1, random);
  // A line whose end goes on over an edge of the cube, where its ray turns.
  const NodeIndex end = network.start(segments[0]);
  network.set_position(end, Vec3(network.position(end)[0] + 0.5, 500, network.position(end)[2]));
  const std::vector<Vec3> kept = forces(lines, &cache);
  EXPECT_EQ(cache.counts().kept, 1U);
  EXPECT_LT(error_of(lines, kept), tolerance);
  // The new lines are in the boxes from the next refresh on.
  cache.begin_step();
  move(network, 0.1);
  EXPECT_LT(error_of(lines, forces(lines, &cache)), tolerance);
}

TEST(FarFieldCache, GivesTheSameBitsAsANewOneWhenItHasForgotten)
{
  SampleLines lines = straight_lines(Surroundings::infinite);
  FarFieldCache cache({FarFieldRefresh::adaptive}), restarted({FarFieldRefresh::adaptive});
  const auto step = [&](FarFieldCache &which)
  {
    which.begin_step();
    return forces(lines, &which);
  };
  for (int k = 0; k < 3; ++k)
  {
    step(cache);
    move(lines.network, 0.1);
  }
  cache.forget();
  for (int k = 0; k < 3; ++k)
  {
    EXPECT_TRUE(step(cache) == step(restarted)) << k;
    move(lines.network, 0.1);
  }
  EXPECT_GT(restarted.counts().kept, 0U);
}

/// Loops and lines of aluminium under stress, in a periodic cell.
DislocationDriver moving_network(const SlipSystems &systems, const PeriodicCell &cell)
{
  const Material &m = find_material("aluminium");
  DriverSettings settings{
      {m.mu, m.nu, m.burgers_magnitude}, m.burgers_magnitude, linear_glide(m.drag, m.drag), {}, {}, 1e-4};
  settings.topology.min_area = 15;
  settings.topology.collision_radius = 1.25;
  settings.summation = {SummationMethod::multipole, tolerance};
  DislocationDriver driver(settings, systems, &cell);
  Random random(1);
  add_random_lines(driver.network, systems, random, cell.lengths[0], 20, 3000, nullptr);
  driver.applied = SymTensor(0, 0, 300, 0, 0, 150);
  return driver;
}

/// Forces of all segments' ends.
std::vector<Vec3> ends_of(const NodalForces &f)
{
  std::vector<Vec3> ends;
  for (const SegmentForces &s : f.segment_ends)
    ends.insert(ends.end(), {s.start, s.end});
  return ends;
}

TEST(FarFieldCache, KeepsTheToleranceInARunWithChangesOfTopology)
{
  const SlipSystems systems(Lattice::fcc, find_material("aluminium").lattice_parameter);
  const PeriodicCell cell{Vec3::Zero(), Vec3::Constant(1100)};
  DislocationDriver driver = moving_network(systems, cell);
  FarFieldCache cache({FarFieldRefresh::adaptive}), none({FarFieldRefresh::never});
  const auto forces_with = [&](FarFieldCache *const which)
  {
    driver.far_field = which;
    return ends_of(driver.forces(driver.network));
  };
  double largest = 0;
  for (int step = 0; step < (sanitized ? 3 : 24); ++step)
  {
    driver.far_field = &cache;
    driver.step(1e9);
    if (step % 3 != 2)
      continue;
    const std::vector<Vec3> kept = forces_with(&cache), exact = forces_with(nullptr);
    largest = std::max(largest, distance(kept, exact) / distance(forces_with(&none), exact));
  }
  EXPECT_LT(largest, tolerance);
  if (sanitized) // too few steps for what follows
    return;
  EXPECT_GT(cache.counts().kept, cache.counts().refreshed + cache.counts().without);
  EXPECT_GT(driver.counts.collisions + driver.counts.coarsenings, 10U);
}

INSTANTIATE_TEST_SUITE_P(All, FarFieldCacheIn,
                         testing::Values(Surroundings::infinite, Surroundings::periodic, Surroundings::finite));
} // namespace
} // namespace ddfem
