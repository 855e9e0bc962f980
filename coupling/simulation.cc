#include "coupling/simulation.h"

#include "coupling/input_error.h"
#include "dd/integrators/split_forces.h"
#include "dd/microstructure/clip.h"
#include "dd/topology/collisions/moving_lines.h"
#include "dd/topology/growth.h"
#include "dd/topology/node_splitting.h"
#include "dd/topology/product_plane_rule.h"
#include "dd/topology/remesh.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <numbers>
#include <stdexcept>

namespace ddfem::coupling
{
namespace
{
volatile std::sig_atomic_t signal_received = 0;

bool interrupted_anywhere(MPI_Comm communicator)
{
  int flag = signal_received != 0 ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &flag, 1, MPI_INT, MPI_MAX, communicator);
  return flag != 0;
}

/// Upper bound of the line tension that a wavelength of two of the longest segments feels, MPa nm^2 (screw line, Hirth &
/// Lothe eq. 6-82 with the core radius as inner cut-off).
double largest_line_tension(const Parameters &p)
{
  const double b = p.burgers_magnitude;
  const double core = std::min(p.medium.a, p.core_cutoff_radius);
  return p.medium.mu * b * b * (1 + p.medium.nu) / (4 * std::numbers::pi * (1 - p.medium.nu)) *
         std::max(1.0, std::log(2 * p.topology.max_segment / core));
}
} // namespace

void install_signal_handlers()
{
  const auto handler = [](int s) { signal_received = s; };
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
}

Simulation::Simulation(const Parameters &p, MPI_Comm comm)
    : parameters(p), communicator(comm), dislocations(build_network(p)), far_field(p.far_field),
      product_plane(product_plane_rule(p.slip_systems())), velocities(p.mobility, p.velocities),
      integrator(make_integrator(p.method, p.integrator)), brownian_integrator(p.integrator)
{
  if (p.mode == Mode::finite)
  {
    finite_grain = std::make_unique<FiniteGrain>(p.grain, p.medium, communicator);
    update = std::make_unique<CorrectionUpdate>(*finite_grain, p.medium, p.grain.correction_tolerance);
    if (p.cut_at_surface)
      clip_to_grain(dislocations, finite_grain->shape(), 0.1 * p.topology.min_segment);
    fit_into_grain(dislocations, finite_grain->shape(), p.topology.min_segment);
    initial_open_lines = open_lines(dislocations, &finite_grain->shape(), p.grain.ray_direction);
    if (p.grain.reference == ReferenceState::perfect_crystal)
    {
      try
      {
        swept = grown_area(dislocations, &finite_grain->shape(), p.grain.ray_direction);
        total_plastic_strain = plastic_strain_volume(swept) / finite_grain->volume();
        swept.clear();
      }
      catch (const std::invalid_argument &e)
      {
        throw InputError(std::string("Boundary conditions/Reference state = perfect crystal: ") + e.what());
      }
    }
  }
  if (p.mode == Mode::periodic)
    images = std::make_unique<PeriodicImages>(p.cell.origin, p.cell.lengths);
}

LineSystem Simulation::line_system()
{
  return {parameters.medium,
          dislocations,
          finite_grain ? &finite_grain->shape() : nullptr,
          parameters.grain.ray_direction,
          images ? &parameters.cell : nullptr,
          images.get()};
}

LineSystem Simulation::closed_line_system()
{
  LineSystem lines = line_system();
  lines.close(initial_open_lines);
  return lines;
}

ForceEnvironment Simulation::environment()
{
  ForceEnvironment e;
  e.applied = applied_stress();
  e.shape = finite_grain ? &finite_grain->shape() : nullptr;
  e.cell = images ? &parameters.cell : nullptr;
  e.images = images.get();
  e.correction = &correction;
  e.far_field = &far_field;
  e.costs = costs;
  return e;
}

double Simulation::axial_plastic_strain() const
{
  const Vec3 a = finite_grain ? finite_grain->loading_axis() : parameters.loading.axis;
  return a.dot(contract(total_plastic_strain, a));
}

double Simulation::reference_volume() const
{
  return finite_grain ? finite_grain->volume() : parameters.cell.volume();
}

void Simulation::solve_lines()
{
  if (!finite_grain)
    return;
  solution = update->solve_at_rest(closed_line_system(), dislocations);
  if (solution.force_imbalance > max_imbalance || solution.moment_imbalance > max_imbalance)
    throw std::runtime_error("the tractions of the dislocations over the closed surface do not balance: net force " +
                             std::to_string(solution.force_imbalance) + ", net moment " +
                             std::to_string(solution.moment_imbalance) + " of the sum of their magnitudes");
}

void Simulation::update_correction(const LineWork &lines)
{
  const Timing::Scope scope(timing, "elastic solve");
  solve_lines();
  update_loading(lines);
  read_correction();
}

void Simulation::read_correction()
{
  if (!finite_grain)
    return;
  correction = finite_grain->correction_at_segments(dislocations);
  update->set_scale(dislocations, correction);
  if (observer)
    observer(*finite_grain, closed_line_system());
}

void Simulation::start()
{
  const Timing::Scope scope(timing, "elastic solve");
  if (finite_grain)
    finite_grain->set_reference(dislocations, closed_line_system());
  solve_lines();
  start_loading();
  read_correction();
}

IntegratorStep Simulation::move_lines()
{
  const Timing::Scope scope(timing, "forces and motion");
  const ForceSettings settings = parameters.force_settings();
  const ForceEnvironment e = environment();
  forces_at_start.clear();
  far_field.begin_step();
  load_in_step = load_within_step();
  const SplitForces parts{{settings.medium, settings.core_cutoff_radius, near_pair_tolerance, parameters.near_distance},
                          e.applied,
                          velocities.drag_of_nodes(dislocations),
                          &forces_at_end.segment_ends,
                          [&](const Network &n, const NodeIndex i, const Vec3 &force)
                          { return velocities.velocity_of_node(n, i, force, e.shape); }};
  std::vector<double> stiffness = velocities.stiffness(dislocations, largest_line_tension(parameters), e.shape);
  const double of_load = load_in_step.stiffness(dislocations, velocities, e.shape);
  for (double &rate : stiffness)
    rate += rate > 0 ? of_load : 0.0;
  // The integrator asks first at the start of the step, and last at its end as it is predicted or accepted.
  const EquationOfMotion motion{[&](const Network &n, const double time_in_step)
                                {
                                  forces_at_end = compute_nodal_forces(n, settings, e, communicator);
                                  load_in_step.add_to(forces_at_end, n, load_in_step.stress_change(n, time_in_step));
                                  if (forces_at_start.empty())
                                    forces_at_start = forces_at_end.total;
                                  return velocities.velocities(n, forces_at_end.total, e.shape);
                                },
                                std::move(stiffness), &parts};
  return parameters.thermal.motion
             ? brownian_integrator.advance(dislocations, brownian_motion(motion.velocity, parts.drag),
                                           motion.largest_stiffness(), time_left())
             : integrator->advance(dislocations, motion, time_left());
}

TopologyContext Simulation::topology_context(std::vector<Vec3> displacement)
{
  return {dislocations,
          parameters.topology,
          finite_grain ? &finite_grain->shape() : nullptr,
          parameters.grain.ray_direction,
          product_plane,
          swept,
          counts,
          std::move(displacement)};
}

void Simulation::change_topology(TopologyContext &context, const IntegratorStep &step)
{
  const Timing::Scope scope(timing, "topology");
  ddfem::move_lines(context, candidates, step.parts);
  SplittingModel model{parameters.medium, parameters.core_cutoff_radius, parameters.mobility};
  model.applied = applied_stress();
  // The network has changed since the last solve, but its correction field has not: it is read at the new points.
  split_nodes(context, model,
              [&](const Network &n)
              {
                if (finite_grain)
                  correction = finite_grain->correction_at_segments(n);
                return compute_nodal_forces(n, parameters.force_settings(), environment(), communicator);
              });
  cross_slip_lines(context, step.dt);
  remesh(context);
  if (dislocations.node_capacity() > 2 * dislocations.n_nodes() + 64)
    dislocations.clean();
}

void Simulation::book(LineWork &work)
{
  const Timing::Scope scope(timing, "swept area");
  work.topology = work_on_swept_area() - work.external;
  total_plastic_strain += plastic_strain_volume(swept) / reference_volume();
  if (finite_grain)
  {
    finite_grain->add_swept(swept);
    update->add_swept(swept);
  }
  swept.clear();
}

double Simulation::time_left() const
{
  double left = parameters.stop.final_time - time;
  if (parameters.loading.type == LoadingType::stages)
  {
    left = std::min(left, loading.time_left());
    if (parameters.stop.final_strain > 0)
      left = std::min(left, loading.time_to_strain(parameters.stop.final_strain));
  }
  return left;
}

bool Simulation::must_stop(const IntegratorStep &step) const
{
  const StopCriteria &stop = parameters.stop;
  return time_left() <= 1e-12 * stop.final_time || step_number >= stop.max_steps ||
         (parameters.loading.type == LoadingType::stages && loading.finished()) ||
         (stop.final_strain > 0 && std::abs(nominal_strain()) >= stop.final_strain) ||
         (stop.final_plastic_strain > 0 && to_matrix(total_plastic_strain).norm() >= stop.final_plastic_strain) ||
         (stop.equilibrium_speed > 0 && step_number > 1 && step.max_speed < stop.equilibrium_speed);
}

void Simulation::check_consistency() const
{
  if (parameters.output.check_network)
    dislocations.check_invariants(1e-5);
  std::uint64_t sums[2] = {dislocations.checksum(), ~dislocations.checksum()};
  MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_UINT64_T, MPI_MAX, communicator);
  if (sums[0] != ~sums[1])
    throw std::runtime_error("the ranks hold different networks after step " + std::to_string(step_number));
}

RunEnd Simulation::run(RunOutput &output)
{
  start();
  IntegratorStep step;
  report(output, step, false);
  while (!must_stop(step))
  {
    step = move_lines();
    LineWork work = work_of_step(step);
    TopologyContext context = topology_context(step.displacement);
    change_topology(context, step);
    book(work);
    // No rounding at the end of the run.
    time = step.dt == parameters.stop.final_time - time ? parameters.stop.final_time : time + step.dt;
    ++step_number;
    check_consistency();
    update_correction(work);
    const bool interrupted = interrupted_anywhere(communicator);
    report(output, step, interrupted || must_stop(step));
    if (interrupted)
      return RunEnd::interrupted;
  }
  return RunEnd::finished;
}

NodalForces Simulation::forces()
{
  return compute_nodal_forces(dislocations, parameters.force_settings(), environment(), communicator, true);
}

std::vector<SymTensor> Simulation::infinite_stress(const std::vector<Vec3> &points)
{
  const LineSystem lines = line_system();
  const SummationSettings &summation = parameters.grain.summation;
  return summation.use_multipoles(lines.lines().size())
             ? MultipoleField(lines, points, {summation.tolerance}).stress(communicator)
             : lines.stress(points);
}

std::vector<SymTensor> Simulation::correction_stress(const std::vector<Vec3> &points) const
{
  if (!finite_grain)
    return std::vector<SymTensor>(points.size(), SymTensor::Zero());
  return finite_grain->correction_stress(points);
}
} // namespace ddfem::coupling
