// Real regular solid harmonics, their gradients and their behaviour under rotation.
//
// S_lm(x) = r^l C_lm(x/r) with Racah's normalisation: sum_m C_lm(u) C_lm(v) = P_l(u.v), so that
//   1/|x - y| = sum_lm |y|^l / |x|^(l+1) C_lm(x/|x|) C_lm(y/|y|)   for |y| < |x|,
// without factors, and rotations are orthogonal matrices. m > 0 goes with cos(m phi), m < 0 with sin(|m| phi); no
// Condon-Shortley phase: S_11 = x, S_1-1 = y, S_10 = z. (Hobson, Spherical and Ellipsoidal Harmonics, 1931, ch. IV;
// recurrences as in Dehnen, Comput. Astrophys. Cosmol. 1 (2014) 1, appendix A, renormalised.)
#pragma once

#include "dd/fmm/vector_row.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ddfem::fmm
{
/// Highest degree of the expansions; enough for errors of 1e-8.
inline constexpr int max_order = 38;

/// Number of harmonics of degree 0 to @p order.
constexpr std::size_t n_harmonics(int order)
{
  const auto n = static_cast<std::size_t>(order) + 1;
  return n * n;
}

/// Position of S_lm, -l <= m <= l.
constexpr std::size_t harmonic_index(int l, int m)
{
  const int position = l * l + l + m;
  return static_cast<std::size_t>(position);
}

/// Values of all harmonics up to @p order at eight points: @p points holds the rows x, y, z; @p values gets n_harmonics()
/// rows.
void regular_harmonics(int order, const Row *points, Row *values);
/// The same at sixteen points in single precision.
void regular_harmonics(int order, const WideSingleRows::Row *points, WideSingleRows::Row *values);

/// One term of the gradient of an expansion sum c_lm S_lm: coefficient `to` of the derivative gets factor c_from.
struct GradientTerm
{
  std::uint16_t from, to;
  double factor;
};

/// The terms of d/dx, d/dy, d/dz for expansions up to @p order.
std::array<std::vector<GradientTerm>, 3> gradient_terms(int order);

/// The matrices D_l of S_l(R x) = D_l S_l(x) for the rotation R by -theta about y, which takes (sin theta, 0, cos theta)
/// to the z axis. Rotations about y do not mix cosines and sines: for each degree, a matrix of size l+1 for m = 0..l, then
/// one of size l for m = 1..l (sines), both row by row.
std::vector<double> rotation_about_y(int order, double cos_theta, double sin_theta);
} // namespace ddfem::fmm
