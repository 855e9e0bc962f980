#include "fem/elastic_problem.h"

#include "fem/elastic_problem_implementation.h"
#include "fem/mesh.h"
#include "fem/problem_setup.h"
#include "fem/require.h"
#include "fem/surface_output.h"

#include <chrono>

namespace ddfem::fem
{
ElasticProblem::ElasticProblem(const Triangulation &triangulation, const Parameters &parameters, const Moduli &moduli,
                               const std::vector<DisplacementCondition> &conditions)
{
  const auto start = std::chrono::steady_clock::now();
  check(parameters);
  check(moduli);
  const auto areas = boundary_areas(triangulation, 1);
  for (const auto &condition : conditions)
  {
    require(areas.count(condition.boundary) > 0, "a displacement is prescribed on boundary ", condition.boundary,
            ", which the mesh does not have");
  }
  implementation = std::make_unique<Implementation>(triangulation, parameters, moduli, conditions);
  implementation->setup_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
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
  return stress_at(points, implementation->stress());
}

std::vector<double> ElasticProblem::recovered_stress() const
{
  return implementation->stress();
}

std::vector<dealii::SymmetricTensor<2, 3>> ElasticProblem::stress_at(const std::vector<dealii::Point<3>> &points,
                                                                     const std::vector<double> &recovered) const
{
  require(recovered.size() == 6 * implementation->grid.positions.size(), "a recovered stress has ", recovered.size(),
          " numbers instead of six for each of the ", implementation->grid.positions.size(), " nodes");
  const auto values = implementation->locator.evaluate(points, 6, recovered);
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

std::vector<double> ElasticProblem::field_load() const
{
  return implementation->owned(implementation->field_load);
}

void ElasticProblem::set_field_load(const std::vector<double> &values)
{
  implementation->field_load = implementation->from_owned(values);
}

std::vector<std::vector<double>> ElasticProblem::start_vectors() const
{
  std::vector<std::vector<double>> values;
  for (const NodalVector *const vector : implementation->starts.state())
  {
    values.push_back(implementation->owned(*vector));
  }
  return values;
}

void ElasticProblem::set_start_vectors(const std::vector<std::vector<double>> &vectors)
{
  std::vector<NodalVector> state;
  for (const auto &v : vectors)
  {
    state.push_back(implementation->from_owned(v));
  }
  implementation->starts.restore(state);
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
