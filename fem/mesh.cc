#include "fem/mesh.h"

#include "fem/cantilever.h"
#include "fem/cylinder.h"
#include "fem/gather.h"
#include "fem/gmsh_reader.h"
#include "fem/require.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/fe/fe_nothing.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace ddfem::fem
{
namespace
{
using Shape = MeshParameters::Shape;

bool is_length(double x)
{
  return std::isfinite(x) && x > 0.;
}

void make_box(const MeshParameters &parameters, dealii::Triangulation<3> &triangulation)
{
  const std::vector<unsigned> subdivisions(parameters.subdivisions.begin(), parameters.subdivisions.end());
  const dealii::Point<3> opposite(parameters.size[0], parameters.size[1], parameters.size[2]);
  dealii::GridGenerator::subdivided_hyper_rectangle(triangulation, subdivisions, dealii::Point<3>(), opposite, true);
}

void check_pillar(const MeshParameters &parameters)
{
  const PillarGeometry &g = parameters.pillar;
  require(is_length(g.top_radius) && is_length(g.height) && is_length(g.base_width) && is_length(g.base_height),
          "mesh: radius, height, base width and base height of the pillar must be positive");
  require(g.taper >= 0. && g.taper < 0.78,
          "mesh: the taper angle of the pillar must be at least 0 and less than 45 degrees");
  require(g.fillet_radius >= 0. && g.fillet_top() < g.height, "mesh: the fillet of radius ", g.fillet_radius,
          " nm must end below the top of the pillar, whose height is ", g.height, " nm");
  require(2. * g.foot_radius() < g.base_width, "mesh: the foot of the pillar has with its fillet the diameter ",
          2. * g.foot_radius(), " nm, and the base is ", g.base_width, " nm wide only");
  require(parameters.subdivisions[0] >= 3, "mesh: the pillar needs at least 3 cells across its diameter");
  require(parameters.subdivisions[1] > 0 && parameters.subdivisions[2] > 0,
          "mesh: the pillar needs at least one cell through its base and one along its axis");
}

/// The undivided mesh, the same on every rank.
void make_serial(const MeshParameters &parameters, dealii::Triangulation<3> &triangulation)
{
  switch (parameters.shape)
  {
    case Shape::box: make_box(parameters, triangulation); break;
    case Shape::cylinder:
      make_cylinder(triangulation, parameters.radius, parameters.height, parameters.subdivisions[0],
                    parameters.subdivisions[2]);
      break;
    case Shape::pillar:
      make_pillar(triangulation, parameters.pillar,
                  {parameters.subdivisions[0], parameters.subdivisions[1], parameters.subdivisions[2]});
      break;
    case Shape::cantilever:
      make_cantilever(triangulation, parameters.size, parameters.block, parameters.subdivisions);
      break;
    case Shape::gmsh:
      read_gmsh(parameters.file, triangulation);
      dealii::GridTools::scale(parameters.length_unit_nm, triangulation);
      break;
  }
  const dealii::Tensor<1, 3> shift({parameters.origin[0], parameters.origin[1], parameters.origin[2]});
  dealii::GridTools::shift(shift, triangulation);
  if (parameters.shape == Shape::pillar)
  {
    attach_pillar_manifolds(triangulation, parameters.pillar, dealii::Point<3>(shift));
  }
  if (parameters.shape == Shape::cylinder)
  {
    const dealii::Tensor<1, 3> axis({0., 0., 1.});
    triangulation.set_manifold(0, dealii::CylindricalManifold<3>(axis, dealii::Point<3>(shift)));
  }
}
} // namespace

void TriangulationDeleter::operator()(Triangulation *triangulation) const
{
  delete triangulation;
}

void check(const MeshParameters &parameters)
{
  const auto &n = parameters.subdivisions;
  for (unsigned d = 0; d < 3; ++d)
  {
    require(std::isfinite(parameters.origin[d]), "mesh: the origin must be finite");
  }
  switch (parameters.shape)
  {
    case Shape::box:
      for (unsigned d = 0; d < 3; ++d)
      {
        require(is_length(parameters.size[d]), "mesh: the edge lengths of the box must be positive, but one is ",
                parameters.size[d], " nm");
        require(n[d] > 0, "mesh: the box needs at least one cell along each axis");
      }
      break;
    case Shape::cylinder:
      require(is_length(parameters.radius) && is_length(parameters.height),
              "mesh: radius and height of the cylinder must be positive, but are ", parameters.radius, " nm and ",
              parameters.height, " nm");
      require(n[0] >= 3, "mesh: the cylinder needs at least 3 cells across its diameter");
      require(n[2] > 0, "mesh: the cylinder needs at least one cell along its axis");
      break;
    case Shape::pillar: check_pillar(parameters); break;
    case Shape::cantilever:
      for (unsigned d = 0; d < 3; ++d)
      {
        require(
            is_length(parameters.size[d]) && is_length(parameters.block[d]) && n[d] > 0,
            "mesh: the cantilever needs positive lengths of beam and root block and at least one cell along each axis");
        require(d == 0 || parameters.size[d] < parameters.block[d],
                "mesh: the root block of the cantilever must be wider than the beam along y and z, but is ",
                parameters.block[d], " nm wide and the beam ", parameters.size[d], " nm");
      }
      break;
    case Shape::gmsh:
      require(!parameters.file.empty(), "mesh: a gmsh mesh needs the name of its file");
      require(is_length(parameters.length_unit_nm), "mesh: the length unit of the gmsh file '", parameters.file,
              "' must be positive, but is ", parameters.length_unit_nm, " nm");
      break;
  }
  require(parameters.refinements <= 8, "mesh: more than 8 refinements make too many cells");
}

TriangulationPointer make_mesh(MPI_Comm communicator, const MeshParameters &parameters)
{
  check(parameters);
  dealii::Triangulation<3> serial;
  make_serial(parameters, serial);
  auto *const triangulation = new dealii::parallel::distributed::Triangulation<3>(communicator);
  TriangulationPointer owner(triangulation);
  triangulation->copy_triangulation(serial);
  triangulation->refine_global(parameters.refinements);
  return owner;
}

std::map<dealii::types::boundary_id, std::string> boundary_names(const MeshParameters &parameters)
{
  switch (parameters.shape)
  {
    case Shape::box: return {{0, "x-"}, {1, "x+"}, {2, "y-"}, {3, "y+"}, {4, "z-"}, {5, "z+"}};
    case Shape::cylinder: return {{0, "side"}, {1, "bottom"}, {2, "top"}};
    case Shape::pillar: return {{0, "side"}, {1, "bottom"}, {2, "top"}, {3, "base-top"}, {4, "base-side"}};
    case Shape::cantilever:
      return {{0, "end"}, {1, "root"}, {2, "beam-y-"}, {3, "beam-y+"}, {4, "beam-z-"}, {5, "beam-z+"}, {6, "block"}};
    case Shape::gmsh: break;
  }
  return gmsh_surface_names(parameters.file);
}

dealii::types::boundary_id boundary_id_of(const std::map<dealii::types::boundary_id, std::string> &names,
                                          const std::string &name)
{
  std::string known;
  for (const auto &[id, text] : names)
  {
    if (text == name)
    {
      return id;
    }
    known.append(known.empty() ? "" : ", ").append(text);
  }
  constexpr std::size_t most_digits = 9;
  if (!name.empty() && name.size() <= most_digits && name.find_first_not_of("0123456789") == std::string::npos)
  {
    return static_cast<dealii::types::boundary_id>(std::stoul(name));
  }
  std::ostringstream text;
  text << "there is no boundary '" << name << "'; the boundaries are " << (known.empty() ? "unnamed" : known);
  throw std::invalid_argument(text.str());
}

std::pair<dealii::Point<3>, dealii::Point<3>> bounding_box(const Triangulation &triangulation)
{
  std::vector<double> extremes(6, -std::numeric_limits<double>::max());
  for (const auto &cell : triangulation.active_cell_iterators())
  {
    for (unsigned v = 0; cell->is_locally_owned() && v < 8; ++v)
    {
      for (unsigned d = 0; d < 3; ++d)
      {
        extremes[d] = std::max(extremes[d], -cell->vertex(v)[d]);
        extremes[3 + d] = std::max(extremes[3 + d], cell->vertex(v)[d]);
      }
    }
  }
  dealii::Utilities::MPI::max(extremes, triangulation.get_communicator(), extremes);
  return {dealii::Point<3>(-extremes[0], -extremes[1], -extremes[2]),
          dealii::Point<3>(extremes[3], extremes[4], extremes[5])};
}

double volume(const Triangulation &triangulation, unsigned mapping_degree)
{
  return dealii::GridTools::volume(triangulation, dealii::MappingQ<3>(mapping_degree));
}

std::map<dealii::types::boundary_id, double> boundary_areas(const Triangulation &triangulation, unsigned mapping_degree)
{
  const dealii::MappingQ<3> mapping(mapping_degree);
  const dealii::FE_Nothing<3> element;
  dealii::FEFaceValues<3> values(mapping, element, dealii::QGauss<2>(mapping_degree + 2), dealii::update_JxW_values);
  std::map<dealii::types::boundary_id, double> areas;
  for (const auto &cell : triangulation.active_cell_iterators())
  {
    for (unsigned f = 0; cell->is_locally_owned() && f < 6; ++f)
    {
      if (cell->face(f)->at_boundary())
      {
        values.reinit(cell, f);
        double &area = areas[cell->face(f)->boundary_id()];
        for (const double weight : values.get_JxW_values())
        {
          area += weight;
        }
      }
    }
  }
  struct Entry
  {
    dealii::types::boundary_id id;
    double area;
  };
  std::vector<Entry> local;
  for (const auto &[id, area] : areas)
  {
    local.push_back({id, area});
  }
  areas.clear();
  for (const auto &[id, area] : gather(local, triangulation.get_communicator()))
  {
    areas[id] += area;
  }
  return areas;
}

std::vector<BoundaryFacet> boundary_facets(const Triangulation &triangulation)
{
  // Vertices of each face, counter-clockwise seen from outside.
  constexpr std::array<std::array<unsigned, 4>, 6> corners = {
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  struct Record
  {
    std::array<unsigned, 5> key; // cell and face, the same on any number of ranks
    std::array<double, 12> x;
    dealii::types::boundary_id boundary;
  };
  std::vector<Record> local;
  for (const auto &cell : triangulation.active_cell_iterators())
  {
    for (unsigned f = 0; cell->is_locally_owned() && f < 6; ++f)
    {
      if (!cell->face(f)->at_boundary())
      {
        continue;
      }
      const auto id = cell->id().to_binary<3>();
      Record record{{id[0], id[1], id[2], id[3], f}, {}, cell->face(f)->boundary_id()};
      for (unsigned v = 0; v < 12; ++v)
      {
        record.x[v] = cell->vertex(corners[f][v / 3])[v % 3];
      }
      local.push_back(record);
    }
  }
  std::vector<Record> all = gather(local, triangulation.get_communicator());
  std::sort(all.begin(), all.end(), [](const Record &a, const Record &b) { return a.key < b.key; });
  std::vector<BoundaryFacet> facets;
  for (const auto &[key, x, boundary] : all)
  {
    facets.push_back({{dealii::Point<3>(x[0], x[1], x[2]), dealii::Point<3>(x[3], x[4], x[5]),
                       dealii::Point<3>(x[6], x[7], x[8]), dealii::Point<3>(x[9], x[10], x[11])},
                      boundary});
  }
  return facets;
}
} // namespace ddfem::fem
