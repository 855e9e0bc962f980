// Pure functions of one element: stiffness, volume, stress. No mesh, no communication.
#pragma once

#include "fem/lagrange.h"

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <utility>
#include <vector>

namespace ddfem::fem
{
/// Unit coordinates and weights of the Gauss rule with n points per direction on the unit cube, first coordinate
/// fastest.
struct CubeRule
{
  std::vector<dealii::Point<3>> points;
  std::vector<double> weights;
};
CubeRule gauss_cube(unsigned n);

/// d x_i / d xi_j of the mapping with the given nodes.
template <typename Positions>
dealii::Tensor<2, 3> jacobian(const LagrangeCell &shape, unsigned n_nodes, const Positions &positions)
{
  dealii::Tensor<2, 3> result;
  for (unsigned a = 0; a < n_nodes; ++a)
  {
    const dealii::Point<3> &x = positions(a);
    for (unsigned i = 0; i < 3; ++i)
    {
      for (unsigned j = 0; j < 3; ++j)
      {
        result[i][j] += x[i] * shape.gradient[a][j];
      }
    }
  }
  return result;
}

/// Element stiffness matrix of isotropic elasticity, row-major with 3 n_nodes rows, row 3 a + c. Nodes in nm, moduli in
/// MPa: entries in MPa nm. Throws std::invalid_argument for an inverted cell.
std::vector<double> element_stiffness(unsigned degree, const std::vector<dealii::Point<3>> &nodes, double lambda,
                                      double mu);

/// Integrals of the shape functions' products with a linear field over an element: int N_a z dV for z = shift + spin x
/// (x - c).
std::vector<dealii::Tensor<1, 3>> integrate_rigid_motion(unsigned degree, const std::vector<dealii::Point<3>> &nodes,
                                                         const dealii::Tensor<1, 3> &shift,
                                                         const dealii::Tensor<1, 3> &spin,
                                                         const dealii::Point<3> &centre);

/// Volume (nm^3) and first moment of volume (nm^4) of an element.
std::pair<double, dealii::Tensor<1, 3>> element_volume(unsigned degree, const std::vector<dealii::Point<3>> &nodes);
} // namespace ddfem::fem
