// Corrections that are not solved for: what CorrectionUpdate asks of the grain.
#include "coupling/convert.h"
#include "coupling/energy_balance.h"
#include "coupling/finite_grain.h"

#include <algorithm>
#include <cmath>

namespace ddfem::coupling
{
FiniteGrain::ElementState FiniteGrain::element_state() const
{
  return {at_rest, problem->field_load()};
}

void FiniteGrain::extrapolate_to(const LineSystem &lines, const ElementState &state, const double load_at_rest,
                                 GrainSolution &solution)
{
  update_images(lines);
  at_rest = state.unknowns;
  problem->set_field_load(state.load);
  problem->set_solution(at_rest);
  solution.load_at_rest = platen_load();
  if (load_per_motion != 0)
  {
    const double q = (load_at_rest - solution.load_at_rest) / load_per_motion;
    for (std::size_t i = 0; i < at_rest.size(); ++i)
      at_rest[i] += q * unit_response[i];
    solution.load_at_rest = load_at_rest;
  }
  solution.solve = {};
  solution.solved = false;
}

double FiniteGrain::load_of_swept_area(const SweptArea &area) const
{
  if (load_per_motion == 0)
    return 0;
  const std::vector<dealii::Point<3>> centres = to_points(swept_centres(area, grain_shape.get()));
  std::vector<SymTensor> stress;
  for (const auto &s : problem->stress_at(centres, unit_stress))
    stress.push_back(to_sym_tensor(s));
  return -work_on_area(area, stress);
}

UnitLoad FiniteGrain::unit_load(const Network &network) const
{
  if (load_per_motion == 0)
    return {};
  UnitLoad unit;
  unit.points = SegmentPoints(network);
  const double nominal_stress = load_per_motion * platen_motion->stress_per_load(); // of unit motion
  for (const auto &s : problem->stress_at(to_points(unit.points.positions()), unit_stress))
    unit.stress.push_back(to_sym_tensor(s) / nominal_stress);
  unit.fall_per_work = nominal_stress * platen_motion->stress_per_load();
  return unit;
}

double FiniteGrain::element_size() const
{
  return std::cbrt(problem->volume() / static_cast<double>(problem->n_cells()));
}

double FiniteGrain::depth_for_elements(const Vec3 &x) const
{
  const double to_surface = std::max(0.0, -grain_shape->signed_distance(x));
  const auto depth_under = [&](const ImagePlane &p) { return (p.point - x).dot(p.outward); };
  const double rounding = 1e-9 * grain_shape->diameter();
  const bool under_images =
      std::ranges::any_of(planes_of_images, [&](const ImagePlane &p)
                          { return depth_under(p) < std::min(to_surface + rounding, depth_of_images()); });
  if (!under_images)
    return to_surface;
  const Vec3 &platen_centre = platen_motion->centre();
  const double along = x[axis],
               to_held = std::min(std::abs(along - platen_centre[axis]), std::abs(along - fixed_centre[axis]));
  return std::min(depth_of_images(), to_held);
}
} // namespace ddfem::coupling
