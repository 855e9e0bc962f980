#pragma once

#include "fem/boundary_load.h"

#include <set>
#include <vector>

namespace ddfem::fem
{
/// Best approximations on some boundaries among what the elements can represent there, in the mean square: c with
///   sum_b (int N_a N_b dS) c_b = int N_a f dS.
/// The shape functions sum to one, so that c has the mean of f, however fast f varies within an element; for straight-sided faces
/// also its moments with linear functions. The values of f at the nodes have neither.
class TraceProjection
{
public:
  /// `tolerance`: relative error aimed at in the integrals of f, see BoundaryLoad. `grid` must outlive the object.
  TraceProjection(const NodalGrid &grid, std::set<dealii::types::boundary_id> boundaries, double tolerance);

  /// Projects the tractions sigma~ n (n outward) of a field, component by component; zero at nodes that are not on the boundaries.
  /// Collective. Throws dealii::SolverControl::NoConvergence for integrals that are not finite.
  NodalVector project(const TractionField &field) const;

private:
  class Mass;
  /// Face and its matrix int N_a N_b dS, row by row, nm^2.
  struct FaceMass
  {
    std::vector<unsigned> nodes;
    std::vector<double> matrix;
  };

  const NodalGrid &grid;
  std::set<dealii::types::boundary_id> boundaries;
  BoundaryLoad integrals;
  std::vector<FaceMass> faces;
  NodalVector inverse_diagonal; // one where there is no face
};
} // namespace ddfem::fem
