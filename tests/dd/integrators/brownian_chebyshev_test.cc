#include "dd/elasticity/self_force.h"
#include "dd/integrators/brownian_chebyshev.h"
#include "dd/microstructure/sources.h"
#include "dd/mobility/linear_glide.h"
#include "samples/statistics.h"
#include "samples/thermal_run.h"
#include "tests/support/one_thread.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ddfem
{
namespace
{
constexpr double half_length = 10; ///< nm

/// A line of @p pieces segments along x between pins at -half_length and half_length, b = 0.25 ex, in the plane z = 0.
Network pinned_line(const int pieces)
{
  Network n;
  const PlaneIndex plane = n.planes().find_or_insert({0, 0, 1}, Vec3::UnitZ(), Vec3(Vec3::Zero()));
  std::vector<Vec3> points;
  for (int k = 0; k <= pieces; ++k)
    points.emplace_back(half_length * (2.0 * k / pieces - 1), 0, 0);
  add_line(n, points, Vec3(0.25, 0, 0), plane, false, NodeConstraint::pinned);
  return n;
}

const IntegratorSettings no_limits{1, 1e6, 1e9, 1, 1};

/// One node between two pins that is drawn back with rate lambda (1/ns) along y, and one given random displacement.
IntegratorStep linear_step(const double lambda, const double dt, const double y, const double q)
{
  Network n = pinned_line(2);
  const NodeIndex middle = *n.find_node(1);
  n.set_position(middle, Vec3(0, y, 0));
  BrownianMotion motion;
  motion.velocity = [&](const Network &net)
  {
    std::vector<Vec3> v(net.node_capacity(), Vec3::Zero());
    v[middle.value][1] = -lambda * net.position(middle)[1];
    return v;
  };
  motion.mobility = [&](const Network &, const std::vector<Vec3> &force) { return force; };
  motion.thermal_force = [&](const Network &net, const double h)
  {
    std::vector<Vec3> r(net.node_capacity(), Vec3::Zero());
    r[middle.value][1] = q / h;
    return r;
  };
  return BrownianChebyshev(no_limits).advance(n, motion, lambda, dt);
}

TEST(BrownianChebyshev, StationaryVarianceOfAModeIsKtOverItsStiffnessForAnyNumberOfStages)
{
  for (const auto &[z, s] :
       {std::pair(0.01, 1U), {0.2, 1U}, {0.4, 1U}, {0.5, 2U}, {1.0, 2U}, {1.6, 2U}, {2.0, 3U}, {3.0, 3U}, {3.6, 3U}})
  {
    const double dt = 0.7, lambda = z / dt;
    const IntegratorStep from_one = linear_step(lambda, dt, 1, 0), by_noise = linear_step(lambda, dt, 0, 1);
    EXPECT_EQ(from_one.stages, s);
    EXPECT_EQ(from_one.evaluations, s + 2);
    EXPECT_DOUBLE_EQ(from_one.dt, dt);
    // x' = A x + B q with <q^2> = 2 kT dt/D = 2 z kT/K: the variance is that of the autoregressive process.
    const double a = 1 + from_one.displacement[1][1], b = by_noise.displacement[1][1];
    const double variance = 2 * z * b * b / (1 - a * a);
    const double u = z / (s * s);
    EXPECT_NEAR(variance, std::pow(1 - u / 4, 2) / (1 - u / 2), 1e-9) << z;
    EXPECT_NEAR(variance, 1, 0.013) << z;
  }
}

TEST(BrownianChebyshev, StepIsLimitedByStiffnessSpeedAndNoiseBeforeAnythingIsDrawn)
{
  EXPECT_DOUBLE_EQ(linear_step(8.0, 1e3, 1, 0).dt, 3.6 / 8.0);
  Network n = pinned_line(4);
  const std::uint64_t before = n.checksum();
  BrownianMotion motion;
  motion.velocity = [](const Network &net) { return std::vector<Vec3>(net.node_capacity(), Vec3(0, 3, 0)); };
  motion.mobility = [](const Network &, const std::vector<Vec3> &force) { return force; };
  motion.thermal_force = [](const Network &net, double)
  { return std::vector<Vec3>(net.node_capacity(), Vec3::Zero()); };
  IntegratorSettings settings = no_limits;
  settings.max_displacement = 6;
  EXPECT_DOUBLE_EQ(BrownianChebyshev(settings).advance(n, motion, 0.1, 1e3).dt, 2);
  motion.diffusivity = 7.2; // a rms displacement of sqrt(2 x 7.2 x 0.1) = 1.2 in 0.1 ns
  EXPECT_DOUBLE_EQ(BrownianChebyshev(settings).advance(n, motion, 0.1, 1e3).dt, 0.1);
  EXPECT_DOUBLE_EQ(BrownianChebyshev(settings).advance(n, motion, 0.1, 0.03).dt, 0.03);
  EXPECT_EQ(n.checksum(), before);
  motion.velocity = [](const Network &net)
  { return std::vector<Vec3>(net.node_capacity(), Vec3::Constant(std::numeric_limits<double>::quiet_NaN())); };
  EXPECT_THROW(BrownianChebyshev(settings).advance(n, motion, 0.1, 1), std::runtime_error);
}

const IsotropicMedium medium{1000, 0.3, 1.0};
const double core_cutoff = std::exp(-1.0);

/// One free node between two pins, moved by the core energy, with a drag that depends on the character.
samples::ThermalRun short_line()
{
  const HeatBath bath{30, 1, 0}; // kT of the order of the line's energy, so that the arms turn by large angles
  return {pinned_line(2), samples::core_forces(medium, core_cutoff), linear_glide(4, 1), bath};
}

double energy(const Network &network)
{
  double sum = 0;
  for (const SegmentIndex s : network.segments())
    sum += core_energy(medium, CoreEnergy{core_cutoff}, network.position(network.start(s)),
                       network.position(network.end(s)), network.burgers(s));
  return sum;
}

/// sin^2 of the angle by which the arms of the middle node are turned, averaged over its height y with the weight of exp(-E/kT) or,
/// without the drift, of D exp(-E/kT): what is stationary for dx = f/D dt + sqrt(2 kT/D) dW in the sense of Ito.
double expected_tilt(samples::ThermalRun line, const bool weighted_by_drag)
{
  const NodeIndex middle = *line.network.find_node(1);
  double sum = 0, norm = 0;
  for (double y = -40 * half_length; y <= 40 * half_length; y += 0.01 * half_length)
  {
    line.network.set_position(middle, Vec3(0, y, 0));
    double weight = std::exp(-energy(line.network) / line.bath.kT);
    if (weighted_by_drag)
      weight *= nodal_drag(line.network, middle, *line.law);
    sum += weight * y * y / (half_length * half_length + y * y);
    norm += weight;
  }
  return sum / norm;
}

/// The same average over a run.
Estimate measured_tilt(samples::ThermalRun line)
{
  const NodeIndex middle = *line.network.find_node(1);
  std::vector<double> tilt;
  for (int k = 0; k < 100000; ++k)
  {
    // The error of this step is below one standard deviation of the mean, and falls with it.
    line.step(1.0, 0.3);
    const double y = line.network.position(middle)[1];
    tilt.push_back(y * y / (half_length * half_length + y * y));
  }
  return estimate_by_blocks(tilt, 100);
}

TEST(BrownianChebyshev, ShortLineWithCharacterDependentDragTakesTheBoltzmannDistribution)
{
  const OneThread guard;
  samples::ThermalRun line = short_line();
  const double boltzmann = expected_tilt(line, false), ito = expected_tilt(line, true);
  const Estimate right = measured_tilt(line);
  EXPECT_NEAR(right.mean, boltzmann, 4 * right.error);
  line.with_drift = false;
  const Estimate wrong = measured_tilt(line);
  EXPECT_NEAR(wrong.mean, ito, 4 * wrong.error);
  EXPECT_GT(ito - boltzmann, 10 * right.error);
  EXPECT_GT(ito - boltzmann, 10 * wrong.error);
}
} // namespace
} // namespace ddfem
