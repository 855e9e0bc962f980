// The shape of the grain as the lines see it, from the description of the mesh.
#pragma once

#include "dd/geometry/grain_shape.h"
#include "fem/mesh.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace ddfem::coupling
{
/// Facets of the boundary of @p mesh, on all ranks. Collective.
std::vector<PolyhedronShape::Facet> boundary_polygons(const fem::Triangulation &mesh);

/// Exact shapes for the grains that the program meshes itself, the facets of the boundary for a mesh that was read: a convex
/// polyhedron, or any closed surface. Collective. Throws std::invalid_argument if dimensions do not fit, if the surface is not closed, and
/// if lines that end on a facet could not be continued to infinity without meeting the grain again.
std::unique_ptr<GrainShape> make_grain_shape(const fem::MeshParameters &parameters, const fem::Triangulation &mesh);

/// Names of the held face and of the platen if the input does not say; empty for a mesh that was read.
std::pair<std::string, std::string> usual_held_faces(fem::MeshParameters::Shape shape);
} // namespace ddfem::coupling
