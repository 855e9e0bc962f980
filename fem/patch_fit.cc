#include "fem/patch_fit.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ddfem::fem
{
namespace
{
/// Inverse of a symmetric positive definite matrix by Gauss-Jordan elimination; empty when a pivot is too small.
std::vector<double> inverse_of(std::vector<double> a, unsigned n)
{
  std::vector<double> inverse(n * n, 0.);
  for (unsigned i = 0; i < n; ++i)
  {
    inverse[i * n + i] = 1.;
  }
  constexpr double smallest = 1e-9;
  const double scale = a[0];
  for (unsigned k = 0; k < n; ++k)
  {
    const double pivot = a[k * n + k];
    if (!(pivot > smallest * scale))
    {
      return {};
    }
    for (unsigned j = 0; j < n; ++j)
    {
      a[k * n + j] /= pivot;
      inverse[k * n + j] /= pivot;
    }
    for (unsigned i = 0; i < n; ++i)
    {
      const double factor = i == k ? 0. : a[i * n + k];
      for (unsigned j = 0; factor != 0. && j < n; ++j)
      {
        a[i * n + j] -= factor * a[k * n + j];
        inverse[i * n + j] -= factor * inverse[k * n + j];
      }
    }
  }
  return inverse;
}
} // namespace

PatchFit::PatchFit(const NodalGrid &nodal_grid, const std::vector<dealii::Point<3>> &gauss)
    : grid(nodal_grid), n_terms(nodal_grid.degree == 1 ? 4 : 10)
{
  make_partitioner();
  measure_patches();
  make_normal_matrices(gauss);
  make_contributions();
}

void PatchFit::make_partitioner()
{
  const auto &three = *grid.partitioner;
  dealii::IndexSet owned(2 * three.size()), ghosts(2 * three.size());
  owned.add_range(2 * three.local_range().first, 2 * three.local_range().second);
  for (const auto index : three.ghost_indices())
  {
    ghosts.add_range(2 * index, 2 * index + 2);
  }
  partitioner = std::make_shared<dealii::Utilities::MPI::Partitioner>(owned, ghosts, grid.communicator);
}

unsigned PatchFit::corner(unsigned cell, unsigned v) const
{
  const unsigned p = grid.degree, n = p + 1;
  return grid.nodes_of(cell)[p * (v % 2) + n * p * (v / 2 % 2) + n * n * p * (v / 4)];
}

void PatchFit::measure_patches()
{
  NodeVector sums(partitioner);
  for (unsigned cell = 0; cell < grid.n_cells(); ++cell)
  {
    const double diagonal = grid.positions[corner(cell, 0)].distance(grid.positions[corner(cell, 7)]);
    for (unsigned v = 0; v < 8; ++v)
    {
      sums.local_element(6 * corner(cell, v)) += diagonal;
      sums.local_element(6 * corner(cell, v) + 1) += 1.;
    }
  }
  sums.compress(dealii::VectorOperation::add);
  sums.update_ghost_values();
  for (unsigned node = 0; node < grid.positions.size(); ++node)
  {
    const double count = sums.local_element(6 * node + 1);
    sizes.push_back(count > 0. ? sums.local_element(6 * node) / count : 0.);
  }
}

PatchFit::Basis PatchFit::basis(unsigned patch, const dealii::Point<3> &x) const
{
  const auto s = (x - grid.positions[patch]) / sizes[patch];
  return {1., s[0], s[1], s[2], s[0] * s[0], s[1] * s[1], s[2] * s[2], s[0] * s[1], s[0] * s[2], s[1] * s[2]};
}

void PatchFit::make_normal_matrices(const std::vector<dealii::Point<3>> &gauss)
{
  // The upper triangles, packed six entries to a vector.
  const unsigned n_entries = n_terms * (n_terms + 1) / 2;
  std::vector<NodeVector> sums((n_entries + 5) / 6, NodeVector(partitioner));
  for (unsigned cell = 0; cell < grid.n_cells(); ++cell)
  {
    for (const auto &unit_point : gauss)
    {
      const LagrangeCell shape = lagrange_cell(grid.degree, unit_point);
      dealii::Point<3> x;
      for (unsigned a = 0; a < grid.nodes_per_cell; ++a)
      {
        x += shape.value[a] * grid.positions[grid.nodes_of(cell)[a]];
      }
      points.push_back(x);
      for (unsigned v = 0; v < 8; ++v)
      {
        const Basis p = basis(corner(cell, v), x);
        unsigned k = 0;
        for (unsigned i = 0; i < n_terms; ++i)
        {
          for (unsigned j = i; j < n_terms; ++j, ++k)
          {
            sums[k / 6].local_element(6 * corner(cell, v) + k % 6) += p[i] * p[j];
          }
        }
      }
    }
  }
  for (NodeVector &sum : sums)
  {
    sum.compress(dealii::VectorOperation::add);
    sum.update_ghost_values();
  }
  invert_normal_matrices(sums);
}

void PatchFit::invert_normal_matrices(const std::vector<NodeVector> &sums)
{
  inverses.resize(grid.positions.size());
  std::vector<double> matrix(n_terms * n_terms);
  for (unsigned node = 0; node < grid.positions.size(); ++node)
  {
    if (sizes[node] == 0. || !grid.node_boundaries[node].empty())
    {
      continue;
    }
    unsigned k = 0;
    for (unsigned i = 0; i < n_terms; ++i)
    {
      for (unsigned j = i; j < n_terms; ++j, ++k)
      {
        matrix[i * n_terms + j] = matrix[j * n_terms + i] = sums[k / 6].local_element(6 * node + k % 6);
      }
    }
    inverses[node] = inverse_of(matrix, n_terms);
  }
}

void PatchFit::make_contributions()
{
  const unsigned p = grid.degree, n = p + 1;
  std::map<std::pair<unsigned, unsigned>, double> weights;
  for (unsigned cell = 0; cell < grid.n_cells(); ++cell)
  {
    for (unsigned a = 0; a < grid.nodes_per_cell; ++a)
    {
      const std::array<unsigned, 3> index = {a % n, a / n % n, a / (n * n)};
      for (unsigned v = 0; v < 8; ++v)
      {
        const std::array<unsigned, 3> side = {p * (v % 2), p * (v / 2 % 2), p * (v / 4)};
        bool of_entity = true;
        for (unsigned d = 0; d < 3; ++d)
        {
          of_entity = of_entity && (index[d] == side[d] || (index[d] != 0 && index[d] != p));
        }
        // Linear fits reach to the surface: one Gauss point a cell says nothing about the gradient there.
        const bool to_surface = p == 1 && !valid(grid.nodes_of(cell)[a]);
        if ((of_entity || to_surface) && valid(corner(cell, v)))
        {
          weights[{grid.nodes_of(cell)[a], corner(cell, v)}] += 1.;
        }
      }
    }
  }
  NodeVector total(partitioner);
  for (const auto &[key, weight] : weights)
  {
    contributions.push_back({key.first, key.second, weight});
    total.local_element(6 * key.first) += weight;
  }
  total.compress(dealii::VectorOperation::add);
  total.update_ghost_values();
  for (unsigned node = 0; node < grid.positions.size(); ++node)
  {
    coverage.push_back(total.local_element(6 * node));
  }
}

std::vector<double> PatchFit::nodal_values(const std::vector<Six> &at_gauss_points) const
{
  std::vector<NodeVector> moments(n_terms, NodeVector(partitioner));
  const std::size_t per_cell = points.size() / std::max(1u, grid.n_cells());
  for (std::size_t q = 0; q < points.size(); ++q)
  {
    for (unsigned v = 0; v < 8; ++v)
    {
      const unsigned patch = corner(static_cast<unsigned>(q / per_cell), v);
      const Basis p = basis(patch, points[q]);
      for (unsigned i = 0; i < n_terms; ++i)
      {
        for (unsigned c = 0; c < 6; ++c)
        {
          moments[i].local_element(6 * patch + c) += p[i] * at_gauss_points[q][c];
        }
      }
    }
  }
  for (NodeVector &moment : moments)
  {
    moment.compress(dealii::VectorOperation::add);
    moment.update_ghost_values();
  }
  NodeVector result(partitioner);
  for (const auto &[node, patch, weight] : contributions)
  {
    const Basis p = basis(patch, grid.positions[node]);
    for (unsigned i = 0; i < n_terms; ++i)
    {
      double factor = 0.;
      for (unsigned j = 0; j < n_terms; ++j)
      {
        factor += p[j] * inverses[patch][j * n_terms + i];
      }
      for (unsigned c = 0; c < 6; ++c)
      {
        result.local_element(6 * node + c) +=
            weight / coverage[node] * factor * moments[i].local_element(6 * patch + c);
      }
    }
  }
  result.compress(dealii::VectorOperation::add);
  result.update_ghost_values();
  std::vector<double> values(6 * grid.positions.size());
  for (unsigned i = 0; i < values.size(); ++i)
  {
    values[i] = result.local_element(i);
  }
  return values;
}
} // namespace ddfem::fem
