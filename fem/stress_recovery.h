#pragma once

#include "fem/elastic_system.h"
#include "fem/element.h"
#include "fem/nodal_grid.h"
#include "fem/patch_fit.h"

#include <array>
#include <memory>
#include <vector>

namespace ddfem::fem
{
/// Continuous stress from a displacement, from the values at the p^3 Gauss points of each cell, where gradients are
/// superconvergent (Barlow points). By patches: see PatchFit. By averages, also at the boundary: extrapolated by the
/// polynomial through the Gauss points to the cell's nodes and averaged over the cells that share a node, which is of
/// the order of the element's own gradient. On affine cells both are exact for a stress that is linear (degree 2) or
/// constant (degree 1). For a point force at a distance s outside, with quadratic cells of size h, patches are 5 to 20
/// times more accurate inside the grain and 1.5 to 4 times near the surface when h/s <= 1/4, the same at 1/2, and up to
/// twice worse for h/s >= 1, where both err by 10 % and more.
class StressRecovery
{
public:
  /// Collective. Lambda, mu in MPa.
  StressRecovery(const NodalGrid &grid, double lambda, double mu, bool by_patches);

  /// Six numbers xx yy zz xy xz yz (MPa) for each local node. `displacement` (nm) has its ghost values. Collective.
  std::vector<double> recover(const NodalVector &displacement) const;

private:
  void make_extrapolation(const CubeRule &rule);
  void stress_at_gauss_points(unsigned cell, const NodalVector &displacement, std::array<double, 6> *stress) const;
  std::vector<double> averages(const std::vector<std::array<double, 6>> &stress) const;

  const NodalGrid &grid;
  double lambda, mu;
  unsigned n_points;                                         // per cell
  std::vector<std::vector<std::array<double, 3>>> gradients; // unit gradients [point][node]
  std::vector<std::vector<double>> extrapolation;            // [node][point]
  std::vector<double> inverse_jacobians;                     // [cell][point][3][3]: d xi_i / d x_j
  std::vector<double> weights; // of each local node: one over the number of cells sharing it
  std::unique_ptr<PatchFit> patches;
};
} // namespace ddfem::fem
