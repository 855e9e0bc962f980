#pragma once

#include "fem/nodal_grid.h"
#include "fem/solver.h"

#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <memory>

namespace ddfem::fem
{
/// Unknowns: three components for each node, over NodalGrid::partitioner, with room for the ghosts.
using NodalVector = dealii::LinearAlgebra::distributed::Vector<double>;

/// Approximate inverse of the stiffness between free unknowns. Set up once. All members are collective.
class Preconditioner
{
public:
  virtual ~Preconditioner() = default;
  /// result = P residual.
  virtual void apply(NodalVector &result, const NodalVector &residual) const = 0;
};

/// `centre` (nm) and `length` (nm) scale the rigid motions, which are the near null space of the multigrid. With `singular` (free
/// rigid-body modes) the diagonal is enlarged by 1e-7 of itself while the preconditioner is set up; the matrix is left as it was.
/// Throws std::runtime_error when the factorisation fails.
std::unique_ptr<Preconditioner> make_preconditioner(Solver solver, const NodalGrid &grid,
                                                    dealii::TrilinosWrappers::SparseMatrix &matrix,
                                                    const dealii::Point<3> &centre, double length, bool singular);
} // namespace ddfem::fem
