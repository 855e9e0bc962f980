#pragma once

#include "fem/nodal_grid.h"
#include "fem/preconditioner.h"
#include "fem/rigid_modes.h"

#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <array>
#include <memory>
#include <vector>

namespace ddfem::fem
{
/// The linear system of the grain: stiffness (MPa nm), its preconditioner, the free rigid-body modes.
///
/// Only what is used is stored: the stiffness between free unknowns, with rows and columns of prescribed ones replaced
/// by a diagonal, and the full rows of the prescribed unknowns, which by symmetry give both the lifting and the
/// reactions.
class ElasticSystem
{
public:
  struct Convergence
  {
    unsigned iterations;
    double initial_residual; // norm, MPa nm^2
    double final_residual;
  };

  /// Collective. `prescribed`: one flag for each local node and component. Lambda, mu in MPa; centre, length: of the
  /// grain, nm.
  ElasticSystem(const NodalGrid &grid, const std::vector<std::array<bool, 3>> &prescribed, double lambda, double mu,
                const dealii::Point<3> &centre, double length, Solver solver);

  NodalVector make_vector() const { return NodalVector(grid.partitioner); }

  /// load -= K u for prescribed values u (zero at free unknowns); then load = 0 at prescribed unknowns.
  void lift(const NodalVector &prescribed_values, NodalVector &load) const;
  /// K u - load at the prescribed unknowns, zero elsewhere.
  void reactions(const NodalVector &displacement, const NodalVector &load, NodalVector &result) const;
  /// Makes a load self-equilibrated with respect to the free modes; returns the norm of what was taken away.
  double remove_resultant(NodalVector &load) const;
  /// Removes the free modes from a displacement (in the sense of the volume integral).
  void remove_rigid_motion(NodalVector &displacement) const;

  /// Preconditioned conjugate gradients for K x = load from the given x, until the norm of the residual is at most
  /// `tolerance`. `load` is self-equilibrated. `residual` becomes load - K x. Throws std::runtime_error without convergence.
  Convergence solve(NodalVector &x, NodalVector &residual, const NodalVector &load, double tolerance,
                    unsigned max_iterations) const;

  std::size_t n_free_modes() const { return modes.size(); }

private:
  void assemble(double lambda, double mu);
  void make_sparsity();
  void add_cell(unsigned cell, const std::vector<double> &stiffness);
  void make_modes(const dealii::Point<3> &centre, double length);
  void precondition(NodalVector &result, const NodalVector &residual) const;
  bool is_prescribed(unsigned local_dof) const { return prescribed[local_dof / 3][local_dof % 3]; }

  const NodalGrid &grid;
  std::vector<std::array<bool, 3>> prescribed;
  bool any_prescribed = false;
  dealii::TrilinosWrappers::SparseMatrix matrix;          // free x free, diagonal for the rest
  dealii::TrilinosWrappers::SparseMatrix prescribed_rows; // full rows of prescribed unknowns, empty elsewhere
  std::unique_ptr<Preconditioner> preconditioner;
  std::vector<NodalVector> modes;          // free rigid motions, orthonormal with respect to the volume integral
  std::vector<NodalVector> weighted_modes; // int N . mode dV
  mutable NodalVector scratch;
};
} // namespace ddfem::fem
