// What a simulation says about itself: history, frames, status line, summary.
#include "coupling/simulation.h"
#include "dd/common/units.h"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace ddfem::coupling
{
namespace
{
std::string clock(const double seconds)
{
  std::ostringstream out;
  const auto s = static_cast<long>(seconds);
  out << s / 3600 << ":" << std::setfill('0') << std::setw(2) << s / 60 % 60 << ":" << std::setw(2) << s % 60;
  return out.str();
}
} // namespace

HistoryRow Simulation::history_row(const IntegratorStep &step) const
{
  HistoryRow r;
  r.step = step_number;
  r.time = time;
  r.dt = step.dt;
  r.strain = load_state().strain;
  r.stress = load_state().stress;
  r.stage = loading.stage() + 1;
  r.plastic_strain = total_plastic_strain;
  r.axial_plastic_strain = axial_plastic_strain();
  for (const SegmentIndex s : dislocations.segments())
    r.line_length += dislocations.length(s);
  r.density = r.line_length / reference_volume();
  r.segments = dislocations.n_segments();
  r.nodes = dislocations.n_nodes();
  for (const NodeIndex i : dislocations.nodes())
  {
    r.junctions += dislocations.degree(i) > 2 ? 1 : 0;
    r.surface_nodes += dislocations.constraint(i) == NodeConstraint::surface ? 1 : 0;
  }
  r.collisions = counts.collisions;
  r.surface_exits = counts.surface_exits;
  r.cross_slips = counts.cross_slips;
  r.stages = step.stages;
  r.max_speed = step.max_speed;
  r.wall_time = timing.elapsed();
  if (finite_grain)
  {
    r.elastic_strain = loading.elastic_strain();
    r.platen_force = solution.platen_force;
    r.platen_moment = solution.platen_moment;
    r.fixed_force = solution.fixed_force;
    r.fixed_moment = solution.fixed_moment;
    r.fixed_reaction = solution.fixed_reaction;
    r.platen_reaction = solution.platen_reaction;
    r.fem_iterations = solution.solve.iterations;
    r.force_imbalance = solution.force_imbalance;
    r.moment_imbalance = solution.moment_imbalance;
  }
  else
    r.elastic_strain = r.stress / parameters.medium.youngs_modulus();
  const Energies now = energies();
  r.work = now.work;
  r.stored_energy = now.stored;
  r.dissipated_energy = now.dissipated;
  r.dissipated_by_topology = now.topology;
  r.energy_mismatch = energy.relative_mismatch();
  return r;
}

std::string Simulation::status_line(const IntegratorStep &step) const
{
  const HistoryRow r = history_row(step);
  std::ostringstream out;
  out << std::setprecision(4) << "step " << step_number << "  t " << time << " ns  dt " << step.dt << " ns  strain "
      << r.strain << "  stress " << r.stress << " MPa  plastic " << r.axial_plastic_strain << "  segments "
      << r.segments;
  if (parameters.loading.stages.size() > 1)
    out << "  stage " << r.stage << "/" << parameters.loading.stages.size();
  if (energies().dissipated > 0)
    out << "  energy mismatch " << std::setprecision(2) << 100 * r.energy_mismatch << " %";
  double done = time / parameters.stop.final_time;
  if (parameters.stop.final_strain > 0)
    done = std::max(done, std::abs(r.strain) / parameters.stop.final_strain);
  done = std::max(done, double(step_number) / parameters.stop.max_steps);
  if (done > 0)
    out << "  left " << clock(timing.elapsed() * (1 / done - 1));
  return out.str();
}

void Simulation::report(RunOutput &output, const IntegratorStep &step, const bool last)
{
  const Timing::Scope scope(timing, "output");
  if (step_number % parameters.output.history_interval == 0 || last)
    output.add_history(history_row(step));
  const unsigned interval = parameters.output.frame_interval;
  const bool frame = last || step_number == 0 || (interval > 0 && step_number % interval == 0);
  if (frame)
  {
    output.add_network_frame(step_number, time, dislocations);
    if (finite_grain && !output.directory().empty())
    {
      std::ostringstream name;
      name << "grain_" << std::setfill('0') << std::setw(7) << step_number;
      output.add_grain_frame(time, finite_grain->write(output.directory(), name.str()));
    }
    output.log(status_line(step));
  }
  else
    output.status(status_line(step));
  if (last && output.writes())
  {
    output.log("collisions " + std::to_string(counts.collisions) + ", annihilations " +
               std::to_string(counts.annihilations) + ", node splits " + std::to_string(counts.splits) +
               ", surface exits " + std::to_string(counts.surface_exits) + ", cross-slips " +
               std::to_string(counts.cross_slips) + ", segments halved " + std::to_string(counts.refinements) +
               ", nodes removed " + std::to_string(counts.coarsenings));
    output.log(energy_line());
    if (far_field.counts().refreshed > 0)
      output.log(far_field_line());
    if (update)
      output.log("elastic solves " + std::to_string(update->counts().solves) + ", steps without " +
                 std::to_string(update->counts().skips));
    write_file(output.directory() + "/timing.txt", timing.table());
  }
}

std::string Simulation::energy_line() const
{
  const Energies e = energies();
  std::ostringstream out;
  out << std::setprecision(5) << "work " << e.work / units::joule << " J = stored " << e.stored / units::joule
      << " J + dissipated " << e.dissipated / units::joule << " J + mismatch " << e.mismatch() / units::joule << " J";
  return out.str();
}

std::string Simulation::far_field_line() const
{
  const FarFieldCache::Counts &n = far_field.counts();
  std::ostringstream out;
  out << "far field refreshed " << n.refreshed << " times, in " << n.trees << " trees; evaluations with the kept one "
      << n.kept << ", with one of their own " << n.without << "; largest error measured " << std::setprecision(2)
      << far_field.largest_error() << " of it";
  return out.str();
}

std::string Simulation::images_line() const
{
  std::ostringstream out;
  const std::size_t n = finite_grain->planes_with_images().size();
  out << "images      ";
  if (parameters.grain.image_depth == 0)
    out << "none (Image depth 0)\n";
  else if (n == 0)
    out << "none: no face is flat, free, and a surface of its own with the grain on one side\n";
  else
    out << "of lines within " << finite_grain->depth_of_images() << " nm of " << n << " flat free face"
        << (n > 1 ? "s" : "") << "\n";
  return out.str();
}

std::string Simulation::summary() const
{
  const auto &m = parameters.medium;
  std::ostringstream out;
  out << std::setprecision(6) << "material    mu = " << m.mu / units::pascal * 1e-9 << " GPa, nu = " << m.nu
      << ", b = " << parameters.burgers_magnitude << " nm, core radius = " << m.a << " nm\n"
      << "network     " << dislocations.n_nodes() << " nodes, " << dislocations.n_segments() << " segments\n";
  if (finite_grain)
    out << "grain       height " << finite_grain->height() << " nm, section " << finite_grain->section()
        << " nm^2, volume " << finite_grain->volume() << " nm^3\n"
        << "elasticity  " << finite_grain->n_dofs() << " unknowns, modulus under these boundary conditions "
        << finite_grain->unit_load_modulus() * 1e-3 << " GPa\n"
        << images_line();
  else
    out << "volume      " << reference_volume() << " nm^3\n";
  const SlipSystems systems = parameters.slip_systems();
  const Vec3 axis = finite_grain ? finite_grain->loading_axis() : parameters.loading.axis;
  out << "loading     along (" << axis.transpose() << "), largest Schmid factor " << systems.largest_schmid_factor(axis)
      << "\n";
  return out.str();
}
} // namespace ddfem::coupling
