#pragma once

#include "fem/solver.h"
#include "fem/traction_field.h"
#include "fem/triangulation.h"

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>
#include <deal.II/base/types.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace ddfem::fem
{
/// Isotropic elastic moduli.
struct Moduli
{
  double mu; ///< shear modulus, MPa
  double nu; ///< Poisson's ratio
};

/// Components (sample frame) of the displacement that are prescribed on a boundary.
struct DisplacementCondition
{
  dealii::types::boundary_id boundary;
  std::array<bool, 3> components;
};

/// How a solve went.
struct SolveInfo
{
  unsigned iterations = 0;
  double initial_residual = 0.; ///< norm of the residual of the starting vector over the norm of the load
  double final_residual = 0.;   ///< the same at the end
  double seconds = 0.;          ///< wall time
  /// Norm of the resultant along free rigid-body modes that had to be removed from the load, over the load: rounding
  /// and traction_tolerance for a sound all-traction problem.
  double unbalanced_load = 0.;
};

/// The correction problem of a grain: div sigma^ = 0, sigma^ n = -sigma~ n on the boundary, u^ prescribed where
/// displacement conditions say so (van der Giessen & Needleman, MSMSE 3 (1995) 689). Isotropic linear elasticity with
/// Q1 or Q2 hexahedra and a mapping of the same degree. The matrix and its preconditioner (multigrid or a factorisation) are
/// set up once.
///
/// Rigid-body motions that the displacement conditions leave free are found automatically. They are removed by
/// projection: the load is made self-equilibrated by the uniform inertia force it would cause, and the displacement is
/// orthogonal (in the volume integral) to them. Nothing depends on where the grain is.
///
/// Units nm, MPa, force MPa nm^2; sample frame. All members are collective unless they say otherwise.
class ElasticProblem
{
public:
  /// How the stress becomes continuous.
  enum class Recovery
  {
    patches, ///< least-squares fits around vertices (Zienkiewicz & Zhu, IJNME 33 (1992) 1331)
    averages ///< extrapolation from Gauss points, averaged at nodes; steadier where the mesh does not resolve the field
  };

  struct Parameters
  {
    /// Degree of the elements and of the mapping, 1 or 2.
    unsigned degree = 2;
    /// Norm of the residual over the norm of the load, prescribed displacements included.
    double relative_tolerance = 1e-8;
    unsigned max_iterations = 1000;
    Solver solver = Solver::automatic;
    /// Aimed-at relative error of the integrals of the tractions.
    double traction_tolerance = 1e-6;
    /// Each solve starts from that combination of this many last solutions which is best in the energy norm (Fischer,
    /// CMAME 163 (1998) 193). At least 1.
    unsigned n_start_vectors = 6;
    Recovery recovery = Recovery::patches;
    /// Points that lie farther outside the mesh than this fraction of a cell are errors in stress_at(),
    /// displacement_at().
    double outside_tolerance = 0.02;
  };

  /// Sets everything up. `triangulation` must outlive the object, be all hexahedra and have no hanging nodes. Throws
  /// std::invalid_argument for parameters or moduli without sense and for conditions on boundaries that the mesh does
  /// not have.
  ElasticProblem(const Triangulation &triangulation, const Parameters &parameters, const Moduli &moduli,
                 const std::vector<DisplacementCondition> &conditions);
  ~ElasticProblem();
  ElasticProblem(const ElasticProblem &) = delete;
  ElasticProblem &operator=(const ElasticProblem &) = delete;

  /// Locally owned nodes on the boundary (nm), each once, in a fixed order. Local.
  const std::vector<dealii::Point<3>> &boundary_points() const;
  /// For each of boundary_points(): which components of its displacement are prescribed. Local.
  const std::vector<std::array<bool, 3>> &prescribed_components() const;
  /// For each of boundary_points(): the boundary ids it belongs to, ascending. Local.
  const std::vector<std::vector<dealii::types::boundary_id>> &boundary_ids() const;

  /// Replaces the load of the field: f = -int N . (sigma~ n) dS over the whole boundary, by adaptive quadrature.
  /// Uniform tractions are kept.
  TractionSummary set_tractions(const TractionField &field);
  /// Adds a uniform traction (MPa) on a boundary: f += int N . t dS. Throws std::invalid_argument for an unknown
  /// boundary.
  void add_uniform_traction(dealii::types::boundary_id boundary, const dealii::Tensor<1, 3> &traction);
  /// Removes the uniform tractions.
  void clear_uniform_tractions();
  /// Removes all loads.
  void clear_tractions();

  /// Best approximation of the tractions sigma~ n (n outward) of a field on the boundaries that have a condition, at
  /// boundary_points(); zero elsewhere. See TraceProjection; its integrals aim at the relative error projection_tolerance. For
  /// displacements that are to be prescribed, which the caller presents as tractions.
  std::vector<dealii::Tensor<1, 3>> project_on_conditions(const TractionField &field) const;
  static constexpr double projection_tolerance = 1e-4;

  /// Solves for the correction. `prescribed`: displacement (nm) for each of boundary_points(), of which only the
  /// prescribed components are read. Starts from the previous solution. A load without any force gives exactly zero at
  /// once. Throws std::invalid_argument for a wrong size, std::runtime_error without convergence or with a load that is
  /// not finite.
  SolveInfo solve(const std::vector<dealii::Tensor<1, 3>> &prescribed);
  /// Replaces Parameters::relative_tolerance from the next solve on. Local. Throws std::invalid_argument unless it lies
  /// between 0 and 1.
  void set_relative_tolerance(double tolerance);

  /// Correction u^ (nm) at boundary_points(). Local.
  std::vector<dealii::Tensor<1, 3>> boundary_displacements() const;

  /// Force (MPa nm^2) that the displacement conditions of a boundary exert on the grain, total field (sigma^ + sigma~),
  /// weak form: sum of K u^ - f over the prescribed unknowns of that boundary. Components that are not prescribed are
  /// zero. An unknown on an edge of two boundaries that both prescribe it counts for the one that comes first in the
  /// conditions.
  dealii::Tensor<1, 3> reaction(dealii::types::boundary_id boundary) const;
  /// Moment (MPa nm^3) of the same nodal forces about a point (nm).
  dealii::Tensor<1, 3> reaction_moment(dealii::types::boundary_id boundary, const dealii::Point<3> &about) const;
  /// These nodal forces (MPa nm^2) at boundary_points(), of all conditions; zero where nothing is prescribed.
  std::vector<dealii::Tensor<1, 3>> boundary_reactions() const;
  /// Nodal forces (MPa nm^2) of the loads at boundary_points(): f = -int N . (sigma~ n) dS and uniform tractions. With the
  /// reactions they are K u^, whose product with a nodal displacement is the work of sigma^ n. Local.
  std::vector<dealii::Tensor<1, 3>> boundary_loads() const;

  /// Recovered stress sigma^ (MPa), continuous, at points (nm). Points must be the same on all ranks, and all ranks get
  /// the same bits. Calls with the same index for about the same point are faster (it starts in the cell of the
  /// previous call). Throws std::runtime_error for a point farther outside the mesh than Parameters::outside_tolerance.
  std::vector<dealii::SymmetricTensor<2, 3>> stress_at(const std::vector<dealii::Point<3>> &points) const;
  /// Recovered stress of the solution as it is now: six numbers for each node of this rank's cells, for the next function.
  /// Collective.
  std::vector<double> recovered_stress() const;
  /// As stress_at(), of a recovered stress that was kept.
  std::vector<dealii::SymmetricTensor<2, 3>> stress_at(const std::vector<dealii::Point<3>> &points,
                                                       const std::vector<double> &recovered) const;
  /// Displacement u^ (nm) at points; as stress_at().
  std::vector<dealii::Tensor<1, 3>> displacement_at(const std::vector<dealii::Point<3>> &points) const;

  /// Locally owned unknowns of the last solution, for superposition. Local.
  std::vector<double> solution() const;
  /// Replaces the solution, and with it displacements, reactions (with the loads as they are now) and stresses, but not
  /// what the next solve starts from. Throws std::invalid_argument for a wrong size.
  void set_solution(const std::vector<double> &values);

  /// Locally owned unknowns of the load of set_tractions(), for superposition. Local.
  std::vector<double> field_load() const;
  /// Replaces that load (for reactions and the next solve). Throws std::invalid_argument for a wrong size.
  void set_field_load(const std::vector<double> &values);

  /// What the next solve starts from: two vectors of locally owned numbers for each of at most Parameters::n_start_vectors
  /// solutions. With the same mesh and number of ranks a restart that puts them back continues bit by bit. Local.
  std::vector<std::vector<double>> start_vectors() const;
  /// Those, or none: the next solve starts from zero. Collective. Throws std::invalid_argument for a wrong size.
  void set_start_vectors(const std::vector<std::vector<double>> &vectors);

  /// Writes the surface: `base_name`.pvtu in `directory` and a .vtu for each rank, in SI units: points (m), total
  /// displacement u = extra + u^ (m), correction displacement u^ (m), von Mises stress of sigma^ (Pa), boundary id.
  /// `extra_displacement` (nm) is given at boundary_points(). Files are written under a temporary name and then
  /// renamed. Returns the path of the .pvtu. Throws std::runtime_error for a file that cannot be written.
  std::string write_surface(const std::string &directory, const std::string &base_name,
                            const std::vector<dealii::Tensor<1, 3>> &extra_displacement) const;

  /// Sizes, the same on all ranks. Local.
  std::uint64_t n_dofs() const;
  std::uint64_t n_cells() const;
  unsigned n_free_rigid_modes() const;
  double volume() const;                                           ///< nm^3
  double boundary_area(dealii::types::boundary_id boundary) const; ///< nm^2, zero for an unknown boundary
  dealii::Point<3> centre() const;                                 ///< centre of volume, nm
  double setup_seconds() const;                                    ///< wall time of the constructor

private:
  class Implementation;
  std::unique_ptr<Implementation> implementation;
};
} // namespace ddfem::fem
