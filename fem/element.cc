#include "fem/element.h"

#include <deal.II/base/quadrature_lib.h>

#include <stdexcept>

namespace ddfem::fem
{
namespace
{
/// Calls f(shape, jacobian, weight * det) at each point of a rule that is exact for the element's integrals.
template <typename Function>
void for_each_point(unsigned degree, const std::vector<dealii::Point<3>> &nodes, unsigned n_points, Function &&f)
{
  const CubeRule rule = gauss_cube(n_points);
  for (std::size_t q = 0; q < rule.points.size(); ++q)
  {
    const LagrangeCell shape = lagrange_cell(degree, rule.points[q]);
    const auto j = jacobian(shape, static_cast<unsigned>(nodes.size()),
                            [&](unsigned a) -> const dealii::Point<3> & { return nodes[a]; });
    const double volume = determinant(j);
    if (!(volume > 0.))
    {
      throw std::invalid_argument("the mesh has a cell that is inside out or folded");
    }
    f(shape, j, rule.weights[q] * volume);
  }
}

/// Position of a point given its shape function values.
dealii::Point<3> position(const LagrangeCell &shape, const std::vector<dealii::Point<3>> &nodes)
{
  dealii::Point<3> x;
  for (std::size_t a = 0; a < nodes.size(); ++a)
  {
    x += shape.value[a] * nodes[a];
  }
  return x;
}

/// Adds the contribution of one point: lambda N_a,c N_b,d + mu (N_a,d N_b,c + delta_cd N_a,k N_b,k).
void add_stiffness(const std::vector<dealii::Tensor<1, 3>> &gradient, double lambda, double mu,
                   std::vector<double> &matrix)
{
  const std::size_t n = gradient.size();
  for (std::size_t a = 0; a < n; ++a)
  {
    for (std::size_t b = 0; b < n; ++b)
    {
      const double diagonal = mu * (gradient[a] * gradient[b]);
      for (unsigned c = 0; c < 3; ++c)
      {
        double *const row = &matrix[(3 * a + c) * 3 * n + 3 * b];
        for (unsigned d = 0; d < 3; ++d)
        {
          row[d] += lambda * gradient[a][c] * gradient[b][d] + mu * gradient[a][d] * gradient[b][c];
        }
        row[c] += diagonal;
      }
    }
  }
}
} // namespace

CubeRule gauss_cube(unsigned n)
{
  const dealii::QGauss<3> rule(n);
  return {rule.get_points(), rule.get_weights()};
}

std::vector<double> element_stiffness(unsigned degree, const std::vector<dealii::Point<3>> &nodes, double lambda,
                                      double mu)
{
  const std::size_t n = nodes.size();
  std::vector<double> matrix(9 * n * n, 0.);
  std::vector<dealii::Tensor<1, 3>> gradient(n);
  for_each_point(degree, nodes, degree + 1,
                 [&](const LagrangeCell &shape, const dealii::Tensor<2, 3> &j, double weight)
                 {
                   const dealii::Tensor<2, 3> inverse = invert(j);
                   for (std::size_t a = 0; a < n; ++a)
                   {
                     const auto &g = shape.gradient[a];
                     gradient[a] = dealii::Tensor<1, 3>({g[0], g[1], g[2]}) * inverse;
                   }
                   add_stiffness(gradient, lambda * weight, mu * weight, matrix);
                 });
  return matrix;
}

std::vector<dealii::Tensor<1, 3>> integrate_rigid_motion(unsigned degree, const std::vector<dealii::Point<3>> &nodes,
                                                         const dealii::Tensor<1, 3> &shift,
                                                         const dealii::Tensor<1, 3> &spin,
                                                         const dealii::Point<3> &centre)
{
  std::vector<dealii::Tensor<1, 3>> result(nodes.size());
  for_each_point(degree, nodes, degree + 2,
                 [&](const LagrangeCell &shape, const dealii::Tensor<2, 3> &, double weight)
                 {
                   const auto motion = shift + cross_product_3d(spin, position(shape, nodes) - centre);
                   for (std::size_t a = 0; a < nodes.size(); ++a)
                   {
                     result[a] += weight * shape.value[a] * motion;
                   }
                 });
  return result;
}

std::pair<double, dealii::Tensor<1, 3>> element_volume(unsigned degree, const std::vector<dealii::Point<3>> &nodes)
{
  std::pair<double, dealii::Tensor<1, 3>> result{0., {}};
  for_each_point(degree, nodes, degree + 2,
                 [&](const LagrangeCell &shape, const dealii::Tensor<2, 3> &, double weight)
                 {
                   result.first += weight;
                   result.second += weight * position(shape, nodes);
                 });
  return result;
}
} // namespace ddfem::fem
