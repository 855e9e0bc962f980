#pragma once

#include <memory>

// Only the name: whoever passes a mesh on need not compile deal.II's mesh headers.
namespace dealii
{
template <int dim, int spacedim> class Triangulation;
namespace parallel
{
template <int dim, int spacedim> class DistributedTriangulationBase;
}
} // namespace dealii

namespace ddfem::fem
{
/// Hexahedral mesh held whole by each rank: how meshes are made; coordinates in nm.
using SerialTriangulation = dealii::Triangulation<3, 3>;
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
