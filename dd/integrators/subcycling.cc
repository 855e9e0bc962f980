#include "dd/integrators/subcycling.h"

#include "dd/integrators/local_refinement.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace ddfem
{
namespace
{
std::vector<Vec3> difference(const std::vector<Vec3> &x, const std::vector<Vec3> &y)
{
  std::vector<Vec3> d(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    d[i] = x[i] - y[i];
  return d;
}
} // namespace

double Subcycling::largest_step(const EquationOfMotion &) const
{
  return std::numeric_limits<double>::infinity();
}

void Subcycling::begin_step(const Start &start)
{
  if (!start.motion.forces)
    throw std::invalid_argument("subcycling needs the forces in parts");
  at_start = *start.motion.forces->last;
}

void Subcycling::find_near(const Start &start, const double h)
{
  const SplitForces &forces = *start.motion.forces;
  Field expected(start.velocity.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    const double way = h * start.velocity[i].norm();
    expected[i] = h * std::min(1.0, settings.max_displacement / std::max(way, 1e-300)) * start.velocity[i];
  }
  near.update(start.network, forces.settings, forces.applied, expected);
  far.set_start(start.network, near, at_start);
  stiffness = start.motion.stiffness;
  const std::vector<double> gradient = near.gradient_at_nodes(start.network);
  for (const NodeIndex i : start.network.nodes())
    if (stiffness[i.value] > 0)
      stiffness[i.value] += gradient[i.value] / forces.drag[i.value];
}

bool Subcycling::goes_too_far(const Start &start, const Field &displacement) const
{
  return std::ranges::any_of(start.network.nodes(), [&](const NodeIndex i)
                             { return !(displacement[i.value].norm() <= 1.1 * settings.max_displacement); });
}

Integrator::Try Subcycling::attempt(const Start &start, const double h, IntegratorStep &step)
{
  find_near(start, h);
  LocalRefinement solver(start.network, *start.motion.forces, near, stiffness, start.tolerance, h);
  Try result{{}, Field(start.positions.size(), Vec3::Zero()), {}, 2};
  result.failed = !solver.solve(far, start.positions);
  result.displacement = difference(solver.positions(), start.positions);
  if (!result.failed && !goes_too_far(start, result.displacement))
  {
    velocity_at(start, result.displacement, h, step);
    correct(start, solver, result);
    result.failed = result.failed ||
                    !solver.paths().divide(start.positions, solver.positions(), settings.max_deviation, result.parts);
  }
  step.near_evaluations +=
      static_cast<double>(solver.segment_evaluations()) / static_cast<double>(start.network.n_segments());
  step.refined_nodes = solver.refined_nodes();
  return result;
}

/// @p result: the prediction, where the network is.
void Subcycling::correct(const Start &start, LocalRefinement &solver, Try &result)
{
  Network &network = start.network;
  const Field predicted = solver.positions();
  far.set_end(network, near, *start.motion.forces->last);
  result.failed = !solver.solve(far, start.positions);
  result.displacement = difference(solver.positions(), start.positions);
  result.error = difference(solver.positions(), predicted);
  look_farther(start, solver, predicted, result);
}

void Subcycling::look_farther(const Start &start, LocalRefinement &solver, const Field &predicted, Try &result)
{
  Network &network = start.network;
  std::vector<NodeIndex> wrong;
  for (const NodeIndex i : network.nodes())
    if (!(result.error[i.value].norm() <= start.tolerance[i.value]))
      wrong.push_back(i);
  constexpr std::size_t one_in = 20, farther = 4;
  if (result.failed || wrong.empty() || wrong.size() > 4 + network.n_nodes() / one_in)
    return;
  const auto place = [&](const Field &positions)
  {
    for (const NodeIndex i : network.nodes())
      network.set_position(i, positions[i.value]);
  };
  const Field corrected = solver.positions();
  place(start.positions);
  near.widen(network, wrong, farther * start.motion.forces->settings.distance);
  far.set_start(network, near, at_start);
  place(predicted);
  far.set_end(network, near, *start.motion.forces->last);
  result.failed = !solver.solve_again(far.without_end(), start.positions, wrong);
  const Field before = solver.positions();
  result.failed = result.failed || !solver.solve_again(far, start.positions, wrong);
  for (const NodeIndex i : network.nodes())
    if (before[i.value] != corrected[i.value] || solver.positions()[i.value] != corrected[i.value])
      result.error[i.value] = solver.positions()[i.value] - before[i.value];
  result.displacement = difference(solver.positions(), start.positions);
}
} // namespace ddfem
