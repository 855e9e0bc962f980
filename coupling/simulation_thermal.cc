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
  motion.mobility = [this](const Network &n, const std::vector<Vec3> &force)
  { return glide_velocities(n, force, parameters.mobility, finite_grain ? &finite_grain->shape() : nullptr); };
  motion.thermal_force = [this, bath](const Network &n, const double dt)
  {
    // Local velocities have the drag of a segment across it for the sliding of its ends, too.
    const SegmentDrag of_segment = [&](const SegmentIndex s)
    {
      const double across = 2 * drag_of_arms(n, {&s, 1}, parameters.mobility);
      return LineDrag{across, across};
    };
    return thermal_forces(n, of_segment, DragMatrix::lumped, bath, dt);
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
