#pragma once

#include "fem/elastic_system.h"
#include "fem/element.h"
#include "fem/nodal_grid.h"

#include <array>
#include <vector>

namespace ddfem::fem
{
/// Continuous stress from a displacement: stress at the p^3 Gauss points of each cell, where gradients are superconvergent
/// (Barlow points), extrapolated by the polynomial through them to the cell's nodes and averaged over the cells that share a
/// node. On affine cells, exact for a stress that is linear (degree 2) or constant (degree 1).
class StressRecovery
{
public:
  /// Collective. Lambda, mu in MPa.
  StressRecovery(const NodalGrid& grid, double lambda, double mu);

  /// Six numbers xx yy zz xy xz yz (MPa) for each local node. `displacement` (nm) has its ghost values. Collective.
  std::vector<double> recover(const NodalVector& displacement) const;

private:
  void make_extrapolation(const CubeRule& rule);
  void stress_at_gauss_points(unsigned cell, const NodalVector& displacement,
                              std::vector<std::array<double, 6>>& stress) const;

  const NodalGrid& grid;
  double lambda, mu;
  unsigned n_points;                                         // per cell
  std::vector<std::vector<std::array<double, 3>>> gradients; // unit gradients [point][node]
  std::vector<std::vector<double>> extrapolation;            // [node][point]
  std::vector<double> inverse_jacobians;                     // [cell][point][3][3]: d xi_i / d x_j
  std::vector<double> weights;                               // of each local node: one over the number of cells sharing it
};
} // namespace ddfem::fem
