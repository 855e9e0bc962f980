#include "coupling/load_within_step.h"

#include "coupling/energy_balance.h"

#include <cmath>
#include <utility>

namespace ddfem::coupling
{
LoadWithinStep::LoadWithinStep(const Network &network, UnitLoad unit_load, Loading loading_at_start,
                               const BodyResponse &body_response)
    : unit(std::move(unit_load)), loading(std::move(loading_at_start)), response(body_response),
      start(network.node_capacity(), Vec3::Zero())
{
  for (const NodeIndex i : network.nodes())
    start[i.value] = network.position(i);
}

double LoadWithinStep::stress_change(const double work, const double time) const
{
  const BodyResponse moved{response.stress_at_rest - unit.fall_per_work * work, response.modulus};
  const LoadState &before = loading.state();
  return loading.state_at(before.time + time, moved).stress - before.stress;
}

std::vector<Vec3> LoadWithinStep::displacement_to(const Network &moved) const
{
  std::vector<Vec3> displacement(start.size(), Vec3::Zero());
  for (const NodeIndex i : moved.nodes())
    displacement[i.value] = moved.position(i) - start[i.value];
  return displacement;
}

double LoadWithinStep::stress_change(const Network &moved, const double time) const
{
  if (unit.fall_per_work == 0)
    return 0;
  // The work on the area between the two positions needs the lines of the first; those at hand are of the second.
  std::vector<Vec3> back = displacement_to(moved);
  for (Vec3 &d : back)
    d = -d;
  return stress_change(-work_on_lines(moved, unit.points, unit.stress, back), time);
}

void LoadWithinStep::add_to(NodalForces &forces, const Network &moved, const double change) const
{
  if (change == 0)
    return;
  std::size_t i = 0;
  for (const SegmentIndex s : moved.segments())
  {
    const Vec3 line = moved.direction(s), &b = moved.burgers(s);
    const auto fractions = unit.points.fractions(i), weights = unit.points.weights(i);
    SegmentForces ends{Vec3::Zero(), Vec3::Zero()};
    for (std::size_t q = 0; q < fractions.size(); ++q)
    {
      const Vec3 f = change * weights[q] * contract(unit.stress[unit.points.begin_of(i) + q], b).cross(line);
      ends.start += (1 - fractions[q]) * f;
      ends.end += fractions[q] * f;
    }
    forces.segment_ends[s.value].start += ends.start;
    forces.segment_ends[s.value].end += ends.end;
    forces.total[moved.start(s).value] += ends.start;
    forces.total[moved.end(s).value] += ends.end;
    ++i;
  }
}

double LoadWithinStep::work_of_change(const Network &network, const std::vector<Vec3> &displacement,
                                      const double dt) const
{
  if (unit.fall_per_work == 0)
    return 0;
  const double work = work_on_lines(network, unit.points, unit.stress, displacement);
  return 0.5 * stress_change(work, dt) * work;
}

double LoadWithinStep::stiffness(const Network &network, const VelocitySolver &velocities,
                                 const GrainShape *shape) const
{
  if (unit.fall_per_work == 0)
    return 0;
  // The change is of rank one: d(velocity)/d(position) = - c A^-1 g g^T with the forces g of a unit of nominal stress.
  NodalForces of_unit = no_forces(network);
  add_to(of_unit, network, 1.0);
  return std::abs(stress_change(1.0, 0.0) - stress_change(0.0, 0.0)) *
         velocities.largest_power(network, of_unit.total, shape);
}
} // namespace ddfem::coupling
