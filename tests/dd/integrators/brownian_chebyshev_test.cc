#include "dd/elasticity/self_force.h"
#include "dd/integrators/brownian_chebyshev.h"
#include "dd/microstructure/sources.h"
#include "dd/mobility/linear_glide.h"
#include "dd/mobility/thermal_force.h"
#include "tests/dd/integrators/statistics.h"
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

/// A line that is moved by its core energy and a heat bath.
struct ThermalLine
{
  Network network;
  LinearGlide law{4, 1}; ///< edge, screw
  IsotropicMedium medium{1000, 0.3, 1.0};
  CoreEnergy core{std::exp(-1.0)};
  HeatBath bath{};
  bool with_drift = true;

  double energy(const NodeIndex i) const
  {
    double sum = 0;
    for (const SegmentIndex s : network.connected_segments(i))
      sum += core_energy(medium, core, network.position(network.start(s)), network.position(network.end(s)),
                         network.burgers(s));
    return sum;
  }

  std::vector<Vec3> velocity(const Network &n) const
  {
    std::vector<Vec3> force(n.node_capacity(), Vec3::Zero());
    for (const SegmentIndex s : n.segments())
    {
      const SegmentForces f = core_force(medium, core, n.position(n.start(s)), n.position(n.end(s)), n.burgers(s));
      force[n.start(s).value] += f.start;
      force[n.end(s).value] += f.end;
    }
    return glide_velocities(n, force, law, nullptr);
  }

  BrownianMotion motion()
  {
    BrownianMotion m;
    m.velocity = [this](const Network &n) { return velocity(n); };
    m.mobility = [this, start = network](const Network &n, const std::vector<Vec3> &force)
    { return glide_velocities(with_drift ? n : start, force, law, nullptr); };
    m.thermal_force = [this](const Network &n, const double dt)
    {
      return thermal_forces(
          n,
          [&](const SegmentIndex s) {
            return drag_of_arms(n, {&s, 1}, law);
          },
          bath, dt);
    };
    return m;
  }

  void step(const double dt)
  {
    const IntegratorStep taken = BrownianChebyshev(no_limits).advance(network, motion(), 0.4 / dt, dt);
    for (const NodeIndex i : network.nodes())
      network.set_position(i, network.position(i) + taken.displacement[i.value]);
    ++bath.step;
  }
};

/// sin^2 of the angle by which the arms of the middle node are turned, averaged over its height y with the weight of exp(-E/kT) or,
/// without the drift, of D exp(-E/kT): what is stationary for dx = f/D dt + sqrt(2 kT/D) dW in the sense of Ito.
double expected_tilt(ThermalLine line, const bool weighted_by_drag)
{
  const NodeIndex middle = *line.network.find_node(1);
  double sum = 0, norm = 0;
  for (double y = -40 * half_length; y <= 40 * half_length; y += 0.01 * half_length)
  {
    line.network.set_position(middle, Vec3(0, y, 0));
    double weight = std::exp(-(line.energy(middle)) / line.bath.kT);
    if (weighted_by_drag)
      weight *= nodal_drag(line.network, middle, line.law);
    sum += weight * y * y / (half_length * half_length + y * y);
    norm += weight;
  }
  return sum / norm;
}

/// The same average over a run.
Estimate measured_tilt(ThermalLine line)
{
  const NodeIndex middle = *line.network.find_node(1);
  std::vector<double> tilt;
  for (int k = 0; k < 100000; ++k)
  {
    line.step(0.3); // the error of the step is below one standard deviation of the mean here, and falls with it
    const double y = line.network.position(middle)[1];
    tilt.push_back(y * y / (half_length * half_length + y * y));
  }
  return estimate_by_blocks(tilt, 100);
}

TEST(BrownianChebyshev, ShortLineWithCharacterDependentDragTakesTheBoltzmannDistribution)
{
  const OneThread guard;
  ThermalLine line{.network = pinned_line(2)};
  line.bath = {30, 1, 0}; // of the order of the line's energy, so that it turns by large angles
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
