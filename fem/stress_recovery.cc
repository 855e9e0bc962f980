#include "fem/stress_recovery.h"

namespace ddfem::fem
{
namespace
{
/// Value at x of the polynomial that is one at Gauss point k of the unit interval and zero at the others (one or two
/// points).
double gauss_lagrange(unsigned n, unsigned k, const CubeRule &rule, double x)
{
  if (n == 1)
  {
    return 1.;
  }
  const double own = rule.points[k][0], other = rule.points[1 - k][0];
  return (x - other) / (own - other);
}
} // namespace

StressRecovery::StressRecovery(const NodalGrid &nodal_grid, double lame_lambda, double shear_modulus, bool by_patches)
    : grid(nodal_grid), lambda(lame_lambda), mu(shear_modulus)
{
  const CubeRule rule = gauss_cube(grid.degree);
  n_points = static_cast<unsigned>(rule.points.size());
  for (const auto &point : rule.points)
  {
    const LagrangeCell shape = lagrange_cell(grid.degree, point);
    gradients.emplace_back(shape.gradient.begin(), shape.gradient.begin() + grid.nodes_per_cell);
  }
  make_extrapolation(rule);
  NodalVector counts(grid.partitioner);
  for (unsigned cell = 0; cell < grid.n_cells(); ++cell)
  {
    const unsigned *const nodes = grid.nodes_of(cell);
    for (const auto &point : rule.points)
    {
      const auto inverse =
          invert(jacobian(lagrange_cell(grid.degree, point), grid.nodes_per_cell,
                          [&](unsigned a) -> const dealii::Point<3> & { return grid.positions[nodes[a]]; }));
      for (unsigned i = 0; i < 9; ++i)
      {
        inverse_jacobians.push_back(inverse[i / 3][i % 3]);
      }
    }
    for (unsigned a = 0; a < grid.nodes_per_cell; ++a)
    {
      counts.local_element(3 * nodes[a]) += 1.;
    }
  }
  counts.compress(dealii::VectorOperation::add);
  counts.update_ghost_values();
  for (unsigned node = 0; node < grid.positions.size(); ++node)
  {
    weights.push_back(1. / counts.local_element(3 * node));
  }
  if (by_patches)
  {
    patches = std::make_unique<PatchFit>(grid, rule.points);
  }
}

void StressRecovery::make_extrapolation(const CubeRule &rule)
{
  const unsigned n = grid.degree, per_direction = grid.degree + 1;
  for (unsigned a = 0; a < grid.nodes_per_cell; ++a)
  {
    const std::array<unsigned, 3> index = {a % per_direction, a / per_direction % per_direction,
                                           a / (per_direction * per_direction)};
    extrapolation.emplace_back(n_points, 1.);
    for (unsigned q = 0; q < n_points; ++q)
    {
      const std::array<unsigned, 3> point = {q % n, q / n % n, q / (n * n)};
      for (unsigned d = 0; d < 3; ++d)
      {
        extrapolation[a][q] *= gauss_lagrange(n, point[d], rule, static_cast<double>(index[d]) / grid.degree);
      }
    }
  }
}

void StressRecovery::stress_at_gauss_points(unsigned cell, const NodalVector &displacement,
                                            std::array<double, 6> *stress) const
{
  const unsigned *const nodes = grid.nodes_of(cell);
  for (unsigned q = 0; q < n_points; ++q)
  {
    const double *const inverse = &inverse_jacobians[(std::size_t{cell} * n_points + q) * 9];
    double unit[3][3] = {}, h[3][3] = {}; // gradients in unit and in real coordinates
    for (unsigned a = 0; a < grid.nodes_per_cell; ++a)
    {
      for (unsigned c = 0; c < 3; ++c)
      {
        const double u = displacement.local_element(3 * nodes[a] + c);
        for (unsigned j = 0; j < 3; ++j)
        {
          unit[c][j] += u * gradients[q][a][j];
        }
      }
    }
    for (unsigned c = 0; c < 3; ++c)
    {
      for (unsigned j = 0; j < 3; ++j)
      {
        h[c][j] = unit[c][0] * inverse[j] + unit[c][1] * inverse[3 + j] + unit[c][2] * inverse[6 + j];
      }
    }
    const double volumetric = lambda * (h[0][0] + h[1][1] + h[2][2]);
    stress[q] = {volumetric + 2. * mu * h[0][0], volumetric + 2. * mu * h[1][1], volumetric + 2. * mu * h[2][2],
                 mu * (h[0][1] + h[1][0]),       mu * (h[0][2] + h[2][0]),       mu * (h[1][2] + h[2][1])};
  }
}

std::vector<double> StressRecovery::recover(const NodalVector &displacement) const
{
  std::vector<std::array<double, 6>> stress(std::size_t{grid.n_cells()} * n_points);
#pragma omp parallel for schedule(static)
  for (unsigned cell = 0; cell < grid.n_cells(); ++cell)
  {
    stress_at_gauss_points(cell, displacement, &stress[std::size_t{cell} * n_points]);
  }
  std::vector<double> result = averages(stress);
  if (patches)
  {
    const std::vector<double> fitted = patches->nodal_values(stress);
    for (unsigned i = 0; i < result.size(); ++i)
    {
      result[i] = patches->covered(i / 6) ? fitted[i] : result[i];
    }
  }
  return result;
}

std::vector<double> StressRecovery::averages(const std::vector<std::array<double, 6>> &stress) const
{
  NodalVector normal(grid.partitioner), shear(grid.partitioner);
  for (unsigned cell = 0; cell < grid.n_cells(); ++cell)
  {
    for (unsigned a = 0; a < grid.nodes_per_cell; ++a)
    {
      const unsigned first = 3 * grid.nodes_of(cell)[a];
      for (unsigned q = 0; q < n_points; ++q)
      {
        for (unsigned c = 0; c < 3; ++c)
        {
          normal.local_element(first + c) += extrapolation[a][q] * stress[std::size_t{cell} * n_points + q][c];
          shear.local_element(first + c) += extrapolation[a][q] * stress[std::size_t{cell} * n_points + q][3 + c];
        }
      }
    }
  }
  for (NodalVector *const part : {&normal, &shear})
  {
    part->compress(dealii::VectorOperation::add);
    part->update_ghost_values();
  }
  std::vector<double> result;
  result.reserve(6 * grid.positions.size());
  for (unsigned node = 0; node < grid.positions.size(); ++node)
  {
    for (unsigned c = 0; c < 6; ++c)
    {
      result.push_back(weights[node] * (c < 3 ? normal : shear).local_element(3 * node + c % 3));
    }
  }
  return result;
}
} // namespace ddfem::fem
