// What holds for every integrator: order, ends of steps, collisions, tries that were rejected.
#include "dd/crystal/material.h"
#include "dd/integrators/chebyshev_steps.h"
#include "dd/microstructure/sources.h"
#include "dd/mobility/linear_glide.h"
#include "samples/dislocation_driver.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace ddfem
{
namespace
{
constexpr double b = 0.255; // nm
const SlipSystems fcc(Lattice::fcc, b *std::numbers::sqrt2);

/// Copper, segments of 20 to 60 nm, capture within 2 nm.
DriverSettings settings_with(const IntegratorKind kind, const double tolerance, const double first_step)
{
  DriverSettings s{
      {54600, 0.324, b}, b, linear_glide(1.5e-2, 1.5e-2), {20, 60, 4, 2}, {tolerance, 1e9, 1e9, first_step, 100}};
  s.pair_tolerance = 1e-10; // a step in the forces by another number of Gauss points limits the order
  s.method = kind;
  s.near_distance = 30;
  return s;
}

/// A source of 300 nm in eight segments that bows under a resolved stress of 60 MPa.
DislocationDriver bowing_source(const IntegratorKind kind, const double tolerance, const double first_step)
{
  DislocationDriver d(settings_with(kind, tolerance, first_step), fcc);
  FrankReadSource source;
  source.plane = fcc[0].plane_miller;
  source.burgers = fcc[0].burgers;
  source.length = 300;
  source.character_angle = 60;
  add_frank_read_source(d.network, Orientation{}, source, 40);
  d.applied = 120 * fcc[0].schmid_tensor();
  return d;
}

void move(Network &network, const IntegratorStep &step)
{
  for (const NodeIndex i : network.nodes())
    network.set_position(i, network.position(i) + step.displacement[i.value]);
}

/// Positions after @p n steps of equal size, without topology.
std::vector<Vec3> bowed(const IntegratorKind kind, const double duration, const int n)
{
  DislocationDriver d = bowing_source(kind, 1e9, duration / n);
  for (int k = 0; k < n; ++k)
  {
    d.integrator->set_suggested_step(duration / n);
    const IntegratorStep step = d.integrate(2 * duration); // no end in sight
    EXPECT_DOUBLE_EQ(step.dt, duration / n);
    move(d.network, step);
  }
  std::vector<Vec3> x;
  for (const NodeIndex i : d.network.nodes())
    x.push_back(d.network.position(i));
  return x;
}

double largest_difference(const std::vector<Vec3> &x, const std::vector<Vec3> &y)
{
  double largest = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    largest = std::max(largest, (x[i] - y[i]).norm());
  return largest;
}

struct Order
{
  IntegratorKind kind;
  double order;
  int n_steps; ///< of the coarser run
};

class EveryIntegrator : public testing::TestWithParam<Order>
{
};

TEST_P(EveryIntegrator, ConvergesAtItsOrderOnABowingSource)
{
  constexpr double duration = 0.01; // ns: the fastest modes, with the largest errors, are still there
  static const std::vector<Vec3> exact = bowed(IntegratorKind::dormand_prince, duration, 160);
  const int n = GetParam().n_steps;
  const double coarse = largest_difference(bowed(GetParam().kind, duration, n), exact);
  const double fine = largest_difference(bowed(GetParam().kind, duration, 2 * n), exact);
  EXPECT_NEAR(std::log2(coarse / fine), GetParam().order, 0.15 * GetParam().order) << coarse << " " << fine;
  EXPECT_LT(coarse, 0.5);
}

TEST_P(EveryIntegrator, RejectedTryLeavesNoTrace)
{
  // Far fields are kept and extrapolated: they would tell if a rejected try had been seen.
  const auto driver = [&](FarFieldCache &cache)
  {
    DislocationDriver d = bowing_source(GetParam().kind, 1e-3, 1e-3);
    d.settings.summation.method = SummationMethod::multipole;
    d.far_field = &cache;
    return d;
  };
  FarFieldCache caches[2]{FarFieldCache({}), FarFieldCache({})};
  DislocationDriver first = driver(caches[0]), second = driver(caches[1]);
  first.settings.integrator.max_displacement = second.settings.integrator.max_displacement = 50;
  for (DislocationDriver *const d : {&first, &second})
  {
    d->integrator = make_integrator(d->settings.method, d->settings.integrator);
    for (int k = 0; k < 3; ++k)
      move(d->network, d->integrate(1));
  }
  ASSERT_EQ(first.network.checksum(), second.network.checksum());
  // Euler has no error that could reject a step.
  first.integrator->set_suggested_step(GetParam().kind == IntegratorKind::forward_euler ? 1e-3 : 0.9);
  const std::uint64_t before = first.network.checksum();
  const IntegratorStep after_rejection = first.integrate(1e9);
  EXPECT_EQ(first.network.checksum(), before);
  if (GetParam().kind != IntegratorKind::forward_euler)
  {
    ASSERT_GT(after_rejection.rejected, 0U);
  }
  second.integrator->set_suggested_step(after_rejection.dt);
  const IntegratorStep direct = second.integrate(1e9);
  EXPECT_EQ(direct.rejected, 0U);
  EXPECT_EQ(direct.dt, after_rejection.dt);
  EXPECT_EQ(direct.error, after_rejection.error);
  EXPECT_EQ(first.integrator->suggested_step(), second.integrator->suggested_step());
  for (int k = 0; k < 3; ++k)
  {
    const IntegratorStep a = k == 0 ? after_rejection : first.integrate(1);
    const IntegratorStep c = k == 0 ? direct : second.integrate(1);
    for (const NodeIndex i : first.network.nodes())
      ASSERT_EQ(a.displacement[i.value], c.displacement[i.value]);
    move(first.network, a);
    move(second.network, c);
  }
}

TEST_P(EveryIntegrator, StepsEndExactlyAtTheLimitWithoutAVanishingRest)
{
  DislocationDriver d = bowing_source(GetParam().kind, 0.05, 2e-3);
  d.integrator->set_suggested_step(2e-3);
  const double end = 0.0203;
  double time = 0, last = 0, before_last = 0;
  while (time < end)
  {
    const double left = end - time;
    const IntegratorStep step = d.integrate(left);
    move(d.network, step);
    before_last = last;
    last = step.dt;
    if (step.dt == left)
      time = end;
    else
    {
      EXPECT_LE(step.dt, 0.5 * left);
      time += step.dt;
    }
  }
  EXPECT_EQ(time, end);
  EXPECT_GT(last, 0.2 * before_last);
}

/// Line along x in a plane z = 0 that a step takes through a line along z.
TEST_P(EveryIntegrator, LosesNoCollisionInALargeStep)
{
  constexpr double h = 1e-3; // ns: Euler is stable
  DislocationDriver d(settings_with(GetParam().kind, 1e9, h), fcc);
  d.remeshing = false;
  const SlipSystem &s = fcc[0];
  const Vec3 e = s.burgers.normalized(), across = s.normal.cross(e);
  const PlaneIndex plane = d.network.planes().find_or_insert(s.plane_miller, s.normal, Vec3(-60 * across));
  std::vector<Vec3> glides, stands;
  for (int k = 0; k <= 10; ++k)
    glides.emplace_back((40.0 * k - 200) * e - 60 * across);
  for (int k = 0; k <= 10; ++k)
    stands.emplace_back(7 * e + (40.0 * k - 203) * s.normal);
  add_line(d.network, glides, s.burgers, plane, false, NodeConstraint::pinned);
  for (const NodeIndex i : add_line(d.network, stands, fcc[5].burgers, PlaneIndex{}, false, NodeConstraint::pinned))
    d.network.set_constraint(i, NodeConstraint::pinned);
  // Towards the other line, 120 nm in the step if it were alone.
  d.applied = 2 * 120 / h * 1.5e-2 / b * s.schmid_tensor();
  const IntegratorStep step = d.integrate(1e9);
  Vec3 moved = Vec3::Zero();
  for (const Vec3 &x : step.displacement)
    if (x.norm() > moved.norm())
      moved = x;
  d.applied *= moved.dot(across) > 0 ? 1 : -1;
  d.integrator->set_suggested_step(h);
  const IntegratorStep taken = d.step(1e9);
  EXPECT_EQ(d.time, taken.dt);
  double farthest = 0;
  for (const Vec3 &x : taken.displacement)
    farthest = std::max(farthest, x.dot(across));
  EXPECT_GT(farthest, 70) << "the step goes beyond the other line";
  EXPECT_GE(d.counts.collisions, 1U);
}

INSTANTIATE_TEST_SUITE_P(
    , EveryIntegrator,
    testing::Values(Order{IntegratorKind::forward_euler, 1, 32}, Order{IntegratorKind::trapezoid, 2, 16},
                    Order{IntegratorKind::bogacki_shampine, 3, 16}, Order{IntegratorKind::dormand_prince, 5, 8},
                    Order{IntegratorKind::stabilised, 2, 16}, Order{IntegratorKind::subcycling, 2, 8}),
    [](const testing::TestParamInfo<Order> &test)
    {
      std::string name = name_of(test.param.kind);
      std::erase_if(name, [](const char c) { return c == ' ' || c == '-'; });
      return name;
    });

TEST(Integrator, ToleranceIsAbsoluteAndRelativeToTheShortestArm)
{
  // The same error passes with a relative part of the tolerance that is worth as much as it lacks.
  for (const double relative : {0.0, 0.01})
  {
    DislocationDriver d = bowing_source(IntegratorKind::bogacki_shampine, 1e-4, 0.01);
    IntegratorSettings s = d.settings.integrator;
    s.relative_tolerance = relative;
    d.integrator = make_integrator(IntegratorKind::bogacki_shampine, s);
    const IntegratorStep step = d.integrate(1e9);
    const double arm = d.network.length(d.network.segments()[0]);
    EXPECT_LE(step.error, 1e-4 + relative * arm);
    EXPECT_EQ(step.error > 1e-4, relative > 0);
  }
}

TEST(ChebyshevSteps, TimesOfStagesAreThoseOfTheExactSolutionOfDyDtEqualsOne)
{
  for (const unsigned s : {2U, 3U, 7U, 40U})
  {
    const ChebyshevSteps method(s);
    std::vector<double> d{0, method[1].mu_tilde};
    EXPECT_NEAR(method.time(1), d[1], 1e-13);
    for (unsigned j = 2; j <= s; ++j)
    {
      const ChebyshevSteps::Coefficients &c = method[j];
      d.push_back(c.mu * d[j - 1] + c.nu * d[j - 2] + c.mu_tilde + c.gamma_tilde);
      EXPECT_NEAR(method.time(j), d[j], 1e-12) << "stage " << j << " of " << s;
    }
    EXPECT_NEAR(d[s], 1, 1e-12);
  }
}
} // namespace
} // namespace ddfem
