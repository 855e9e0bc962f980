#include "fem/elastic_problem.h"

#include "fem/boundary_load.h"
#include "fem/elastic_system.h"
#include "fem/mesh.h"
#include "fem/point_locator.h"
#include "fem/problem_setup.h"
#include "fem/require.h"
#include "fem/start_vectors.h"
#include "fem/stress_recovery.h"
#include "fem/surface_output.h"
#include "fem/trace_projection.h"

#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

namespace ddfem::fem
{
namespace
{
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

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

class ElasticProblem::Implementation
{
public:
  Implementation(const Triangulation &triangulation, const Parameters &given, const Moduli &moduli,
                 const std::vector<DisplacementCondition> &displacement_conditions)
      : parameters(given), conditions(displacement_conditions), grid(triangulation, given.degree),
        areas(boundary_areas(triangulation, given.degree)), volume_centre(volume_and_centre(grid)),
        condition_of(assign_conditions(grid, conditions)),
        system(grid, flags_of(condition_of), lame_lambda(moduli), moduli.mu, volume_centre.second,
               std::cbrt(volume_centre.first)),
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

  SolveInfo solve(const std::vector<dealii::Tensor<1, 3>> &values);
  NodalVector nodal_reactions() const;
  /// Sum of term(x, force) over the nodes x (nm) where the conditions of a boundary exert a force.
  template <class NodeTerm>
  dealii::Tensor<1, 3> sum_of_reactions(dealii::types::boundary_id boundary, NodeTerm &&term) const;
  std::vector<dealii::Tensor<1, 3>> at_boundary(const NodalVector &vector) const;
  const std::vector<double> &stress() const;
  void set_displacement(const NodalVector &owned_values);
  NodalVector from_owned(const std::vector<double> &values) const;
  std::vector<double> owned(const NodalVector &vector) const { return {vector.begin(), vector.end()}; }

  /// A vector with the given values at boundary_points() and zero elsewhere; only prescribed components, if asked for.
  NodalVector from_boundary(const std::vector<dealii::Tensor<1, 3>> &values, bool only_prescribed) const;

  Parameters parameters;
  const std::vector<DisplacementCondition> conditions;
  const NodalGrid grid;
  const std::map<dealii::types::boundary_id, double> areas;
  const std::pair<double, dealii::Point<3>> volume_centre;
  const std::vector<std::array<int, 3>> condition_of;
  const ElasticSystem system;
  const BoundaryLoad boundary_load;
  const TraceProjection projection;
  const StressRecovery recovery;
  mutable PointLocator locator;
  NodalVector field_load, uniform_load;
  NodalVector displacement;                 // with ghost values
  mutable std::vector<double> nodal_stress; // empty until asked for
  std::vector<unsigned> boundary_nodes;
  std::vector<dealii::Point<3>> points;
  std::vector<std::array<bool, 3>> prescribed;
  std::vector<std::vector<dealii::types::boundary_id>> ids;
  double setup_time = 0.;
  StartVectors starts;
};

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
  const auto start_time = Clock::now();
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
    const auto convergence = system.solve(x, load, parameters.relative_tolerance * norm, parameters.max_iterations);
    info.iterations = convergence.iterations;
    info.initial_residual = convergence.initial_residual / norm;
    info.final_residual = convergence.final_residual / norm;
    info.unbalanced_load = removed / given_norm;
    starts.remember(x);
  }
  total += x;
  set_displacement(total);
  info.seconds = seconds_since(start_time);
  return info;
}

NodalVector ElasticProblem::Implementation::nodal_reactions() const
{
  NodalVector load = field_load, residual = system.make_vector();
  load += uniform_load;
  system.reactions(displacement, load, residual);
  return residual;
}

template <class NodeTerm>
dealii::Tensor<1, 3> ElasticProblem::Implementation::sum_of_reactions(dealii::types::boundary_id boundary,
                                                                      NodeTerm &&term) const
{
  const NodalVector residual = nodal_reactions();
  dealii::Tensor<1, 3> sum;
  for (std::size_t i = 0; i < boundary_nodes.size(); ++i)
  {
    dealii::Tensor<1, 3> force;
    for (unsigned c = 0; c < 3; ++c)
    {
      const int k = condition_of[boundary_nodes[i]][c];
      if (k >= 0 && conditions[static_cast<std::size_t>(k)].boundary == boundary)
      {
        force[c] = residual.local_element(3 * boundary_nodes[i] + c);
      }
    }
    sum += term(points[i], force);
  }
  MPI_Allreduce(MPI_IN_PLACE, sum.begin_raw(), 3, MPI_DOUBLE, MPI_SUM, grid.communicator);
  return sum;
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

ElasticProblem::ElasticProblem(const Triangulation &triangulation, const Parameters &parameters, const Moduli &moduli,
                               const std::vector<DisplacementCondition> &conditions)
{
  const auto start = Clock::now();
  check(parameters);
  check(moduli);
  const auto areas = boundary_areas(triangulation, 1);
  for (const auto &condition : conditions)
  {
    require(areas.count(condition.boundary) > 0, "a displacement is prescribed on boundary ", condition.boundary,
            ", which the mesh does not have");
  }
  implementation = std::make_unique<Implementation>(triangulation, parameters, moduli, conditions);
  implementation->setup_time = seconds_since(start);
}

ElasticProblem::~ElasticProblem() = default;

const std::vector<dealii::Point<3>> &ElasticProblem::boundary_points() const
{
  return implementation->points;
}

const std::vector<std::array<bool, 3>> &ElasticProblem::prescribed_components() const
{
  return implementation->prescribed;
}

const std::vector<std::vector<dealii::types::boundary_id>> &ElasticProblem::boundary_ids() const
{
  return implementation->ids;
}

TractionSummary ElasticProblem::set_tractions(const TractionField &field)
{
  implementation->field_load = 0.;
  return implementation->boundary_load.add_field(field, implementation->field_load);
}

void ElasticProblem::add_uniform_traction(dealii::types::boundary_id boundary, const dealii::Tensor<1, 3> &traction)
{
  require(implementation->areas.count(boundary) > 0, "a traction is given on boundary ", boundary,
          ", which the mesh does not have");
  implementation->boundary_load.add_uniform(boundary, traction, implementation->uniform_load);
}

void ElasticProblem::clear_uniform_tractions()
{
  implementation->uniform_load = 0.;
}

void ElasticProblem::clear_tractions()
{
  implementation->field_load = 0.;
  implementation->uniform_load = 0.;
}

std::vector<dealii::Tensor<1, 3>> ElasticProblem::project_on_conditions(const TractionField &field) const
{
  return implementation->at_boundary(implementation->projection.project(field));
}

SolveInfo ElasticProblem::solve(const std::vector<dealii::Tensor<1, 3>> &prescribed)
{
  return implementation->solve(prescribed);
}

void ElasticProblem::set_relative_tolerance(double tolerance)
{
  auto changed = implementation->parameters;
  changed.relative_tolerance = tolerance;
  check(changed);
  implementation->parameters = changed;
}

std::vector<dealii::Tensor<1, 3>> ElasticProblem::boundary_displacements() const
{
  return implementation->at_boundary(implementation->displacement);
}

dealii::Tensor<1, 3> ElasticProblem::reaction(dealii::types::boundary_id boundary) const
{
  return implementation->sum_of_reactions(boundary, [](const auto &, const auto &force) { return force; });
}

dealii::Tensor<1, 3> ElasticProblem::reaction_moment(dealii::types::boundary_id boundary,
                                                     const dealii::Point<3> &about) const
{
  return implementation->sum_of_reactions(boundary, [&](const auto &x, const auto &force)
                                          { return cross_product_3d(x - about, force); });
}

std::vector<dealii::Tensor<1, 3>> ElasticProblem::boundary_reactions() const
{
  return implementation->at_boundary(implementation->nodal_reactions());
}

std::vector<dealii::Tensor<1, 3>> ElasticProblem::boundary_loads() const
{
  NodalVector load = implementation->field_load;
  load += implementation->uniform_load;
  return implementation->at_boundary(load);
}

std::vector<dealii::SymmetricTensor<2, 3>> ElasticProblem::stress_at(const std::vector<dealii::Point<3>> &points) const
{
  const auto values = implementation->locator.evaluate(points, 6, implementation->stress());
  std::vector<dealii::SymmetricTensor<2, 3>> result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const double *const s = &values[6 * i];
    result[i][0][0] = s[0];
    result[i][1][1] = s[1];
    result[i][2][2] = s[2];
    result[i][0][1] = s[3];
    result[i][0][2] = s[4];
    result[i][1][2] = s[5];
  }
  return result;
}

std::vector<dealii::Tensor<1, 3>> ElasticProblem::displacement_at(const std::vector<dealii::Point<3>> &points) const
{
  const auto &u = implementation->displacement;
  std::vector<double> nodal(3 * implementation->grid.positions.size());
  for (unsigned i = 0; i < nodal.size(); ++i)
  {
    nodal[i] = u.local_element(i);
  }
  const auto values = implementation->locator.evaluate(points, 3, nodal);
  std::vector<dealii::Tensor<1, 3>> result;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    result.push_back(dealii::Tensor<1, 3>({values[3 * i], values[3 * i + 1], values[3 * i + 2]}));
  }
  return result;
}

std::vector<double> ElasticProblem::solution() const
{
  return implementation->owned(implementation->displacement);
}

void ElasticProblem::set_solution(const std::vector<double> &values)
{
  implementation->set_displacement(implementation->from_owned(values));
}

std::vector<std::vector<double>> ElasticProblem::start_vectors() const
{
  std::vector<std::vector<double>> values;
  for (const NodalVector *const vector : implementation->starts.vectors())
  {
    values.push_back(implementation->owned(*vector));
  }
  return values;
}

void ElasticProblem::set_start_vectors(const std::vector<std::vector<double>> &vectors)
{
  implementation->starts.clear();
  for (auto v = vectors.rbegin(); v != vectors.rend(); ++v)
  {
    implementation->starts.remember(implementation->from_owned(*v));
  }
}

std::string ElasticProblem::write_surface(const std::string &directory, const std::string &base_name,
                                          const std::vector<dealii::Tensor<1, 3>> &extra_displacement) const
{
  NodalVector total = implementation->from_boundary(extra_displacement, false);
  total += implementation->displacement;
  total.update_ghost_values();
  const SurfaceFields fields{total, implementation->displacement, implementation->stress()};
  return write_surface_files(implementation->grid, fields, directory, base_name);
}

std::uint64_t ElasticProblem::n_dofs() const
{
  return implementation->grid.n_global_dofs;
}

std::uint64_t ElasticProblem::n_cells() const
{
  return implementation->grid.n_global_cells;
}

unsigned ElasticProblem::n_free_rigid_modes() const
{
  return static_cast<unsigned>(implementation->system.n_free_modes());
}

double ElasticProblem::volume() const
{
  return implementation->volume_centre.first;
}

double ElasticProblem::boundary_area(dealii::types::boundary_id boundary) const
{
  const auto found = implementation->areas.find(boundary);
  return found == implementation->areas.end() ? 0. : found->second;
}

dealii::Point<3> ElasticProblem::centre() const
{
  return implementation->volume_centre.second;
}

double ElasticProblem::setup_seconds() const
{
  return implementation->setup_time;
}
} // namespace ddfem::fem
