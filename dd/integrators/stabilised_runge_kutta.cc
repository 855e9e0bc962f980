#include "dd/integrators/stabilised_runge_kutta.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace ddfem
{
namespace
{
using Field = std::vector<Vec3>;

/// Chebyshev polynomials T_j(w0) and their first two derivatives for j = 0..s.
struct Chebyshev
{
  std::vector<double> value, first, second;
  Chebyshev(const double w0, const unsigned s) : value(s + 1), first(s + 1), second(s + 1)
  {
    value[0] = 1;
    value[1] = w0;
    first[1] = 1;
    for (unsigned j = 2; j <= s; ++j)
    {
      value[j] = 2 * w0 * value[j - 1] - value[j - 2];
      first[j] = 2 * value[j - 1] + 2 * w0 * first[j - 1] - first[j - 2];
      second[j] = 4 * first[j - 1] + 2 * w0 * second[j - 1] - second[j - 2];
    }
  }
};

constexpr double damping = 2.0 / 13.0;

/// Largest |lambda| dt for which s stages are stable (eq. 2.8 with the damping of eq. 2.7).
double stability_bound(const unsigned s)
{
  return 2.0 / 3.0 * (s * s - 1.0) * (1 - 2.0 / 15.0 * damping);
}

unsigned stages_for(const double product)
{
  const double scale = 2.0 / 3.0 * (1 - 2.0 / 15.0 * damping);
  return std::max(2U, static_cast<unsigned>(std::ceil(std::sqrt(1 + product / scale))));
}

double max_norm(const Network &network, const Field &field)
{
  double m = 0;
  for (const NodeIndex i : network.nodes())
    m = std::max(m, field[i.value].norm());
  return m;
}

void set_positions(Network &network, const Field &positions)
{
  for (const NodeIndex i : network.nodes())
    network.set_position(i, positions[i.value]);
}

void check_finite(const Network &network, const Field &velocity)
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

/// One RKC step of s stages from @p y0 with velocity @p f0; returns the displacement, sets @p f_end at its end. The recursion is that
/// of the displacements from y0: exactly zero for nodes that do not move, such as one that is held on the surface of the grain.
Field rkc_step(Network &network, const VelocityFunction &velocity, const Field &y0, const Field &f0, const double h,
               const unsigned s, Field &f_end)
{
  const double w0 = 1 + damping / (s * s);
  const Chebyshev t(w0, s);
  const double w1 = t.first[s] / t.second[s];
  const auto b = [&](unsigned j)
  {
    j = std::max(j, 2U);
    return t.second[j] / (t.first[j] * t.first[j]);
  };
  const auto b_of = [&](const unsigned j) { return j == 1 ? 1 / w0 : b(j); };
  const std::size_t n = y0.size();
  Field d_old(n, Vec3::Zero()), d(n), d_new(n), y(n);
  // The time of a stage follows from the same recursion, as the solution of dt/dt = 1.
  double t_old = 0, time = b_of(1) * w1 * h;
  const auto place_nodes = [&]
  {
    std::transform(y0.begin(), y0.end(), d.begin(), y.begin(), std::plus<Vec3>());
    set_positions(network, y);
  };
  for (std::size_t i = 0; i < n; ++i)
    d[i] = b_of(1) * w1 * h * f0[i];
  for (unsigned j = 2; j <= s; ++j)
  {
    const double mu = 2 * b_of(j) * w0 / b_of(j - 1), nu = -b_of(j) / b_of(j - 2 == 0 ? 2 : j - 2);
    const double mu_h = 2 * b_of(j) * w1 / b_of(j - 1) * h;
    const double gamma_h = -(1 - b_of(j - 1) * t.value[j - 1]) * mu_h;
    place_nodes();
    const Field f = velocity(network, time);
    check_finite(network, f);
    for (std::size_t i = 0; i < n; ++i)
      d_new[i] = mu * d[i] + nu * d_old[i] + mu_h * f[i] + gamma_h * f0[i];
    t_old = std::exchange(time, mu * time + nu * t_old + mu_h + gamma_h);
    std::swap(d_old, d);
    std::swap(d, d_new);
  }
  place_nodes();
  f_end = velocity(network, h);
  check_finite(network, f_end);
  return d;
}
} // namespace

IntegratorStep StabilisedRungeKutta::advance(Network &network, const VelocityFunction &velocity, const double stiffness,
                                             const double dt_limit)
{
  Field start(network.node_capacity(), Vec3::Zero());
  for (const NodeIndex i : network.nodes())
    start[i.value] = network.position(i);
  IntegratorStep step;
  const Field f0 = velocity(network, 0);
  check_finite(network, f0);
  step.evaluations = 1;
  step.max_speed = max_norm(network, f0);

  double h = std::min({next_step, settings.max_step, dt_limit, stability_bound(settings.max_stages) / stiffness});
  if (step.max_speed > 0)
    h = std::min(h, settings.max_displacement / step.max_speed);
  const double smallest = std::min(1e-9, 1e-12 * settings.max_step);
  while (true)
  {
    step.stages = stages_for(h * stiffness);
    Field f_end;
    step.displacement = rkc_step(network, velocity, start, f0, h, step.stages, f_end);
    step.evaluations += step.stages;
    Field error(start.size(), Vec3::Zero());
    for (const NodeIndex i : network.nodes())
      error[i.value] = -0.8 * step.displacement[i.value] + 0.4 * h * (f0[i.value] + f_end[i.value]);
    step.error = max_norm(network, error);
    const double moved = max_norm(network, step.displacement);
    const double by_error = 0.8 * std::cbrt(settings.error_tolerance / std::max(step.error, 1e-300));
    const double by_motion = 0.9 * settings.max_displacement / std::max(moved, 1e-300);
    const double factor = std::clamp(std::min(by_error, by_motion), 0.1, 2.0);
    step.dt = h;
    if (step.error <= settings.error_tolerance && moved <= 1.1 * settings.max_displacement)
    {
      // A step cut short by dt_limit says nothing against the larger one suggested before.
      next_step = std::min(settings.max_step,
                           h < 0.99 * next_step ? std::max(next_step * std::min(1.0, factor), h * factor) : h * factor);
      break;
    }
    ++step.rejected;
    h *= std::min(0.8, factor);
    next_step = h;
    if (h < smallest)
    {
      std::ostringstream message;
      message << "the time step fell below " << smallest
              << " ns: the motion cannot be integrated to the requested error";
      throw std::runtime_error(message.str());
    }
  }
  set_positions(network, start);
  return step;
}

double line_tension_stiffness(const Network &network, const double tension, const std::vector<double> &drag)
{
  double radius = 0;
  for (const NodeIndex i : network.nodes())
  {
    double inverse_lengths = 0;
    for (const SegmentIndex s : network.connected_segments(i))
      inverse_lengths += 1 / network.length(s);
    if (drag[i.value] > 0 && network.constraint(i) != NodeConstraint::pinned)
      radius = std::max(radius, 2 * tension * inverse_lengths / drag[i.value]);
  }
  return radius;
}
} // namespace ddfem
