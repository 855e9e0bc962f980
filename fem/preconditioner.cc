#include "fem/preconditioner.h"

#include "fem/rigid_modes.h"

#include <Amesos_Mumps.h>
#include <Epetra_LinearProblem.h>
#include <Epetra_MultiVector.h>
#include <Epetra_Vector.h>
#include <Teuchos_ParameterList.hpp>
#include <deal.II/lac/trilinos_precondition.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace ddfem::fem
{
namespace
{
using Matrix = dealii::TrilinosWrappers::SparseMatrix;

class Multigrid final : public Preconditioner
{
public:
  Multigrid(const NodalGrid &grid, const Matrix &matrix, const dealii::Point<3> &centre, double length)
  {
    const unsigned n = 3 * grid.n_owned_nodes;
    const auto motions = all_rigid_motions();
    near_null_space.resize(6 * std::size_t{n});
    for (std::size_t k = 0; k < 6; ++k)
    {
      for (unsigned dof = 0; dof < n; ++dof)
      {
        near_null_space[k * n + dof] = motions[k].at((grid.positions[dof / 3] - centre) / length)[dof % 3];
      }
    }
    // Chosen by measurement on boxes with 30k and 90k unknowns (Q2): all six rigid modes take 20 iterations where the
    // three translations take 30; two Chebyshev sweeps are four times faster than symmetric Gauss-Seidel, which saves
    // one iteration.
    dealii::TrilinosWrappers::PreconditionAMG::AdditionalData data;
    data.elliptic = true;
    data.higher_order_elements = grid.degree > 1;
    data.smoother_type = "Chebyshev";
    data.smoother_sweeps = 2;
    data.aggregation_threshold = 0.02;
    Teuchos::ParameterList list;
    std::unique_ptr<Epetra_MultiVector> unused;
    data.set_parameters(list, unused, matrix);
    list.set("PDE equations", 3);
    list.set("null space: type", "pre-computed");
    list.set("null space: dimension", 6);
    list.set("null space: vectors", near_null_space.data());
    levels.initialize(matrix, list);
  }

  void apply(NodalVector &result, const NodalVector &residual) const override { levels.vmult(result, residual); }

private:
  std::vector<double> near_null_space; // ML keeps a pointer to it
  dealii::TrilinosWrappers::PreconditionAMG levels;
};

class Factorisation final : public Preconditioner
{
public:
  explicit Factorisation(const Matrix &matrix) : solver(problem)
  {
    // Amesos only reads the matrix, but takes it as one that may be scaled.
    problem.SetOperator(const_cast<Epetra_CrsMatrix *>(&matrix.trilinos_matrix()));
    Teuchos::ParameterList list;
    list.set("MatrixProperty", "symmetric");
    list.set("PrintTiming", false);
    check(solver.SetParameters(list), "take its parameters");
    check(solver.SymbolicFactorization(), "analyse the stiffness matrix");
    check(solver.NumericFactorization(), "factorise the stiffness matrix");
  }

  void apply(NodalVector &result, const NodalVector &residual) const override
  {
    const Epetra_Map &map = problem.GetMatrix()->OperatorDomainMap();
    Epetra_Vector right(View, map, const_cast<double *>(residual.begin())), left(View, map, result.begin());
    problem.SetLHS(&left);
    problem.SetRHS(&right);
    check(solver.Solve(), "solve");
  }

private:
  static void check(int status, const std::string &what)
  {
    if (status != 0)
    {
      throw std::runtime_error("the direct solver could not " + what + " (Amesos MUMPS, status " +
                               std::to_string(status) + "); Elastic solver = multigrid needs less memory");
    }
  }

  mutable Epetra_LinearProblem problem;
  mutable Amesos_Mumps solver;
};
} // namespace

std::unique_ptr<Preconditioner> make_preconditioner(Solver solver, const NodalGrid &grid, Matrix &matrix,
                                                    const dealii::Point<3> &centre, double length, bool singular)
{
  // With free modes the matrix is singular: a small shift keeps the factors and the coarsest matrix regular.
  std::vector<double> diagonal;
  constexpr double shift = 1e-7;
  const auto first = grid.partitioner->local_range().first;
  const unsigned n = singular ? 3 * grid.n_owned_nodes : 0;
  for (unsigned dof = 0; dof < n; ++dof)
  {
    diagonal.push_back(matrix.diag_element(first + dof));
    matrix.set(first + dof, first + dof, diagonal.back() * (1. + shift));
  }
  matrix.compress(dealii::VectorOperation::insert);
  std::unique_ptr<Preconditioner> result;
  if (solver == Solver::direct)
  {
    result = std::make_unique<Factorisation>(matrix);
  }
  else
  {
    result = std::make_unique<Multigrid>(grid, matrix, centre, length);
  }
  for (unsigned dof = 0; dof < n; ++dof)
  {
    matrix.set(first + dof, first + dof, diagonal[dof]);
  }
  matrix.compress(dealii::VectorOperation::insert);
  return result;
}
} // namespace ddfem::fem
