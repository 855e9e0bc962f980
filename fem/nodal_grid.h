#pragma once

#include "fem/triangulation.h"

#include <deal.II/base/partitioner.h>
#include <deal.II/base/point.h>
#include <deal.II/base/types.h>
#include <mpi.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace ddfem::fem
{
/// The mesh as arrays: nodes of degree-p Lagrange hexahedra, which describe the geometry and carry the displacement.
///
/// A local node is a node of a locally owned cell; owned nodes come first. Component c of node n is the local element 3
/// n + c of a vector over `partitioner` (deal.II gives the components of a node consecutive numbers, which the
/// constructor checks), and its global index is 3 (first_owned_node + n) + c for an owned node.
struct NodalGrid
{
  /// Face of a locally owned cell on the boundary. `number` as in deal.II: 2 * axis + (0 low, 1 high).
  struct Face
  {
    unsigned cell;
    unsigned number;
    dealii::types::boundary_id boundary;
  };

  /// Collective. Throws std::invalid_argument when the mesh is empty, not all hexahedra, or has hanging nodes.
  NodalGrid(const Triangulation &triangulation, unsigned degree);

  unsigned n_cells() const { return static_cast<unsigned>(cell_nodes.size() / nodes_per_cell); }
  const unsigned *nodes_of(unsigned cell) const { return &cell_nodes[std::size_t{cell} * nodes_per_cell]; }
  dealii::types::global_dof_index global_dof(unsigned node, unsigned component) const
  {
    return partitioner->local_to_global(3 * node + component);
  }

  MPI_Comm communicator;
  unsigned degree;
  unsigned nodes_per_cell;
  unsigned n_owned_nodes = 0;
  std::vector<unsigned> cell_nodes;        ///< local nodes of each owned cell, lexicographic
  std::vector<dealii::Point<3>> positions; ///< of local nodes, nm
  /// For each local node the boundary ids of all faces that contain it (also those of other ranks' cells), ascending.
  std::vector<std::vector<dealii::types::boundary_id>> node_boundaries;
  std::vector<Face> faces;
  std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner;
  std::uint64_t n_global_dofs = 0;
  std::uint64_t n_global_cells = 0;

private:
  class Builder;
};

/// Local indices, within a cell, of the (degree+1)^2 nodes of a face, lexicographic in the unit coordinates
/// (axis+1)%3 (fastest) and (axis+2)%3, axis = number / 2.
std::vector<unsigned> face_nodes(unsigned degree, unsigned face_number);
} // namespace ddfem::fem
