#pragma once

namespace ddfem::fem
{
/// How the conjugate gradients of the elastic problem are preconditioned.
enum class Solver
{
  automatic, ///< by the number of unknowns and the degree, see solver_for()
  multigrid, ///< smoothed aggregation (ML)
  direct     ///< kept factorisation (MUMPS): one iteration, two with free rigid-body modes
};
} // namespace ddfem::fem
