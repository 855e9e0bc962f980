#pragma once

#include <memory>

// Only the name: whoever passes a mesh on need not compile deal.II's mesh headers.
namespace dealii::parallel
{
template <int dim, int spacedim> class DistributedTriangulationBase;
}

namespace ddfem::fem
{
/// Hexahedral mesh distributed over the ranks of its communicator; coordinates in nm.
using Triangulation = dealii::parallel::DistributedTriangulationBase<3, 3>;

/// Destroys a mesh where its type is complete (mesh.cc).
struct TriangulationDeleter
{
  void operator()(Triangulation *triangulation) const;
};

/// Sole owner of a mesh.
using TriangulationPointer = std::unique_ptr<Triangulation, TriangulationDeleter>;
} // namespace ddfem::fem
