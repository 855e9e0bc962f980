#include "dd/integrators/integrator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace ddfem
{
namespace
{
double largest_norm(const Network &network, const std::vector<Vec3> &field)
{
  double m = 0;
  for (const NodeIndex i : network.nodes())
    m = std::max(m, field[i.value].norm());
  return m;
}

void check_finite(const Network &network, const std::vector<Vec3> &velocity)
{
  for (const NodeIndex i : network.nodes())
    if (!velocity[i.value].allFinite())
    {
      std::ostringstream message;
      message << "the velocity of node " << network.id(i) << " at (" << network.position(i).transpose()
              << ") nm is not finite";
      throw std::runtime_error(message.str());
    }
}

std::vector<Vec3> positions_of(const Network &network)
{
  std::vector<Vec3> x(network.node_capacity(), Vec3::Zero());
  for (const NodeIndex i : network.nodes())
    x[i.value] = network.position(i);
  return x;
}

std::vector<double> tolerances(const Network &network, const IntegratorSettings &settings)
{
  std::vector<double> tolerance(network.node_capacity(), settings.error_tolerance);
  if (settings.relative_tolerance > 0)
    for (const NodeIndex i : network.nodes())
    {
      double shortest = std::numeric_limits<double>::infinity();
      for (const SegmentIndex s : network.connected_segments(i))
        shortest = std::min(shortest, network.length(s));
      if (std::isfinite(shortest))
        tolerance[i.value] += settings.relative_tolerance * shortest;
    }
  return tolerance;
}

/// Ends at the limit, or leaves at least as much for the step after.
double fit(const double h, const double dt_limit)
{
  return h >= dt_limit ? dt_limit : std::min(h, 0.5 * dt_limit);
}
} // namespace

double EquationOfMotion::largest_stiffness() const
{
  return stiffness.empty() ? 0.0 : *std::max_element(stiffness.begin(), stiffness.end());
}

IntegratorStep Integrator::advance(Network &network, const VelocityFunction &velocity, const double stiffness,
                                   const double dt_limit)
{
  return advance(network, EquationOfMotion{velocity, {stiffness}, nullptr}, dt_limit);
}

IntegratorStep Integrator::advance(Network &network, const EquationOfMotion &motion, const double dt_limit)
{
  IntegratorStep step;
  Start start{network, motion, positions_of(network), motion.velocity(network, 0), tolerances(network, settings)};
  check_finite(network, start.velocity);
  step.evaluations = 1;
  step.max_speed = largest_norm(network, start.velocity);
  begin_step(start);
  const double smallest = std::min(1e-9, 1e-12 * settings.max_step);
  while (true)
  {
    const double h = size_of_try(start, step.max_speed, dt_limit);
    const unsigned before = step.evaluations;
    Try attempted = attempt(start, h, step);
    for (const NodeIndex i : network.nodes())
      network.set_position(i, start.positions[i.value]);
    if (judge(start, attempted, h, step))
    {
      step.dt = h;
      step.stages = step.evaluations - before;
      step.displacement = std::move(attempted.displacement);
      step.parts = std::move(attempted.parts);
      return step;
    }
    ++step.rejected;
    if (next_step < smallest)
    {
      std::ostringstream message;
      message << "the time step fell below " << smallest
              << " ns: the motion cannot be integrated to the requested error";
      throw std::runtime_error(message.str());
    }
  }
}

double Integrator::size_of_try(const Start &start, const double max_speed, const double dt_limit) const
{
  double h = std::min({next_step, settings.max_step, largest_step(start.motion)});
  if (max_speed > 0)
    h = std::min(h, settings.max_displacement / max_speed);
  return fit(h, dt_limit);
}

bool Integrator::judge(const Start &start, const Try &attempted, const double h, IntegratorStep &step)
{
  const double moved = largest_norm(start.network, attempted.displacement);
  double relative = 0; // largest error in tolerances
  step.error = 0;
  if (!attempted.error.empty())
    for (const NodeIndex i : start.network.nodes())
    {
      const double error = attempted.error[i.value].norm();
      step.error = std::max(step.error, error);
      relative = std::max(relative, error / start.tolerance[i.value]);
    }
  const double by_error = 0.8 * std::pow(std::max(relative, 1e-300), -1.0 / attempted.order);
  const double by_motion = 0.9 * settings.max_displacement / std::max(moved, 1e-300);
  const double factor = std::clamp(std::min(by_error, by_motion), 0.1, 2.0);
  if (!attempted.failed && relative <= 1 && moved <= 1.1 * settings.max_displacement)
  {
    // A step cut short by its limit says nothing against the larger one suggested before.
    next_step = std::min(settings.max_step,
                         h < 0.99 * next_step ? std::max(next_step * std::min(1.0, factor), h * factor) : h * factor);
    return true;
  }
  next_step = h * (attempted.failed ? 0.5 : std::min(0.8, factor));
  return false;
}

Integrator::Field Integrator::velocity_at(const Start &start, const Field &displacement, const double time,
                                          IntegratorStep &step)
{
  start.network.for_each_node([&](const NodeIndex i)
                              { start.network.set_position(i, start.positions[i.value] + displacement[i.value]); });
  Field v = start.motion.velocity(start.network, time);
  check_finite(start.network, v);
  ++step.evaluations;
  return v;
}
} // namespace ddfem
