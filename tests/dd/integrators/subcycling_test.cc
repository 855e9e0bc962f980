// The parts of the forces that subcycling takes apart, and the shorter steps of the nodes that need them.
#include "dd/elasticity/self_force.h"
#include "dd/integrators/far_forces.h"
#include "dd/integrators/local_refinement.h"
#include "dd/microstructure/sources.h"
#include "dd/mobility/linear_glide.h"
#include "samples/dislocation_driver.h"
#include "samples/random_vectors.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <vector>

namespace ddfem
{
namespace
{
constexpr double b = 0.255;
const IsotropicMedium copper{54600, 0.324, b};
const SlipSystems fcc(Lattice::fcc, b *std::numbers::sqrt2);

DriverSettings settings_with(const IntegratorKind kind, const double tolerance)
{
  DriverSettings s{copper, b, linear_glide(1.5e-2, 1.5e-2), {20, 60, 4, 2}, {tolerance, 10, 1e9, 1e-3, 100}};
  s.method = kind;
  s.near_distance = 40;
  s.pair_tolerance = 1e-8;
  return s;
}

/// Lines of 400 nm of random slip systems through a periodic cell of 500 nm, from which many nodes have left.
void add_lines(Network &network, const int n)
{
  samples::RandomVectors random(5);
  for (int k = 0; k < n; ++k)
  {
    FrankReadSource source;
    const SlipSystem &s = fcc[static_cast<std::size_t>(7 * k) % fcc.size()];
    source.plane = s.plane_miller;
    source.burgers = s.burgers;
    source.centre = 250 * random.vector();
    source.length = 400;
    source.character_angle = 37.0 * k;
    add_frank_read_source(network, Orientation{}, source, 45);
  }
}

TEST(NearForces, AreThoseOfTheSegmentItselfItsNeighboursTheAppliedStressAndWhatIsNear)
{
  const PeriodicCell cell{Vec3::Zero(), Vec3(500, 500, 500)};
  DislocationDriver d(settings_with(IntegratorKind::subcycling, 0.1), fcc, &cell);
  add_lines(d.network, 12);
  SymTensor applied;
  applied << 10, -20, 30, 5, -8, 13;
  NearForces near;
  near.update(d.network, {copper, 0.4, 1e-8, 60}, applied);
  const Network &n = d.network;
  std::size_t n_near = 0;
  for (const SegmentIndex s : n.segments())
  {
    const Vec3 x = n.position(n.start(s)), t = n.direction(s), y = x + t;
    SegmentForces f = self_force(copper, x, y, n.burgers(s));
    const SegmentForces core = core_force(copper, {0.4}, x, y, n.burgers(s));
    f.start += core.start + 0.5 * contract(applied, n.burgers(s)).cross(t);
    f.end += core.end + 0.5 * contract(applied, n.burgers(s)).cross(t);
    for (const SegmentIndex r : n.segments())
    {
      if (r == s)
        continue;
      const bool connected =
          n.start(r) == n.start(s) || n.start(r) == n.end(s) || n.end(r) == n.start(s) || n.end(r) == n.end(s);
      // The image whose middle is nearest, found among all.
      Vec3 start = n.position(n.start(r)), best = Vec3::Constant(1e9);
      for (int i = -2; i <= 2; ++i)
        for (int j = -2; j <= 2; ++j)
          for (int k = -2; k <= 2; ++k)
          {
            const Vec3 z = n.position(n.start(r)) + 500 * Vec3(i, j, k);
            if ((z + 0.5 * n.direction(r) - 0.5 * (x + y)).norm() < best.norm())
            {
              best = z + 0.5 * n.direction(r) - 0.5 * (x + y);
              start = z;
            }
          }
      double distance = 1e9;
      for (int i = 0; i <= 40; ++i)
        for (int j = 0; j <= 40; ++j)
          distance = std::min(distance, (x + i / 40.0 * t - start - j / 40.0 * n.direction(r)).norm());
      if (!connected && distance > 60)
        continue;
      n_near += connected ? 0 : 1;
      const SegmentForces g =
          segment_force(copper, start, start + n.direction(r), n.burgers(r), x, y, n.burgers(s), 1e-8);
      f.start += g.start;
      f.end += g.end;
    }
    LineTable scratch;
    const SegmentForces g = near.on(n, s, scratch);
    EXPECT_LT((g.start - f.start).norm() + (g.end - f.end).norm(), 1e-6 * (f.start.norm() + f.end.norm()));
  }
  EXPECT_GT(n_near, 20U);
}

TEST(NearForces, GradientBoundsTheChangeOfTheForceOfParallelLines)
{
  for (const double distance : {2.0, 5.0, 20.0})
  {
    Network n;
    const auto line = [&](const double y) {
      add_line(n, {Vec3(-500, y, 0), Vec3(500, y, 0)}, Vec3(0, 0, b), PlaneIndex{}, false, NodeConstraint::pinned);
    };
    line(0);
    line(distance);
    NearForces near;
    near.update(n, {copper, b, 1e-8, 50}, SymTensor::Zero());
    LineTable scratch;
    const auto force = [&] { return near.on(n, n.segments()[0], scratch).start[1]; };
    const double before = force(), d = 1e-3 * distance;
    for (const NodeIndex i : {n.start(n.segments()[1]), n.end(n.segments()[1])})
      n.set_position(i, n.position(i) + Vec3(0, d, 0));
    const double change = std::abs(force() - before) / d; // of one end: half of the segment
    EXPECT_GE(near.gradient_at_nodes(n)[0], change) << distance;
    EXPECT_LE(near.gradient_at_nodes(n)[0], 4 * change) << distance;
  }
}

TEST(FarForces, CompleteTheNearOnesAndFollowTheLine)
{
  const PeriodicCell cell{Vec3::Zero(), Vec3(500, 500, 500)};
  DislocationDriver d(settings_with(IntegratorKind::subcycling, 0.1), fcc, &cell);
  add_lines(d.network, 12);
  d.applied[5] = 100;
  NearForces near;
  near.update(d.network, {copper, b, 1e-8, 60}, d.applied);
  FarForces far;
  const std::vector<SegmentForces> all = d.forces(d.network).segment_ends;
  far.set_start(d.network, near, all);
  for (const SegmentIndex s : d.network.segments())
  {
    LineTable scratch;
    const SegmentForces f = near.on(d.network, s, scratch), g = far.on(d.network, s, 0.7);
    EXPECT_LT((f.start + g.start - all[s.value].start).norm() + (f.end + g.end - all[s.value].end).norm(),
              1e-6 * (all[s.value].start.norm() + all[s.value].end.norm()));
  }
  // A straight gliding segment that has turned in its plane feels the resolved stress that it felt before.
  const SegmentIndex s = d.network.segments()[3];
  const Vec3 normal = d.network.normal(s), before = d.network.direction(s);
  const double stress = far.on(d.network, s, 0).start.dot(normal.cross(before)) / before.squaredNorm();
  d.network.set_position(d.network.end(s),
                         d.network.position(d.network.end(s)) + 13 * normal.cross(before).normalized());
  const Vec3 t = d.network.direction(s);
  EXPECT_NEAR(far.on(d.network, s, 0).start.dot(normal.cross(t)) / t.squaredNorm(), stress, 1e-9 * std::abs(stress));
}

/// A bowing source with a kink near one end and, 3 nm above it, a line of opposite sign: few nodes are fast.
DislocationDriver source_with_a_fast_place(const IntegratorKind kind, const double tolerance)
{
  DislocationDriver d(settings_with(kind, tolerance), fcc);
  const SlipSystem &s = fcc[0];
  const PlaneIndex plane = d.network.planes().find_or_insert(s.plane_miller, s.normal, Vec3(Vec3::Zero()));
  const PlaneIndex above = d.network.planes().find_or_insert(s.plane_miller, s.normal, Vec3(3 * s.normal));
  const Vec3 e = s.burgers.normalized(), across = s.normal.cross(e);
  std::vector<Vec3> points, others;
  for (int k = 0; k <= 100; ++k)
    points.push_back(40.0 * k * across);
  points.insert(points.begin() + 3, 84 * across + 4 * e);
  for (int k = 0; k <= 3; ++k)
    others.push_back((2000 + 40.0 * k) * across + 8 * e + 3 * s.normal);
  add_line(d.network, points, s.burgers, plane, false, NodeConstraint::pinned);
  add_line(d.network, others, -s.burgers, above, false, NodeConstraint::pinned);
  d.applied = 60 * s.schmid_tensor();
  return d;
}

double largest_difference(const Network &n, const Network &m)
{
  double largest = 0;
  for (const NodeIndex i : n.nodes())
    largest = std::max(largest, (n.position(i) - m.position(i)).norm());
  return largest;
}

IntegratorStep advance_to(DislocationDriver &d, const double end)
{
  IntegratorStep all;
  for (double time = 0; time < end;)
  {
    const IntegratorStep step = d.integrate(end - time);
    for (const NodeIndex i : d.network.nodes())
      d.network.set_position(i, d.network.position(i) + step.displacement[i.value]);
    time = step.dt == end - time ? end : time + step.dt;
    all.evaluations += step.evaluations;
    all.refined_nodes = std::max(all.refined_nodes, step.refined_nodes);
  }
  return all;
}

TEST(Subcycling, ShortStepsStayWhereTheyAreNeeded)
{
  constexpr double end = 0.2; // ns
  DislocationDriver reference = source_with_a_fast_place(IntegratorKind::dormand_prince, 1e-6);
  advance_to(reference, end);
  DislocationDriver d = source_with_a_fast_place(IntegratorKind::subcycling, 0.02);
  const IntegratorStep all = advance_to(d, end);
  EXPECT_GT(all.refined_nodes, 4U);
  EXPECT_LT(all.refined_nodes, d.network.n_nodes() / 2);
  EXPECT_LT(largest_difference(d.network, reference.network), 0.2);
  DislocationDriver stabilised = source_with_a_fast_place(IntegratorKind::stabilised, 0.02);
  EXPECT_LT(5 * all.evaluations, advance_to(stabilised, end).evaluations);
}

TEST(Subcycling, SameBitsOnAnyNumberOfThreads)
{
  const int before = omp_get_max_threads();
  std::vector<std::uint64_t> sums;
  for (const int threads : {1, 3})
  {
    omp_set_num_threads(threads);
    DislocationDriver d = source_with_a_fast_place(IntegratorKind::subcycling, 0.05);
    advance_to(d, 0.05);
    sums.push_back(d.network.checksum());
  }
  omp_set_num_threads(before);
  EXPECT_EQ(sums[0], sums[1]);
}
} // namespace
} // namespace ddfem
