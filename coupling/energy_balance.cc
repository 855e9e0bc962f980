#include "coupling/energy_balance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ddfem::coupling
{
namespace
{
using NodalVectors = std::vector<dealii::Tensor<1, 3>>;

double product(const NodalVectors &a, const NodalVectors &b)
{
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += a[i] * b[i];
  return sum;
}

/// 1/2 (a + b) . (d - c).
double mean_times_change(const NodalVectors &a, const NodalVectors &b, const NodalVectors &c, const NodalVectors &d)
{
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += 0.5 * (a[i] + b[i]) * (d[i] - c[i]);
  return sum;
}

double correction_energy(const BoundaryState &s)
{
  return 0.5 * (product(s.reaction, s.correction) - product(s.load, s.correction));
}

double double_contraction(const SymTensor &a, const SymTensor &b)
{
  return a.head<3>().dot(b.head<3>()) + 2 * a.tail<3>().dot(b.tail<3>());
}

/// Elastic strain of a stress.
SymTensor compliance(const IsotropicMedium &m, const SymTensor &stress)
{
  SymTensor strain = stress / (2 * m.mu);
  strain.head<3>().array() -= m.nu / (2 * m.mu * (1 + m.nu)) * stress.head<3>().sum();
  return strain;
}
} // namespace

double work_on_lines(const Network &network, const SegmentPoints &points, const std::vector<SymTensor> &stress,
                     const std::vector<Vec3> &displacement)
{
  double work = 0;
  std::size_t i = 0;
  for (const SegmentIndex s : network.segments())
  {
    const Vec3 &du_start = displacement[network.start(s).value], &du_end = displacement[network.end(s).value];
    // The area swept by a straight segment between two positions is that of its mean line vector.
    const Vec3 line = network.direction(s) + 0.5 * (du_end - du_start);
    const auto fractions = points.fractions(i), weights = points.weights(i);
    for (std::size_t q = 0; q < fractions.size(); ++q)
    {
      const Vec3 force = weights[q] * contract(stress[points.begin_of(i) + q], network.burgers(s)).cross(line);
      work += force.dot((1 - fractions[q]) * du_start + fractions[q] * du_end);
    }
    ++i;
  }
  return work;
}

double work_of_nodal_forces(const Network &network, const std::vector<Vec3> &first, const std::vector<Vec3> &last,
                            const std::vector<Vec3> &displacement)
{
  double work = 0;
  for (const NodeIndex i : network.nodes())
    work += 0.5 * (first[i.value] + last[i.value]).dot(displacement[i.value]);
  return work;
}

std::vector<Vec3> swept_centres(const SweptArea &area, const GrainShape *shape)
{
  std::vector<Vec3> centres;
  for (const SweptTriangle &t : area.triangles())
    if (t.inside)
    {
      Vec3 x = (t.vertices[0].value + t.vertices[1].value + t.vertices[2].value) / 3;
      if (const double outside = shape ? shape->signed_distance(x) : 0.0; outside > 0)
        x -= outside * shape->outward_normal(x);
      centres.push_back(x);
    }
  return centres;
}

double work_on_area(const SweptArea &area, const std::vector<SymTensor> &stress)
{
  double work = 0;
  std::size_t k = 0;
  for (const SweptTriangle &t : area.triangles())
    if (t.inside)
    {
      const Vec3 &origin = t.vertices[0].value;
      const Vec3 a = 0.5 * (t.vertices[1].value - origin).cross(t.vertices[2].value - origin);
      work -= t.burgers.dot(contract(stress[k++], a));
    }
  return work;
}

void EnergyBalance::start(const SymTensor &stress, const SymTensor &plastic_strain)
{
  last_stress = stress;
  last_plastic_strain = plastic_strain;
}

void EnergyBalance::add(const double work, const double stored, const LineWork &lines)
{
  sums.work += work;
  sums.stored += stored + lines.external - lines.total;
  sums.dissipated += lines.total + lines.topology;
  sums.topology += lines.topology;
  scale = std::max({scale, std::abs(sums.work), std::abs(sums.dissipated)});
}

Energies EnergyBalance::energies_with(const double platen_work, const LineWork &lines) const
{
  Energies result = sums;
  result.work += platen_work;
  result.dissipated += lines.total + lines.topology;
  result.topology += lines.topology;
  result.stored = result.work - result.dissipated - sums.mismatch();
  return result;
}

void EnergyBalance::add(const BoundaryState &boundary, const LineWork &lines, MPI_Comm communicator)
{
  const BoundaryState &old = last_boundary;
  std::array<double, 2> change{};
  // Prescribed displacements are those of the total field: the reactions are zero on all other components.
  change[0] = mean_times_change(old.reaction, boundary.reaction, old.correction, boundary.correction) +
              mean_times_change(old.reaction, boundary.reaction, old.infinite, boundary.infinite);
  change[1] = correction_energy(boundary) - correction_energy(old) -
              mean_times_change(old.load, boundary.load, old.infinite, boundary.infinite);
  MPI_Allreduce(MPI_IN_PLACE, change.data(), 2, MPI_DOUBLE, MPI_SUM, communicator);
  add(change[0], change[1], lines);
  last_boundary = boundary;
}

void EnergyBalance::add(const IsotropicMedium &medium, const double volume, const SymTensor &stress,
                        const SymTensor &plastic_strain, const LineWork &lines)
{
  const SymTensor mean = 0.5 * (last_stress + stress);
  const double stored = volume * double_contraction(mean, compliance(medium, stress - last_stress));
  const double plastic = volume * double_contraction(mean, plastic_strain - last_plastic_strain);
  add(stored + plastic, stored, lines);
  start(stress, plastic_strain);
}
} // namespace ddfem::coupling
