// What ElasticProblem is made of.
#pragma once

#include "fem/boundary_load.h"
#include "fem/elastic_problem.h"
#include "fem/elastic_system.h"
#include "fem/point_locator.h"
#include "fem/start_vectors.h"
#include "fem/stress_recovery.h"
#include "fem/trace_projection.h"

#include <map>
#include <utility>
#include <vector>

namespace ddfem::fem
{
class ElasticProblem::Implementation
{
public:
  Implementation(const Triangulation &triangulation, const Parameters &parameters, const Moduli &moduli,
                 const std::vector<DisplacementCondition> &conditions);

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
} // namespace ddfem::fem
