#include "fem/cylinder.h"

#include "fem/disc.h"

#include <deal.II/grid/manifold_lib.h>
#include <deal.II/grid/tria.h>

#include <vector>

namespace ddfem::fem
{
void make_cylinder(dealii::Triangulation<3> &triangulation, double radius, double height, unsigned n_across,
                   unsigned n_along)
{
  const Disc disc = make_disc(n_across);
  const auto layer_size = static_cast<unsigned>(disc.points.size());
  std::vector<dealii::Point<3>> vertices;
  for (unsigned k = 0; k <= n_along; ++k)
  {
    for (const auto &p : disc.points)
    {
      vertices.emplace_back(radius * p[0], radius * p[1], height * k / n_along);
    }
  }
  std::vector<dealii::CellData<3>> cells;
  for (unsigned k = 0; k < n_along; ++k)
  {
    for (const auto &quad : disc.quads)
    {
      dealii::CellData<3> cell(8);
      for (unsigned v = 0; v < 4; ++v)
      {
        cell.vertices[v] = quad[v] + k * layer_size;
        cell.vertices[v + 4] = quad[v] + (k + 1) * layer_size;
      }
      cells.push_back(cell);
    }
  }
  triangulation.create_triangulation(vertices, cells, dealii::SubCellData());
  for (const auto &face : triangulation.active_face_iterators())
  {
    if (face->at_boundary())
    {
      const double z = face->center()[2] / height;
      const bool side = z > 1e-9 && z < 1. - 1e-9;
      face->set_boundary_id(side ? 0 : (z < 0.5 ? 1 : 2));
      if (side)
      {
        face->set_all_manifold_ids(0);
      }
    }
  }
  triangulation.set_manifold(0, dealii::CylindricalManifold<3>(2));
}
} // namespace ddfem::fem
