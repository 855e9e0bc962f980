#pragma once

#include "fem/lagrange.h"
#include "fem/nodal_grid.h"

#include <deal.II/lac/la_parallel_vector.h>

#include <array>
#include <memory>
#include <vector>

namespace ddfem::fem
{
/// Least-squares fits of a stress field over patches of cells (Zienkiewicz & Zhu, IJNME 33 (1992) 1331): around every
/// vertex inside the grain a complete polynomial of the elements' degree is fitted to the values at the Gauss points of
/// the cells that share the vertex. A node gets the mean of the fits of the vertices inside the grain that belong to
/// the edge, face or cell it lies in. Nodes on the boundary get none with degree 2, and those of the vertices inside of their
/// cells with degree 1: extrapolated that far, fits of the inside are
/// worse than values of the cells there as soon as the stress varies over less than four cells.
///
/// Normal equations are sums over cells, so that nothing but sums at vertices has to be exchanged between ranks.
class PatchFit
{
public:
  using Six = std::array<double, 6>;

  /// `gauss`: unit coordinates of the points where stresses will be given. Collective.
  PatchFit(const NodalGrid &grid, const std::vector<dealii::Point<3>> &gauss);

  /// Six values for each local node from six for each [cell][Gauss point]. Nodes that take part in no patch (see
  /// covered()) get zero. Collective.
  std::vector<double> nodal_values(const std::vector<Six> &at_gauss_points) const;

  /// Whether a local node gets a value: not on the boundary (degree 2), nor where no vertex lies inside the grain.
  bool covered(unsigned node) const { return coverage[node] > 0.; }

private:
  using NodeVector = dealii::LinearAlgebra::distributed::Vector<double>; // six numbers for each node
  using Basis = std::array<double, 10>;

  struct Contribution
  {
    unsigned node, patch; // local nodes; patch: the vertex
    double weight;        // number of own cells in which the node takes this patch
  };

  void make_partitioner();
  void measure_patches();
  void make_normal_matrices(const std::vector<dealii::Point<3>> &gauss);
  void invert_normal_matrices(const std::vector<NodeVector> &sums);
  void make_contributions();
  Basis basis(unsigned patch, const dealii::Point<3> &x) const;
  unsigned corner(unsigned cell, unsigned v) const;
  bool valid(unsigned node) const { return !inverses[node].empty(); }

  const NodalGrid &grid;
  unsigned n_terms;
  std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner;
  std::vector<double> sizes;                 // of patches, nm, by local node
  std::vector<dealii::Point<3>> points;      // [cell][Gauss point]
  std::vector<std::vector<double>> inverses; // of the normal matrices, by local node; empty where there is no patch
  std::vector<Contribution> contributions;
  std::vector<double> coverage; // total weight of each local node
};
} // namespace ddfem::fem
