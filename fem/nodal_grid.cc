#include "fem/nodal_grid.h"

#include <deal.II/base/quadrature.h>
#include <deal.II/distributed/tria_base.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace ddfem::fem
{
/// Fills a NodalGrid from deal.II's mesh and numbering.
class NodalGrid::Builder
{
public:
  Builder(const Triangulation &triangulation, NodalGrid &target)
      : grid(target), element(dealii::FE_Q<3>(grid.degree), 3), dof_handler(triangulation),
        scalar_index(dealii::FETools::lexicographic_to_hierarchic_numbering<3>(grid.degree)),
        dofs(element.n_dofs_per_cell())
  {
    dof_handler.distribute_dofs(element);
    const dealii::IndexSet &owned = dof_handler.locally_owned_dofs();
    dealii::IndexSet active;
    dealii::DoFTools::extract_locally_active_dofs(dof_handler, active);
    grid.partitioner = std::make_shared<dealii::Utilities::MPI::Partitioner>(owned, active, grid.communicator);
    grid.n_owned_nodes = static_cast<unsigned>(owned.n_elements() / 3);
    grid.n_global_dofs = dof_handler.n_dofs();
    grid.n_global_cells = triangulation.n_global_active_cells();
  }

  void fill_cells()
  {
    const dealii::Quadrature<3> nodes(element.base_element(0).get_unit_support_points());
    const dealii::MappingQ<3> mapping(grid.degree);
    dealii::FEValues<3> values(mapping, element, nodes, dealii::update_quadrature_points);
    grid.positions.resize((grid.partitioner->locally_owned_size() + grid.partitioner->n_ghost_indices()) / 3);
    for (const auto &cell : dof_handler.active_cell_iterators())
    {
      if (!cell->is_locally_owned())
      {
        continue;
      }
      cell->get_dof_indices(dofs);
      values.reinit(cell);
      for (unsigned a = 0; a < grid.nodes_per_cell; ++a)
      {
        const unsigned node = local_node(a);
        grid.cell_nodes.push_back(node);
        grid.positions[node] = values.quadrature_point(scalar_index[a]);
      }
      add_faces(cell);
    }
  }

  void fill_boundaries()
  {
    grid.node_boundaries.resize(grid.positions.size());
    for (const auto &cell : dof_handler.active_cell_iterators())
    {
      // A ghost cell can have a boundary face that touches a node of ours although none of our own cells has one.
      if (cell->is_artificial() || !cell->at_boundary())
      {
        continue;
      }
      cell->get_dof_indices(dofs);
      for (const unsigned f : cell->face_indices())
      {
        if (cell->face(f)->at_boundary())
        {
          mark_face(f, cell->face(f)->boundary_id());
        }
      }
    }
    for (auto &ids : grid.node_boundaries)
    {
      std::sort(ids.begin(), ids.end());
      ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    }
  }

private:
  template <typename Cell> void add_faces(const Cell &cell)
  {
    const unsigned index = grid.n_cells() - 1;
    for (const unsigned f : cell->face_indices())
    {
      if (cell->face(f)->at_boundary())
      {
        grid.faces.push_back({index, f, cell->face(f)->boundary_id()});
      }
    }
  }

  void mark_face(unsigned face_number, dealii::types::boundary_id id)
  {
    for (const unsigned a : face_nodes(grid.degree, face_number))
    {
      const auto dof = dofs[element.component_to_system_index(0, scalar_index[a])];
      if (grid.partitioner->in_local_range(dof) || grid.partitioner->is_ghost_entry(dof))
      {
        grid.node_boundaries[local_node(a)].push_back(id);
      }
    }
  }

  unsigned local_node(unsigned lexicographic) const
  {
    std::array<unsigned, 3> local;
    for (unsigned c = 0; c < 3; ++c)
    {
      local[c] =
          grid.partitioner->global_to_local(dofs[element.component_to_system_index(c, scalar_index[lexicographic])]);
    }
    if (local[0] % 3 != 0 || local[1] != local[0] + 1 || local[2] != local[0] + 2)
    {
      throw std::logic_error("NodalGrid: the components of a node are not numbered consecutively");
    }
    return local[0] / 3;
  }

  NodalGrid &grid;
  dealii::FESystem<3> element;
  dealii::DoFHandler<3> dof_handler;
  std::vector<unsigned> scalar_index; // deal.II's index within the cell of a lexicographic one
  std::vector<dealii::types::global_dof_index> dofs;
};

NodalGrid::NodalGrid(const Triangulation &triangulation, unsigned element_degree)
    : communicator(triangulation.get_communicator()), degree(element_degree),
      nodes_per_cell((element_degree + 1) * (element_degree + 1) * (element_degree + 1))
{
  if (triangulation.n_global_active_cells() == 0 || !triangulation.all_reference_cells_are_hyper_cube())
  {
    throw std::invalid_argument("the mesh must consist of hexahedra");
  }
  if (triangulation.has_hanging_nodes())
  {
    throw std::invalid_argument("the mesh has hanging nodes: only uniform refinement is supported");
  }
  if (3 * triangulation.n_global_active_cells() * nodes_per_cell > std::numeric_limits<unsigned>::max())
  {
    throw std::invalid_argument("the mesh is too large for 32-bit indices");
  }
  Builder builder(triangulation, *this);
  builder.fill_cells();
  builder.fill_boundaries();
}

std::vector<unsigned> face_nodes(unsigned degree, unsigned face_number)
{
  const unsigned n = degree + 1;
  const std::array<unsigned, 3> stride = {1, n, n * n};
  const unsigned axis = face_number / 2;
  const unsigned first = face_number % 2 == 0 ? 0 : degree * stride[axis];
  std::vector<unsigned> nodes;
  for (unsigned j = 0; j < n; ++j)
  {
    for (unsigned i = 0; i < n; ++i)
    {
      nodes.push_back(first + i * stride[(axis + 1) % 3] + j * stride[(axis + 2) % 3]);
    }
  }
  return nodes;
}
} // namespace ddfem::fem
