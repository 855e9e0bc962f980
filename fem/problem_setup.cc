#include "fem/problem_setup.h"

#include "fem/element.h"
#include "fem/require.h"

#include <algorithm>
#include <cmath>

namespace ddfem::fem
{
void check(const ElasticProblem::Parameters &parameters)
{
  require(parameters.degree == 1 || parameters.degree == 2, "the degree of the elements must be 1 or 2, but is ",
          parameters.degree);
  require(parameters.relative_tolerance > 0. && parameters.relative_tolerance < 1.,
          "the relative tolerance of the elastic solve must lie between 0 and 1, but is ",
          parameters.relative_tolerance);
  require(parameters.traction_tolerance > 0. && parameters.traction_tolerance < 1.,
          "the tolerance of the tractions must lie between 0 and 1, but is ", parameters.traction_tolerance);
  require(parameters.outside_tolerance >= 0. && parameters.outside_tolerance < 1.,
          "the tolerance for points outside must lie between 0 and 1, but is ", parameters.outside_tolerance);
  require(parameters.n_start_vectors > 0, "a solve must start from at least one earlier solution, not from ",
          parameters.n_start_vectors);
}

void check(const Moduli &moduli)
{
  require(moduli.mu > 0. && std::isfinite(moduli.mu), "the shear modulus must be positive, but is ", moduli.mu, " MPa");
  require(moduli.nu > -1. && moduli.nu < 0.5, "Poisson's ratio must lie between -1 and 0.5, but is ", moduli.nu);
}

double lame_lambda(const Moduli &moduli)
{
  return 2. * moduli.mu * moduli.nu / (1. - 2. * moduli.nu);
}

std::pair<double, dealii::Point<3>> volume_and_centre(const NodalGrid &grid)
{
  std::array<double, 4> sums{};
  std::vector<dealii::Point<3>> nodes(grid.nodes_per_cell);
  for (unsigned cell = 0; cell < grid.n_cells(); ++cell)
  {
    for (unsigned a = 0; a < grid.nodes_per_cell; ++a)
    {
      nodes[a] = grid.positions[grid.nodes_of(cell)[a]];
    }
    const auto [volume, moment] = element_volume(grid.degree, nodes);
    sums[0] += volume;
    for (unsigned d = 0; d < 3; ++d)
    {
      sums[1 + d] += moment[d];
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 4, MPI_DOUBLE, MPI_SUM, grid.communicator);
  return {sums[0], dealii::Point<3>(sums[1] / sums[0], sums[2] / sums[0], sums[3] / sums[0])};
}

std::vector<std::array<int, 3>> assign_conditions(const NodalGrid &grid,
                                                  const std::vector<DisplacementCondition> &conditions)
{
  std::vector<std::array<int, 3>> owner(grid.positions.size(), {-1, -1, -1});
  for (std::size_t node = 0; node < owner.size(); ++node)
  {
    const auto &ids = grid.node_boundaries[node];
    for (std::size_t k = 0; k < conditions.size() && !ids.empty(); ++k)
    {
      const bool here = std::find(ids.begin(), ids.end(), conditions[k].boundary) != ids.end();
      for (unsigned c = 0; here && c < 3; ++c)
      {
        if (conditions[k].components[c] && owner[node][c] < 0)
        {
          owner[node][c] = static_cast<int>(k);
        }
      }
    }
  }
  return owner;
}

std::vector<std::array<bool, 3>> flags_of(const std::vector<std::array<int, 3>> &owner)
{
  std::vector<std::array<bool, 3>> flags;
  for (const auto &k : owner)
  {
    flags.push_back({k[0] >= 0, k[1] >= 0, k[2] >= 0});
  }
  return flags;
}
} // namespace ddfem::fem
