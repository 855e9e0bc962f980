// Strain rate control of lines that feel nothing but the load: dx/dt of a linear equation with a known solution.
#include "coupling/load_within_step.h"
#include "dd/integrators/stabilised_runge_kutta.h"
#include "dd/mobility/linear_glide.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace ddfem::coupling
{
namespace
{
const double length = 200, b = 0.25, drag = 0.1, youngs_modulus = 2e5; // nm, nm, MPa ns, MPa
const double strain_rate = 1e-6;                                       // 1/ns
const Vec3 axis = Vec3(1, 0, 1).normalized();                          // Schmid factor 1/2

/// Two edge lines of opposite sign through a periodic cell, in parallel glide planes.
Network dipole()
{
  Network network;
  network.set_period(Vec3::Constant(length));
  for (const double sign : {1.0, -1.0})
  {
    const PlaneIndex plane = network.planes().find_or_insert({0, 0, 1}, Vec3::UnitZ(), 50 * sign);
    std::array<NodeIndex, 4> nodes;
    for (std::size_t k = 0; k < 4; ++k)
      nodes[k] = network.insert({Vec3(0, 50.0 * double(k), 50 * sign), NodeConstraint::free});
    for (std::size_t k = 0; k < 4; ++k)
      network.insert({nodes[k], nodes[(k + 1) % 4], Vec3(sign * b, 0, 0), plane});
  }
  return network;
}

/// A density rho = 2/length^2 of lines with Schmid factor m = 1/2 relaxes the stress towards E rate tau in
/// tau = B/(E rho b^2 m^2): d(stress)/dt = E (rate - rho b m v), v = m b stress/B.
class StrainRateControl
{
public:
  static constexpr double relaxation_time = 0.1 / (2e5 * 2 / (200. * 200.) * 0.25 * 0.25 * 0.25); // 0.64 ns
  static double steady_stress() { return youngs_modulus * strain_rate * relaxation_time; }
  static double exact(const double time) { return steady_stress() * (1 - std::exp(-time / relaxation_time)); }

  explicit StrainRateControl(const bool follows_) : network(dipole()), follows(follows_)
  {
    Stage stage;
    stage.kind = StageKind::strain_rate;
    stage.rate = strain_rate;
    loading = Loading({{stage}});
    loading.start(0, response());
  }

  double stress() const { return loading.state().stress; }

  /// Returns the number of steps taken.
  int advance(const double dt)
  {
    int n_steps = 0;
    for (double left = dt; left > 1e-12 * dt; ++n_steps)
      left -= step(left);
    return n_steps;
  }

  static constexpr double position_tolerance = 1e-3; // nm

private:
  double step(const double dt_limit)
  {
    UnitLoad unit;
    unit.points = SegmentPoints(network);
    unit.stress.assign(unit.points.positions().size(), symmetric_part(axis * axis.transpose()));
    unit.fall_per_work = youngs_modulus / std::pow(length, 3);
    const LoadWithinStep load(network, unit, loading, response());
    const auto velocity = [&](const Network &n, const double time_in_step)
    {
      NodalForces forces = no_forces(n);
      load.add_to(forces, n, stress() + (follows ? load.stress_change(n, time_in_step) : 0));
      return velocities.velocities(n, forces.total, nullptr);
    };
    const double stiffness = load.stiffness(network, velocities, nullptr);
    EXPECT_NEAR(stiffness * relaxation_time, 1, 1e-9);
    StabilisedRungeKutta method({position_tolerance, 1e3, 1e9, dt_limit, 50});
    const IntegratorStep taken = method.advance(network, velocity, stiffness, dt_limit);
    for (const NodeIndex i : network.nodes())
      network.set_position(i, network.position(i) + taken.displacement[i.value]);
    loading.update(loading.state().time + taken.dt, response());
    return taken.dt;
  }

  /// Plastic strain from where the first line is: both have swept the same.
  BodyResponse response() const
  {
    const double swept = 2 * length * std::abs(network.position(network.nodes()[0])[0]);
    return {-youngs_modulus * 0.5 * b * swept / std::pow(length, 3), youngs_modulus};
  }

  Network network;
  bool follows;
  VelocitySolver velocities{linear_glide(drag, drag)};
  Loading loading;
};

TEST(StrainRateControl, LeadsToTheSteadyStressWithoutOscillationInLongSteps)
{
  // An error of the position of the lines is one of the stress.
  const double bound = 2 * youngs_modulus * 2 / (length * length) * 0.5 * b * StrainRateControl::position_tolerance;
  StrainRateControl control(true);
  const double dt = 5 * StrainRateControl::relaxation_time;
  for (int k = 1; k <= 10; ++k)
  {
    const int n_steps = control.advance(dt);
    EXPECT_NEAR(control.stress(), StrainRateControl::exact(k * dt), bound) << k;
    EXPECT_TRUE(k <= 5 || n_steps == 1) << "accuracy does not ask for more in a steady state";
  }
  EXPECT_LT(bound, 0.05 * StrainRateControl::steady_stress());
}

TEST(StrainRateControl, FollowsTheExactRelaxationInShortSteps)
{
  StrainRateControl control(true);
  const double dt = 0.1 * StrainRateControl::relaxation_time;
  double largest = 0;
  for (int k = 1; k <= 30; ++k)
  {
    control.advance(dt);
    largest = std::max(largest, std::abs(control.stress() - StrainRateControl::exact(k * dt)));
  }
  // Second order: a sixth of (dt/tau)^2 at most.
  EXPECT_LT(largest, 0.01 / 6 * StrainRateControl::steady_stress());
}

TEST(StrainRateControl, WithTheStressOfTheStartOfTheStepOscillates)
{
  StrainRateControl control(false);
  for (int k = 1; k <= 6; ++k)
    control.advance(2.5 * StrainRateControl::relaxation_time);
  EXPECT_GT(std::abs(control.stress() / StrainRateControl::steady_stress() - 1), 2);
}
} // namespace
} // namespace ddfem::coupling
