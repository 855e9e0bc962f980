#include "fem/face_section.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_nothing.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q.h>

#include <array>

namespace ddfem::fem
{
namespace
{
/// area, int x dS (3), int x x^T dS (xx yy zz xy xz yz).
using Moments = std::array<double, 10>;

void add(Moments &m, const dealii::Point<3> &x, const double weight)
{
  m[0] += weight;
  for (unsigned c = 0; c < 3; ++c)
  {
    m[1 + c] += weight * x[c];
    m[4 + c] += weight * x[c] * x[c];
  }
  m[7] += weight * x[0] * x[1];
  m[8] += weight * x[0] * x[2];
  m[9] += weight * x[1] * x[2];
}
} // namespace

FaceSection face_section(const Triangulation &triangulation, dealii::types::boundary_id boundary,
                         unsigned mapping_degree)
{
  const dealii::MappingQ<3> mapping(mapping_degree);
  const dealii::FE_Nothing<3> element;
  dealii::FEFaceValues<3> values(mapping, element, dealii::QGauss<2>(mapping_degree + 2),
                                 dealii::update_JxW_values | dealii::update_quadrature_points);
  Moments m{};
  // Moments about a point of the mesh: those about the origin lose digits when the grain is far from it.
  const dealii::Point<3> origin = triangulation.get_vertices()[0];
  std::array<double, 3> shared = {origin[0], origin[1], origin[2]};
  MPI_Bcast(shared.data(), 3, MPI_DOUBLE, 0, triangulation.get_communicator());
  const dealii::Point<3> base(shared[0], shared[1], shared[2]);
  for (const auto &cell : triangulation.active_cell_iterators())
  {
    for (unsigned f = 0; cell->is_locally_owned() && f < 6; ++f)
    {
      if (cell->face(f)->at_boundary() && cell->face(f)->boundary_id() == boundary)
      {
        values.reinit(cell, f);
        for (unsigned q = 0; q < values.n_quadrature_points; ++q)
        {
          add(m, dealii::Point<3>(values.quadrature_point(q) - base), values.JxW(q));
        }
      }
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, m.data(), 10, MPI_DOUBLE, MPI_SUM, triangulation.get_communicator());
  FaceSection section;
  section.area = m[0];
  if (m[0] == 0.)
  {
    return section;
  }
  const dealii::Tensor<1, 3> arm({m[1] / m[0], m[2] / m[0], m[3] / m[0]});
  section.centre = base + arm;
  const std::array<std::array<unsigned, 2>, 6> place = {{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};
  for (unsigned k = 0; k < 6; ++k)
  {
    const auto [i, j] = place[k];
    section.second[i][j] = m[4 + k] - m[0] * arm[i] * arm[j];
  }
  return section;
}
} // namespace ddfem::fem
