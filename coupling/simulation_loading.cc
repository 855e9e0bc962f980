// How the loading acts on the body, and the energy that it puts in.
#include "coupling/simulation.h"

#include <limits>
#include <utility>

namespace ddfem::coupling
{
namespace
{
double machine_stiffness(const Parameters &p, const FiniteGrain *grain)
{
  if (!grain || p.loading.machine_stiffness == 0)
    return std::numeric_limits<double>::infinity();
  const Platen &platen = grain->platen();
  return p.loading.machine_stiffness * platen.stress_per_load() / platen.strain_per_motion();
}
} // namespace

LoadState Simulation::load_state() const
{
  if (parameters.loading.type == LoadingType::stages)
    return loading.state();
  return {time, 0.0, parameters.loading.axis.dot(contract(applied_stress(), parameters.loading.axis))};
}

SymTensor Simulation::applied_stress() const
{
  if (finite_grain)
    return SymTensor::Zero();
  if (parameters.loading.type == LoadingType::tensor)
    return parameters.loading.stress + time * parameters.loading.stress_rate;
  const Vec3 &a = parameters.loading.axis;
  return loading.state().stress * symmetric_part(a * a.transpose());
}

BodyResponse Simulation::body_response() const
{
  if (finite_grain)
    return {solution.load_at_rest * finite_grain->platen().stress_per_load(), finite_grain->unit_load_modulus()};
  const double modulus = parameters.medium.youngs_modulus();
  return {-modulus * axial_plastic_strain(), modulus};
}

LoadWithinStep Simulation::load_within_step() const
{
  if (parameters.loading.type != LoadingType::stages)
    return {};
  UnitLoad unit;
  if (finite_grain)
    unit = finite_grain->unit_load(dislocations);
  else
  {
    unit.points = SegmentPoints(dislocations);
    const Vec3 &a = parameters.loading.axis;
    unit.stress.assign(unit.points.positions().size(), symmetric_part(a * a.transpose()));
    unit.fall_per_work = parameters.medium.youngs_modulus() / reference_volume();
  }
  return {dislocations, std::move(unit), loading, body_response()};
}

void Simulation::start_loading()
{
  loading = Loading({parameters.loading.stages, machine_stiffness(parameters, finite_grain.get()),
                     parameters.loading.stage_tolerance});
  loading.start(time, body_response());
  if (finite_grain)
  {
    finite_grain->move_platen(solution, 0.0);
    last_load = {solution.load, solution.motion};
    energy.start(finite_grain->boundary_state());
  }
  else
    energy.start(SymTensor::Zero(), total_plastic_strain);
  update_loading({});
}

void Simulation::update_loading(const LineWork &lines)
{
  if (parameters.loading.type == LoadingType::stages)
    loading.update(time, body_response());
  apply_load(lines);
  while (parameters.loading.type == LoadingType::stages && loading.stage_over())
  {
    balance_energy();
    loading.next_stage(body_response());
    apply_load({}); // a change of load at fixed lines, which may be a jump
  }
}

void Simulation::apply_load(const LineWork &lines)
{
  if (!finite_grain)
  {
    energy.add(parameters.medium, reference_volume(), applied_stress(), total_plastic_strain, lines);
    return;
  }
  finite_grain->move_platen(solution, loading.state().strain / finite_grain->platen().strain_per_motion());
  work_since_balance += lines;
  platen_work_since_balance += 0.5 * (last_load.first + solution.load) * (solution.motion - last_load.second);
  last_load = {solution.load, solution.motion};
  if (solution.solved)
    balance_energy();
}

/// An extrapolated state holds displacements and loads of different times to first order: its energies would show what was swept
/// since the last solve as a mismatch. The steps between two solves are therefore balanced as one; until
/// then the platens' work is that of their load.
void Simulation::balance_energy()
{
  if (!finite_grain)
    return;
  energy.add(finite_grain->boundary_state(), work_since_balance, communicator);
  work_since_balance = {};
  platen_work_since_balance = 0;
}

LineWork Simulation::work_of_step(const IntegratorStep &step) const
{
  LineWork work;
  work.total = work_of_nodal_forces(dislocations, forces_at_start, forces_at_end.total, step.displacement);
  if (finite_grain)
    work.external = work_on_lines(dislocations, correction.points, correction.without_images, step.displacement);
  else
  {
    const SegmentPoints points(dislocations);
    const std::vector<SymTensor> stress(points.positions().size(), applied_stress());
    work.external = work_on_lines(dislocations, points, stress, step.displacement);
  }
  work.external += load_in_step.work_of_change(dislocations, step.displacement, step.dt);
  return work;
}
/// Of the correction or applied stress that the lines have moved in, on all that was swept.
double Simulation::work_on_swept_area() const
{
  const std::vector<Vec3> centres = swept_centres(swept, finite_grain ? &finite_grain->shape() : nullptr);
  return work_on_area(swept, finite_grain ? finite_grain->stress_of_elements(centres)
                                          : std::vector<SymTensor>(centres.size(), applied_stress()));
}
} // namespace ddfem::coupling
