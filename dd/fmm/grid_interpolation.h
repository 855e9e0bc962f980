// Lagrange interpolation on equispaced grids in boxes.
//
// A function of the position in a box is replaced by the polynomial of degree n-1 in each direction through its values on
// n x n x n points. Moments are the adjoint of this: the source at x' is spread over the points by their polynomials at x'
// (Fong & Darve, J. Comput. Phys. 228 (2009) 8712, with Chebyshev points; equispaced ones: Blanchard, Coulaud & Darve,
// INRIA RR-8811 (2015)). Polynomials of a parent restricted to its child are polynomials of the child, so that moves
// between levels are exact.
#pragma once

#include "dd/common/types.h"
#include "dd/fmm/vector_row.h"

#include <array>
#include <vector>

namespace ddfem::fmm
{
/// Points per direction. With more, rounding outweighs what is gained: extrapolation multiplies it by a factor that grows with n
/// (docs/decisions.md, 57).
inline constexpr int fewest_grid_points = 2, most_grid_points = 16;

/// Points per direction for a requested error of the far stress, relative to its rms. @throws std::invalid_argument unless
/// 1e-6 <= @p tolerance <= 0.1.
int grid_points(double tolerance);

/// The error that @p n points per direction stay below, on networks whose lines are up to half a box long (measured).
double grid_error(int n);

/// Polynomials of the points at one position: their values are products of one number per direction.
struct GridBasis
{
  double of[3][most_grid_points];
};

class GridInterpolation
{
public:
  /// @throws std::invalid_argument unless fewest_grid_points <= @p n <= most_grid_points.
  explicit GridInterpolation(int n);

  std::size_t n() const { return n_points; } ///< points per direction
  std::size_t n_rows() const { return n_points * n_points * n_points; }
  /// Distances of neighbouring points in a box of the given edges.
  Vec3 spacing(const Vec3 &edges) const { return width / (static_cast<double>(n_points) - 1) * edges; }
  /// Position of point @p k of a direction relative to the centre, in box edges.
  double point(std::size_t k) const;

  /// At @p y, relative to the centre, in box edges.
  GridBasis basis(const Vec3 &y) const;

  /// Spreads eight strengths at one position over the points; rows x slowest, z fastest.
  void add_source(const GridBasis &basis, const Row &strength, Row *moments) const;
  /// Adds the interpolated values at one position to @p value.
  void add_value(const GridBasis &basis, const Row *values, Row &value) const;

  /// Adds the moments of a child, in the octant with bit c set if it is the upper one in direction c, to those of its parent.
  void add_to_parent(std::size_t octant, const Row *child, Row *parent) const;
  /// Adds the values of a parent's polynomial on the points of a child.
  void add_to_child(std::size_t octant, const Row *parent, Row *child) const;

private:
  void basis_along(double y, double *values) const;
  void move(std::size_t octant, const std::array<std::vector<double>, 2> &matrices, const Row *from, Row *to) const;

  std::size_t n_points;
  double width;              ///< of the grid, in box edges
  std::vector<double> scale; ///< 1/(product of the differences of point i to the others), in spacings
  /// For the lower and the upper half of the parent: values of parent's polynomial i on child's point j, and transposed.
  std::array<std::vector<double>, 2> to_parent, to_child;
};
} // namespace ddfem::fmm
