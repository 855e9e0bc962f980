#pragma once

namespace ddfem::fem
{
/// How the conjugate gradients of the elastic problem are preconditioned.
enum class Solver
{
  automatic, ///< the one that costs least over a run: multigrid at every size measured (docs/decisions.md, 34)
  multigrid, ///< smoothed aggregation (ML)
  direct     ///< kept factorisation (MUMPS): one iteration, two with free rigid-body modes
};
} // namespace ddfem::fem
