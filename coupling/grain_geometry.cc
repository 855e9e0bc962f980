#include "coupling/grain_geometry.h"

#include "coupling/convert.h"
#include "dd/forces/virtual_rays.h"
#include "dd/geometry/reentrant_shapes.h"
#include "dd/geometry/surface_mesh_shape.h"

#include <stdexcept>

namespace ddfem::coupling
{
namespace
{
using Shape = fem::MeshParameters::Shape;
using Facets = std::vector<PolyhedronShape::Facet>;

Vec3 to_vector(const std::array<double, 3> &x)
{
  return {x[0], x[1], x[2]};
}

/// Throws std::invalid_argument if a line that ends in the middle of a facet has no way out.
void require_ways_out(const GrainShape &shape, const Facets &facets)
{
  try
  {
    for (const auto &f : facets)
    {
      Vec3 middle = Vec3::Zero();
      for (const Vec3 &x : f.vertices)
        middle += x / static_cast<double>(f.vertices.size());
      ray_direction(shape, RayDirection::normal, middle);
    }
  }
  catch (const std::runtime_error &e)
  {
    throw std::invalid_argument(e.what());
  }
}

std::unique_ptr<GrainShape> shape_of_facets(const Facets &facets)
{
  auto shape = std::make_unique<SurfaceMeshShape>(facets);
  if (shape->is_convex())
    return std::make_unique<PolyhedronShape>(facets);
  require_ways_out(*shape, facets);
  return shape;
}
} // namespace

std::vector<PolyhedronShape::Facet> boundary_polygons(const fem::Triangulation &mesh)
{
  std::vector<PolyhedronShape::Facet> facets;
  for (const fem::BoundaryFacet &f : fem::boundary_facets(mesh))
  {
    PolyhedronShape::Facet facet;
    for (const auto &v : f.vertices)
      facet.vertices.push_back(to_vec3(v));
    facet.face_id = static_cast<int>(f.boundary);
    facets.push_back(facet);
  }
  return facets;
}

std::unique_ptr<GrainShape> make_grain_shape(const fem::MeshParameters &p, const fem::Triangulation &mesh)
{
  const Vec3 origin = to_vector(p.origin);
  switch (p.shape)
  {
    case Shape::box: return std::make_unique<BoxShape>(origin, origin + to_vector(p.size));
    case Shape::cylinder: return std::make_unique<CylinderShape>(origin, p.radius, p.height);
    case Shape::pillar:
    {
      const fem::PillarGeometry &g = p.pillar;
      return std::make_unique<PillarShape>(
          origin, PillarDimensions{g.top_radius, g.height, g.taper, g.fillet_radius, g.base_width, g.base_height});
    }
    case Shape::cantilever: return std::make_unique<CantileverShape>(origin, to_vector(p.size), to_vector(p.block));
    case Shape::gmsh: break;
  }
  return shape_of_facets(boundary_polygons(mesh));
}

std::pair<std::string, std::string> usual_held_faces(const Shape shape)
{
  switch (shape)
  {
    case Shape::box: return {"z-", "z+"};
    case Shape::cylinder:
    case Shape::pillar: return {"bottom", "top"};
    case Shape::cantilever: return {"root", "end"};
    case Shape::gmsh: break;
  }
  return {"", ""};
}
} // namespace ddfem::coupling
