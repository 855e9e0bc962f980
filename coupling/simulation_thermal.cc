// What the heat bath does in a run: Langevin forces and cross-slip.
#include "coupling/simulation.h"
#include "dd/mobility/thermal_force.h"

#include <algorithm>

namespace ddfem::coupling
{
BrownianMotion Simulation::brownian_motion(VelocityFunction velocity, const std::vector<double> &drag) const
{
  const HeatBath bath{boltzmann_constant * parameters.thermal.temperature, parameters.thermal.seed, step_number};
  BrownianMotion motion;
  motion.velocity = std::move(velocity);
  // Random forces have velocities of their own: the solver of the others starts from their last ones.
  motion.mobility = [this, solver = VelocitySolver(parameters.mobility, parameters.velocities)](
                        const Network &n, const std::vector<Vec3> &force) mutable
  { return solver.velocities(n, force, finite_grain ? &finite_grain->shape() : nullptr); };
  motion.thermal_force = [this, bath](const Network &n, const double dt)
  {
    const SegmentDrag of_segment = [&](const SegmentIndex s)
    {
      const double across = n.length(s) * parameters.mobility->drag(line_state(n, s));
      return LineDrag{across, parameters.velocities.sliding_drag * across};
    };
    const bool local = parameters.velocities.method == VelocityMethod::local;
    return thermal_forces(n, of_segment, local ? DragMatrix::lumped : DragMatrix::consistent, bath, dt);
  };
  for (const NodeIndex i : dislocations.nodes())
    if (drag[i.value] > 0)
      motion.diffusivity = std::max(motion.diffusivity, bath.kT / drag[i.value]);
  return motion;
}

std::vector<SymTensor> Simulation::total_stress(const std::vector<Vec3> &points)
{
  std::vector<SymTensor> sum = infinite_stress(points);
  const std::vector<SymTensor> of_boundary = correction_stress(points);
  const SymTensor applied = applied_stress();
  for (std::size_t k = 0; k < sum.size(); ++k)
    sum[k] += of_boundary[k] + applied;
  return sum;
}

void Simulation::cross_slip_lines(TopologyContext &context, const double dt)
{
  if (parameters.cross_slip.model != CrossSlipModel::off)
    cross_slip(context, parameters.cross_slip, parameters.slip_systems(), {dt, parameters.thermal.seed, step_number},
               [this](const std::vector<Vec3> &points) { return total_stress(points); });
}
} // namespace ddfem::coupling
