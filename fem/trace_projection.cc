#include "fem/trace_projection.h"

#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/solver_cg.h>

#include <utility>

namespace ddfem::fem
{
namespace
{
/// A field on some boundaries only.
class Restricted : public TractionField
{
public:
  Restricted(const TractionField &whole, const std::set<dealii::types::boundary_id> &where)
      : field(whole), boundaries(where)
  {
  }
  unsigned n_sources() const override { return field.n_sources(); }
  void smooth_lengths(const dealii::Point<3> &centre, double radius, std::span<const unsigned> sources,
                      std::span<double> lengths) const override
  {
    field.smooth_lengths(centre, radius, sources, lengths);
  }
  void add_stress(std::span<const unsigned> sources, std::span<const dealii::Point<3>> points,
                  std::span<dealii::SymmetricTensor<2, 3>> values) const override
  {
    field.add_stress(sources, points, values);
  }
  bool vanishes_on(unsigned source, dealii::types::boundary_id boundary) const override
  {
    return boundaries.count(boundary) == 0 || field.vanishes_on(source, boundary);
  }
  std::optional<unsigned> n_summed(std::size_t n_points) const override { return field.n_summed(n_points); }
  double summation_error() const override { return field.summation_error(); }
  std::vector<dealii::SymmetricTensor<2, 3>> sum(std::span<const dealii::Point<3>> points) const override
  {
    return field.sum(points);
  }
  std::vector<std::vector<dealii::SymmetricTensor<2, 3>>> complete_sum(
      std::span<const BoundaryPoints> parts) const override
  {
    return field.complete_sum(parts);
  }
  void append_near(const dealii::Point<3> &centre, double radius, double length,
                   std::vector<unsigned> &sources) const override
  {
    field.append_near(centre, radius, length, sources);
  }

private:
  const TractionField &field;
  const std::set<dealii::types::boundary_id> &boundaries;
};
} // namespace

/// Product with the matrix of all faces, for each component.
class TraceProjection::Mass
{
public:
  explicit Mass(const std::vector<FaceMass> &matrices) : faces(matrices) {}

  void vmult(NodalVector &result, const NodalVector &vector) const
  {
    vector.update_ghost_values();
    result = 0.;
    for (const FaceMass &face : faces)
    {
      const std::size_t n = face.nodes.size();
      for (std::size_t k = 0; k < n * n; ++k)
      {
        for (unsigned c = 0; c < 3; ++c)
        {
          result.local_element(3 * face.nodes[k / n] + c) +=
              face.matrix[k] * vector.local_element(3 * face.nodes[k % n] + c);
        }
      }
    }
    result.compress(dealii::VectorOperation::add);
    vector.zero_out_ghost_values();
  }

private:
  const std::vector<FaceMass> &faces;
};

TraceProjection::TraceProjection(const NodalGrid &nodal_grid, std::set<dealii::types::boundary_id> where,
                                 double tolerance)
    : grid(nodal_grid), boundaries(std::move(where)), integrals(nodal_grid, {}, tolerance),
      inverse_diagonal(nodal_grid.partitioner)
{
  for (unsigned face = 0; face < grid.faces.size(); ++face)
  {
    if (boundaries.count(grid.faces[face].boundary) > 0)
    {
      faces.push_back({integrals.nodes(face), integrals.mass(face)});
    }
  }
  for (const FaceMass &face : faces)
  {
    const std::size_t n = face.nodes.size();
    for (std::size_t k = 0; k < 3 * n; ++k)
    {
      inverse_diagonal.local_element(static_cast<unsigned>(3 * face.nodes[k / 3] + k % 3)) +=
          face.matrix[k / 3 * (n + 1)];
    }
  }
  inverse_diagonal.compress(dealii::VectorOperation::add);
  for (double &d : inverse_diagonal)
  {
    d = d > 0. ? 1. / d : 1.;
  }
}

NodalVector TraceProjection::project(const TractionField &field) const
{
  NodalVector load(grid.partitioner), result(grid.partitioner);
  integrals.add_field(Restricted(field, boundaries), load);
  load *= -1.; // of BoundaryLoad's sign
  const double norm = load.l2_norm();
  if (norm == 0.)
  {
    return result;
  }
  dealii::SolverControl control(200, 1e-10 * norm);
  dealii::DiagonalMatrix<NodalVector> preconditioner;
  preconditioner.reinit(inverse_diagonal);
  dealii::SolverCG<NodalVector> solver(control);
  solver.solve(Mass(faces), result, load, preconditioner);
  return result;
}
} // namespace ddfem::fem
