#include "samples/multipole_errors.h"

#include "dd/elasticity/gauss.h"
#include "samples/values.h"

#include <algorithm>
#include <cmath>

namespace ddfem::samples
{
namespace
{
/// Of the pairs of lines that the direct sum integrates.
constexpr double reference_tolerance = 1e-11;

template <class Values> FieldError compare(const Values &values, const Values &exact, const Values &far)
{
  const Values d = difference(values, exact);
  FieldError e{rms(d), 0, rms(far), rms(exact)};
  for (const auto &v : d)
    e.largest = std::max(e.largest, v.norm());
  return e;
}
} // namespace

MultipoleErrorMeter::MultipoleErrorMeter(const SampleLines &lines, const std::size_t n_points)
    : sample(lines), system(lines.system()), points(points_among(system, n_points)), exact_force(direct_forces()),
      exact_stress(system.stress(points))
{
}

template <class ForcesOf> std::vector<Vec3> MultipoleErrorMeter::at_nodes(ForcesOf &&forces_of) const
{
  std::vector<SegmentForces> on_lines(system.lines().size());
#pragma omp parallel for schedule(dynamic, 64)
  for (std::size_t i = 0; i < on_lines.size(); ++i)
    on_lines[i] = forces_of(i);
  std::vector<Vec3> force(sample.network.node_capacity(), Vec3::Zero());
  std::size_t i = 0;
  for (const SegmentIndex s : sample.network.segments())
  {
    force[sample.network.start(s).value] += on_lines[i].start;
    force[sample.network.end(s).value] += on_lines[i].end;
    ++i;
  }
  return force;
}

/// Of a stress at the Gauss points of the panels, by their rule alone.
std::vector<Vec3> MultipoleErrorMeter::nodal_forces(const std::vector<SymTensor> &stress,
                                                    const MultipoleForces &forces) const
{
  const GaussRule rule = gauss_rule(forces.n_gauss_points());
  const std::size_t n = rule.points.size();
  return at_nodes(
      [&](const std::size_t i)
      {
        const StraightLine &line = system.lines()[i];
        const Vec3 t = line.end - line.start;
        const std::size_t first = forces.first_point_of(i), n_panels = (forces.first_point_of(i + 1) - first) / n;
        const double length = 1 / static_cast<double>(n_panels); // of a panel
        SegmentForces f;
        for (std::size_t q = 0; q < n * n_panels; ++q)
        {
          const double s = (static_cast<double>(q / n) + rule.points[q % n]) * length;
          const Vec3 df = rule.weights[q % n] * length * contract(stress[first + q], line.burgers).cross(t);
          f.start += (1 - s) * df;
          f.end += s * df;
        }
        return f;
      });
}

std::vector<Vec3> MultipoleErrorMeter::direct_forces() const
{
  ForceSettings settings{system.medium(), system.medium().a, reference_tolerance};
  settings.summation.method = SummationMethod::direct;
  ForceEnvironment environment;
  environment.shape = sample.shape.get();
  environment.cell = sample.cell.get();
  environment.images = sample.images.get();
  const NodalForces forces = compute_nodal_forces(sample.network, settings, environment, MPI_COMM_SELF, true);
  std::vector<Vec3> sum(sample.network.node_capacity(), Vec3::Zero());
  for (const ForceContribution c : {ForceContribution::pairs, ForceContribution::rays, ForceContribution::images})
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum[i] += forces.by_contribution[static_cast<std::size_t>(c)][i];
  return sum;
}

FieldError MultipoleErrorMeter::stress_error(const fmm::MultipoleSettings &settings) const
{
  MultipoleField field(system, points, settings);
  const auto far = field.sum().stress(MPI_COMM_SELF, fmm::Part::far);
  return compare(field.stress(MPI_COMM_SELF), exact_stress, far);
}

MultipoleErrors MultipoleErrorMeter::errors(const double tolerance, const double cost_factor,
                                            const double pair_tolerance) const
{
  const fmm::MultipoleSettings settings{tolerance, 0, cost_factor};
  MultipoleErrors e;
  e.stress = stress_error(settings);
  const MultipoleForces forces(system, settings, pair_tolerance, MPI_COMM_SELF);
  e.order = forces.field().sum().order();
  e.n_gauss = forces.n_gauss_points();
  // A field of the same points has the same tree.
  const std::vector<Vec3> on_lines = forces.field().at();
  const auto exact = system.stress(on_lines);
  MultipoleField field(system, on_lines, settings);
  const auto far = field.sum().stress(MPI_COMM_SELF, fmm::Part::far);
  const auto value = field.stress(MPI_COMM_SELF);
  e.stress_on_lines = compare(value, exact, far);
  e.force = compare(at_nodes(forces), exact_force, nodal_forces(far, forces));
  e.force_error_of_stress = rms(nodal_forces(difference(value, exact), forces));
  return e;
}
} // namespace ddfem::samples
