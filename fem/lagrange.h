// Lagrange polynomials of degree 1 and 2 on equidistant nodes of the unit interval, and their products on the unit
// cube. Nodes of the cube are numbered lexicographically, the first coordinate fastest.
#pragma once

#include <array>

namespace ddfem::fem
{
/// Values and derivatives of the (up to three) polynomials at one place.
struct Lagrange1d
{
  std::array<double, 3> value;
  std::array<double, 3> derivative;
};

inline Lagrange1d lagrange_1d(unsigned degree, double x)
{
  if (degree == 1)
  {
    return {{1. - x, x, 0.}, {-1., 1., 0.}};
  }
  return {{(2. * x - 1.) * (x - 1.), 4. * x * (1. - x), x * (2. * x - 1.)}, {4. * x - 3., 4. - 8. * x, 4. * x - 1.}};
}

/// Most nodes a cell can have.
inline constexpr unsigned max_nodes_per_cell = 27;

/// Values and gradients (in unit coordinates) of all shape functions of the cube at one place.
struct LagrangeCell
{
  std::array<double, max_nodes_per_cell> value;
  std::array<std::array<double, 3>, max_nodes_per_cell> gradient;
};

template <typename UnitPoint> LagrangeCell lagrange_cell(unsigned degree, const UnitPoint &xi)
{
  const std::array<Lagrange1d, 3> one = {lagrange_1d(degree, xi[0]), lagrange_1d(degree, xi[1]),
                                         lagrange_1d(degree, xi[2])};
  LagrangeCell result;
  unsigned a = 0;
  for (unsigned k = 0; k <= degree; ++k)
  {
    for (unsigned j = 0; j <= degree; ++j)
    {
      for (unsigned i = 0; i <= degree; ++i, ++a)
      {
        const double x = one[0].value[i], y = one[1].value[j], z = one[2].value[k];
        result.value[a] = x * y * z;
        result.gradient[a] = {one[0].derivative[i] * y * z, x * one[1].derivative[j] * z, x * y * one[2].derivative[k]};
      }
    }
  }
  return result;
}
} // namespace ddfem::fem
