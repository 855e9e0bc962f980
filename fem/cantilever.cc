#include "fem/cantilever.h"

#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace ddfem::fem
{
namespace
{
/// Coordinates of the grid along one axis, and which of its intervals belong to the beam.
struct Axis
{
  std::vector<double> x{0.};
  std::vector<bool> is_beam;

  void append(const double length, const unsigned n, const bool beam)
  {
    const double start = x.back();
    for (unsigned k = 1; k <= n; ++k)
    {
      x.push_back(start + length * k / n);
      is_beam.push_back(beam);
    }
  }
};

unsigned cells_for(const double length, const double size)
{
  return std::max(1u, static_cast<unsigned>(std::lround(length / size)));
}

std::array<Axis, 3> make_axes(const std::array<double, 3> &beam, const std::array<double, 3> &block,
                              const std::array<unsigned, 3> &n)
{
  std::array<Axis, 3> axes;
  axes[0].append(block[0], cells_for(block[0], beam[0] / n[0]), false);
  axes[0].append(beam[0], n[0], true);
  for (unsigned d = 1; d < 3; ++d)
  {
    const double margin = 0.5 * (block[d] - beam[d]);
    const unsigned n_margin = cells_for(margin, beam[d] / n[d]);
    axes[d].append(margin, n_margin, false);
    axes[d].append(beam[d], n[d], true);
    axes[d].append(margin, n_margin, false);
  }
  return axes;
}

dealii::types::boundary_id id_of_face(const dealii::Point<3> &centre, const std::array<double, 3> &beam,
                                      const std::array<double, 3> &block)
{
  const double tolerance = 1e-6 * beam[0];
  if (centre[0] < tolerance)
  {
    return 1;
  }
  if (centre[0] < block[0] + tolerance)
  {
    return 6;
  }
  for (unsigned d = 1; d < 3; ++d)
  {
    const double from_middle = centre[d] - 0.5 * block[d];
    if (std::abs(from_middle) > 0.5 * beam[d] - tolerance)
    {
      return 2 * d + (from_middle < 0. ? 0 : 1);
    }
  }
  return 0;
}
} // namespace

void make_cantilever(dealii::Triangulation<3> &triangulation, const std::array<double, 3> &beam,
                     const std::array<double, 3> &block, const std::array<unsigned, 3> &n)
{
  const auto axes = make_axes(beam, block, n);
  const auto n_x = axes[0].x.size(), n_y = axes[1].x.size(), n_z = axes[2].x.size();
  const auto number = [&](const std::size_t i, const std::size_t j, const std::size_t k)
  { return static_cast<unsigned>((k * n_y + j) * n_x + i); };
  std::vector<dealii::Point<3>> vertices;
  for (std::size_t k = 0; k < n_z; ++k)
  {
    for (std::size_t j = 0; j < n_y; ++j)
    {
      for (std::size_t i = 0; i < n_x; ++i)
      {
        vertices.emplace_back(axes[0].x[i], axes[1].x[j], axes[2].x[k]);
      }
    }
  }
  std::vector<dealii::CellData<3>> cells;
  for (std::size_t k = 0; k + 1 < n_z; ++k)
  {
    for (std::size_t j = 0; j + 1 < n_y; ++j)
    {
      for (std::size_t i = 0; i + 1 < n_x; ++i)
      {
        if (axes[0].is_beam[i] && !(axes[1].is_beam[j] && axes[2].is_beam[k]))
        {
          continue;
        }
        dealii::CellData<3> cell(8);
        for (unsigned v = 0; v < 8; ++v)
        {
          cell.vertices[v] = number(i + (v & 1), j + (v >> 1 & 1), k + (v >> 2));
        }
        cells.push_back(cell);
      }
    }
  }
  dealii::SubCellData no_boundary;
  dealii::GridTools::delete_unused_vertices(vertices, cells, no_boundary);
  triangulation.create_triangulation(vertices, cells, no_boundary);
  for (const auto &face : triangulation.active_face_iterators())
  {
    if (face->at_boundary())
    {
      face->set_boundary_id(id_of_face(face->center(), beam, block));
    }
  }
}
} // namespace ddfem::fem
