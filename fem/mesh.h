#pragma once

#include "fem/pillar.h"
#include "fem/triangulation.h"

#include <deal.II/base/point.h>
#include <deal.II/base/types.h>
#include <mpi.h>

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace ddfem::fem
{
/// What the grain looks like and how finely it is divided. All lengths in nm, sample frame.
struct MeshParameters
{
  enum class Shape
  {
    box,        ///< rectangular block, edges along x, y, z
    cylinder,   ///< circular cylinder, axis along z
    pillar,     ///< round, tapered, axis along z, on a square base with a fillet
    cantilever, ///< beam along x that grows from a root block
    gmsh        ///< hexahedra read from a gmsh .msh file
  };

  Shape shape = Shape::box;
  /// Box, and beam of the cantilever: edge lengths.
  std::array<double, 3> size = {1000., 1000., 1000.};
  /// Box, and root block of the cantilever: lowest corner. Cylinder, and base of the pillar: centre of the bottom. gmsh: added
  /// to the scaled coordinates.
  std::array<double, 3> origin = {0., 0., 0.};
  /// Cylinder only.
  double radius = 500.;
  double height = 2000.;
  PillarGeometry pillar;
  /// Edge lengths of the cantilever's root block, wider than the beam along y and z.
  std::array<double, 3> block = {1000., 3000., 3000.};
  /// Box, and beam of the cantilever: cells per axis. Cylinder and pillar: [0] cells across a diameter (at least 3), [1] cells
  /// through the pillar's base (not used for the cylinder), [2] cells along the axis.
  std::array<unsigned, 3> subdivisions = {8, 8, 8};
  /// gmsh: path of the file (ASCII, format 2.2 or 4.1, first-order hexahedra).
  std::string file;
  /// gmsh: a coordinate in the file times this is a coordinate in nm.
  double length_unit_nm = 1.;
  /// Every cell is divided into eight this many times afterwards.
  unsigned refinements = 0;
};

/// Throws std::invalid_argument with one sentence when a value makes no sense (lengths not positive, no cells, no file
/// name).
void check(const MeshParameters &parameters);

/// Builds the mesh. Collective. Boundary ids: box x-, x+, y-, y+, z-, z+ = 0..5; cylinder side 0, bottom (z-) 1, top
/// (z+) 2; pillar and cantilever see make_pillar() and make_cantilever(); gmsh: the physical surface numbers. The curved side of a cylinder or pillar carries a manifold, so
/// that a mapping of degree two has an error of the fourth order in the cell size; gmsh meshes have flat-edged cells.
/// Throws std::invalid_argument (see check()) and std::runtime_error for a file that cannot be opened or read, that has
/// no hexahedra or other cells besides, or whose boundary is not covered by physical surfaces.
TriangulationPointer make_mesh(MPI_Comm communicator, const MeshParameters &parameters);

/// Names of the boundary ids: "x-", ..., "z+"; "side", "bottom", "top"; of the pillar also "base-top", "base-side"; "end", "root",
/// "beam-y-", ..., "beam-z+", "block"; gmsh: names of the physical surfaces, and the
/// number as text for one without a name (`ids` present in the mesh, see boundary_areas()). Reads the file's header
/// only.
std::map<dealii::types::boundary_id, std::string> boundary_names(const MeshParameters &parameters);

/// Inverse of boundary_names(); a number written as text is accepted too. Throws std::invalid_argument that lists the
/// known names.
dealii::types::boundary_id boundary_id_of(const std::map<dealii::types::boundary_id, std::string> &names,
                                          const std::string &name);

/// Lowest and highest corner (nm) of the box around all vertices. Collective.
std::pair<dealii::Point<3>, dealii::Point<3>> bounding_box(const Triangulation &triangulation);

/// Volume (nm^3) with a mapping of the given degree. Collective.
double volume(const Triangulation &triangulation, unsigned mapping_degree = 2);

/// Area (nm^2) of every boundary id of the mesh, with a mapping of the given degree. Collective.
std::map<dealii::types::boundary_id, double> boundary_areas(const Triangulation &triangulation,
                                                            unsigned mapping_degree = 2);

/// One quadrilateral of the boundary.
struct BoundaryFacet
{
  /// Corners (nm), counter-clockwise seen from outside; on curved boundaries the facet between them is only an
  /// approximation.
  std::array<dealii::Point<3>, 4> vertices;
  dealii::types::boundary_id boundary;
};

/// Every facet of the boundary on every rank, in an order that does not depend on the number of ranks. Collective.
std::vector<BoundaryFacet> boundary_facets(const Triangulation &triangulation);
} // namespace ddfem::fem
