#include "fem/elastic_problem_implementation.h"

#include "fem/mesh.h"
#include "fem/problem_setup.h"
#include "fem/require.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <stdexcept>

namespace ddfem::fem
{
namespace
{
std::set<dealii::types::boundary_id> boundaries_of(const std::vector<DisplacementCondition> &conditions)
{
  std::set<dealii::types::boundary_id> boundaries;
  for (const DisplacementCondition &condition : conditions)
  {
    boundaries.insert(condition.boundary);
  }
  return boundaries;
}
} // namespace

ElasticProblem::Implementation::Implementation(const Triangulation &triangulation, const Parameters &given,
                                               const Moduli &moduli,
                                               const std::vector<DisplacementCondition> &displacement_conditions)
    : parameters(given), conditions(displacement_conditions), grid(triangulation, given.degree),
      areas(boundary_areas(triangulation, given.degree)), volume_centre(volume_and_centre(grid)),
      condition_of(assign_conditions(grid, conditions)),
      system(grid, flags_of(condition_of), lame_lambda(moduli), moduli.mu, volume_centre.second,
             std::cbrt(volume_centre.first), given.solver),
      boundary_load(grid, volume_centre.second, given.traction_tolerance),
      projection(grid, boundaries_of(conditions), projection_tolerance),
      recovery(grid, lame_lambda(moduli), moduli.mu, given.recovery == Recovery::patches),
      locator(grid, given.outside_tolerance), field_load(system.make_vector()), uniform_load(system.make_vector()),
      displacement(system.make_vector()), starts(system, given.n_start_vectors)
{
  displacement.update_ghost_values();
  for (unsigned node = 0; node < grid.n_owned_nodes; ++node)
  {
    if (!grid.node_boundaries[node].empty())
    {
      boundary_nodes.push_back(node);
      points.push_back(grid.positions[node]);
      ids.push_back(grid.node_boundaries[node]);
      const auto &k = condition_of[node];
      prescribed.push_back({k[0] >= 0, k[1] >= 0, k[2] >= 0});
    }
  }
}

NodalVector ElasticProblem::Implementation::from_boundary(const std::vector<dealii::Tensor<1, 3>> &values,
                                                          bool only_prescribed) const
{
  require(values.size() == points.size(), "displacements are given at ", values.size(), " points instead of the ",
          points.size(), " boundary points");
  NodalVector vector = system.make_vector();
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    for (unsigned c = 0; c < 3; ++c)
    {
      vector.local_element(3 * boundary_nodes[i] + c) = only_prescribed && !prescribed[i][c] ? 0. : values[i][c];
    }
  }
  return vector;
}

NodalVector ElasticProblem::Implementation::from_owned(const std::vector<double> &values) const
{
  NodalVector vector = system.make_vector();
  require(values.size() == vector.locally_owned_size(), "a solution with ", values.size(),
          " unknowns is given instead of ", vector.locally_owned_size());
  std::copy(values.begin(), values.end(), vector.begin());
  return vector;
}

void ElasticProblem::Implementation::set_displacement(const NodalVector &owned_values)
{
  displacement.zero_out_ghost_values();
  displacement.copy_locally_owned_data_from(owned_values);
  displacement.update_ghost_values();
  nodal_stress.clear();
}

SolveInfo ElasticProblem::Implementation::solve(const std::vector<dealii::Tensor<1, 3>> &values)
{
  const auto start = std::chrono::steady_clock::now();
  NodalVector total = from_boundary(values, true);
  NodalVector load = field_load;
  load += uniform_load;
  system.lift(total, load);
  const double given_norm = load.l2_norm();
  if (!std::isfinite(given_norm))
  {
    throw std::runtime_error(
        "the load of the elastic problem is not finite: check tractions and prescribed displacements");
  }
  const double removed = system.remove_resultant(load);
  const double norm = load.l2_norm();
  SolveInfo info;
  NodalVector x = system.make_vector();
  constexpr double nothing = 1e-200;
  if (norm > nothing)
  {
    x = starts.best(load);
    NodalVector residual = system.make_vector();
    const auto convergence =
        system.solve(x, residual, load, parameters.relative_tolerance * norm, parameters.max_iterations);
    info.iterations = convergence.iterations;
    info.initial_residual = convergence.initial_residual / norm;
    info.final_residual = convergence.final_residual / norm;
    info.unbalanced_load = removed / given_norm;
    load -= residual;
    starts.remember(x, load);
  }
  total += x;
  set_displacement(total);
  info.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return info;
}

NodalVector ElasticProblem::Implementation::nodal_reactions() const
{
  NodalVector load = field_load, residual = system.make_vector();
  load += uniform_load;
  system.reactions(displacement, load, residual);
  return residual;
}

std::vector<dealii::Tensor<1, 3>> ElasticProblem::Implementation::at_boundary(const NodalVector &vector) const
{
  std::vector<dealii::Tensor<1, 3>> result;
  result.reserve(boundary_nodes.size());
  for (const unsigned node : boundary_nodes)
  {
    result.push_back(dealii::Tensor<1, 3>(
        {vector.local_element(3 * node), vector.local_element(3 * node + 1), vector.local_element(3 * node + 2)}));
  }
  return result;
}

const std::vector<double> &ElasticProblem::Implementation::stress() const
{
  int empty = nodal_stress.empty() ? 1 : 0;
  // A rank without cells always has none: all must agree to take part.
  MPI_Allreduce(MPI_IN_PLACE, &empty, 1, MPI_INT, MPI_MAX, grid.communicator);
  if (empty != 0)
  {
    nodal_stress = recovery.recover(displacement);
  }
  return nodal_stress;
}
} // namespace ddfem::fem
