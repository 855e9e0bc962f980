#include "fem/elastic_system.h"

#include "fem/element.h"

#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparsity_tools.h>

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace ddfem::fem
{
namespace
{
std::vector<dealii::Point<3>> cell_positions(const NodalGrid &grid, unsigned cell)
{
  std::vector<dealii::Point<3>> positions;
  for (unsigned a = 0; a < grid.nodes_per_cell; ++a)
  {
    positions.push_back(grid.positions[grid.nodes_of(cell)[a]]);
  }
  return positions;
}

/// Whether two cells differ by a translation only, so that they have the same matrix.
bool same_shape(const std::vector<dealii::Point<3>> &a, const std::vector<dealii::Point<3>> &b)
{
  if (a.size() != b.size())
  {
    return false;
  }
  const double tolerance = 1e-12 * a.front().distance(a.back());
  for (std::size_t i = 1; i < a.size(); ++i)
  {
    if (((a[i] - a[0]) - (b[i] - b[0])).norm() > tolerance)
    {
      return false;
    }
  }
  return true;
}
} // namespace

ElasticSystem::ElasticSystem(const NodalGrid &nodal_grid, const std::vector<std::array<bool, 3>> &prescribed_components,
                             double lambda, double mu, const dealii::Point<3> &centre, double length, Solver solver)
    : grid(nodal_grid), prescribed(prescribed_components), scratch(nodal_grid.partitioner)
{
  int found = 0;
  for (const auto &flags : prescribed)
  {
    found |= static_cast<int>(flags[0] || flags[1] || flags[2]);
  }
  MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPI_INT, MPI_MAX, grid.communicator);
  any_prescribed = found != 0;
  make_sparsity();
  assemble(lambda, mu);
  make_modes(centre, length);
  preconditioner = make_preconditioner(solver, grid, matrix, centre, length, !modes.empty());
}

void ElasticSystem::make_sparsity()
{
  const auto &owned = grid.partitioner->locally_owned_range();
  dealii::IndexSet active = owned;
  active.add_indices(grid.partitioner->ghost_indices());
  dealii::DynamicSparsityPattern free(active.size(), active.size(), active), full(active.size(), active.size(), active);
  std::vector<dealii::types::global_dof_index> all, unknown;
  for (unsigned cell = 0; cell < grid.n_cells(); ++cell)
  {
    all.clear();
    unknown.clear();
    for (unsigned a = 0; a < 3 * grid.nodes_per_cell; ++a)
    {
      const unsigned dof = 3 * grid.nodes_of(cell)[a / 3] + a % 3;
      all.push_back(grid.partitioner->local_to_global(dof));
      free.add(all.back(), all.back());
      if (!is_prescribed(dof))
      {
        unknown.push_back(all.back());
      }
    }
    for (unsigned a = 0; a < 3 * grid.nodes_per_cell; ++a)
    {
      if (is_prescribed(3 * grid.nodes_of(cell)[a / 3] + a % 3))
      {
        full.add_entries(all[a], all.begin(), all.end());
      }
    }
    for (const auto row : unknown)
    {
      free.add_entries(row, unknown.begin(), unknown.end());
    }
  }
  const auto share = [&](dealii::DynamicSparsityPattern &pattern, dealii::TrilinosWrappers::SparseMatrix &target)
  {
    dealii::SparsityTools::distribute_sparsity_pattern(pattern, owned, grid.communicator, active);
    target.reinit(owned, owned, pattern, grid.communicator);
  };
  share(free, matrix);
  if (any_prescribed)
  {
    share(full, prescribed_rows);
  }
}

void ElasticSystem::add_cell(unsigned cell, const std::vector<double> &stiffness)
{
  const unsigned n = 3 * grid.nodes_per_cell;
  std::vector<dealii::types::global_dof_index> unknown, all(n);
  std::vector<unsigned> position;
  for (unsigned a = 0; a < n; ++a)
  {
    all[a] = grid.global_dof(grid.nodes_of(cell)[a / 3], a % 3);
  }
  for (unsigned a = 0; a < n; ++a)
  {
    if (!is_prescribed(3 * grid.nodes_of(cell)[a / 3] + a % 3))
    {
      unknown.push_back(all[a]);
      position.push_back(a);
      continue;
    }
    matrix.add(all[a], all[a], stiffness[a * n + a]);
    prescribed_rows.add(all[a], n, all.data(), &stiffness[std::size_t{a} * n], false);
  }
  dealii::FullMatrix<double> block(static_cast<unsigned>(unknown.size()), static_cast<unsigned>(unknown.size()));
  for (unsigned i = 0; i < unknown.size(); ++i)
  {
    for (unsigned j = 0; j < unknown.size(); ++j)
    {
      block(i, j) = stiffness[position[i] * n + position[j]];
    }
  }
  if (!unknown.empty())
  {
    matrix.add(unknown, block, false);
  }
}

void ElasticSystem::assemble(double lambda, double mu)
{
  std::vector<dealii::Point<3>> shape;
  std::vector<double> stiffness;
  for (unsigned cell = 0; cell < grid.n_cells(); ++cell)
  {
    const auto positions = cell_positions(grid, cell);
    if (!same_shape(positions, shape))
    {
      shape = positions;
      stiffness = element_stiffness(grid.degree, positions, lambda, mu);
    }
    add_cell(cell, stiffness);
  }
  matrix.compress(dealii::VectorOperation::add);
  if (any_prescribed)
  {
    prescribed_rows.compress(dealii::VectorOperation::add);
  }
}

void ElasticSystem::make_modes(const dealii::Point<3> &centre, double length)
{
  for (const RigidMotion &motion : free_rigid_motions(grid, prescribed, centre, length))
  {
    NodalVector mode = make_vector(), weighted = make_vector();
    for (unsigned cell = 0; cell < grid.n_cells(); ++cell)
    {
      const auto integrals =
          integrate_rigid_motion(grid.degree, cell_positions(grid, cell), motion.shift, motion.spin / length, centre);
      for (unsigned a = 0; a < 3 * grid.nodes_per_cell; ++a)
      {
        const unsigned dof = 3 * grid.nodes_of(cell)[a / 3] + a % 3;
        weighted.local_element(dof) += is_prescribed(dof) ? 0. : integrals[a / 3][a % 3];
      }
    }
    weighted.compress(dealii::VectorOperation::add);
    for (unsigned dof = 0; dof < 3 * grid.n_owned_nodes; ++dof)
    {
      mode.local_element(dof) =
          is_prescribed(dof) ? 0. : motion.at((grid.positions[dof / 3] - centre) / length)[dof % 3];
    }
    for (std::size_t k = 0; k < modes.size(); ++k)
    {
      const double overlap = mode * weighted_modes[k];
      mode.add(-overlap, modes[k]);
      weighted.add(-overlap, weighted_modes[k]);
    }
    const double scale = 1. / std::sqrt(mode * weighted);
    mode *= scale;
    weighted *= scale;
    modes.push_back(mode);
    weighted_modes.push_back(weighted);
  }
}

void ElasticSystem::lift(const NodalVector &prescribed_values, NodalVector &load) const
{
  if (any_prescribed)
  {
    prescribed_rows.Tvmult(scratch, prescribed_values);
    load -= scratch;
  }
  for (unsigned dof = 0; dof < 3 * grid.n_owned_nodes; ++dof)
  {
    if (is_prescribed(dof))
    {
      load.local_element(dof) = 0.;
    }
  }
}

void ElasticSystem::reactions(const NodalVector &displacement, const NodalVector &load, NodalVector &result) const
{
  result = 0.;
  if (any_prescribed)
  {
    prescribed_rows.vmult(result, displacement);
  }
  for (unsigned dof = 0; dof < 3 * grid.n_owned_nodes; ++dof)
  {
    if (is_prescribed(dof))
    {
      result.local_element(dof) -= load.local_element(dof);
    }
  }
}

double ElasticSystem::remove_resultant(NodalVector &load) const
{
  scratch = 0.;
  for (std::size_t k = 0; k < modes.size(); ++k)
  {
    scratch.add(load * modes[k], weighted_modes[k]);
  }
  load -= scratch;
  return scratch.l2_norm();
}

void ElasticSystem::remove_rigid_motion(NodalVector &displacement) const
{
  for (std::size_t k = 0; k < modes.size(); ++k)
  {
    displacement.add(-(displacement * weighted_modes[k]), modes[k]);
  }
}

void ElasticSystem::precondition(NodalVector &result, const NodalVector &residual) const
{
  preconditioner->apply(result, residual);
  remove_rigid_motion(result);
}

ElasticSystem::Convergence ElasticSystem::solve(NodalVector &x, NodalVector &r, const NodalVector &load,
                                                double tolerance, unsigned max_iterations) const
{
  NodalVector z = make_vector(), p = make_vector(), product = make_vector();
  matrix.vmult(r, x);
  r.sadd(-1., 1., load);
  Convergence info{0, r.l2_norm(), r.l2_norm()};
  double previous = 1.;
  while (!(info.final_residual <= tolerance))
  {
    if (info.iterations == max_iterations || !std::isfinite(info.final_residual))
    {
      std::ostringstream text;
      text << "the elastic solve did not converge: residual " << info.final_residual << " MPa nm^2 after "
           << info.iterations << " iterations, wanted " << tolerance;
      throw std::runtime_error(text.str());
    }
    precondition(z, r);
    const double rz = r * z;
    p.sadd(info.iterations == 0 ? 0. : rz / previous, 1., z);
    previous = rz;
    matrix.vmult(product, p);
    const double step = rz / (p * product);
    x.add(step, p);
    r.add(-step, product);
    // The product leaves a trace of the null space by rounding, which would grow.
    remove_resultant(r);
    info.final_residual = r.l2_norm();
    ++info.iterations;
  }
  remove_rigid_motion(x);
  return info;
}
} // namespace ddfem::fem
