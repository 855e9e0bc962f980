// From multipoles to the local expansion of their integrals along half-lines, for the images of dislocation lines.
//
// The potentials of an image (image_expansion.h) are 1/R, Lambda = ln(R+Z), psi, chi, each the z-derivative of the next, and their
// derivatives. All of them become multipoles when they are differentiated three times with respect to z, and this is what the multipole
// expansions of images hold. With I_lm = (l-m)! P_lm(cos theta) exp(i m phi)/r^(l+1) one has d_z I_lm = -I_l+1,m, so that the potential
// of the multipole I_lm is -I_l-3,m, whose degree may be smaller than its order: the function of this degree that is harmonic,
// homogeneous (but for a logarithm) and regular outside the half-line below the origin. Differentiation with respect to x and y is the
// same for all: (d_x + i d_y) I_lm = -I_l+1,m+1, and with I_l,-m = (-1)^m conj(I_lm) the local expansion of any of them is Taylor's series
// with coefficients (-1)^(j-k) I_l+j,m-k. What remains are the start values I_m-1,m, I_m-2,m and I_m-3,m, sums of positive terms.
//
// The half-lines make z special, and rotations other than about z are of no use: a dense matrix for the cosines and one for the sines
// in coordinates in which the shift has phi = 0.
#pragma once

#include "dd/common/types.h"
#include "dd/fmm/vector_row.h"

#include <memory>
#include <vector>

namespace ddfem::fmm
{
/// I_nm at (rho, 0, z), r > 0, not on the half-line rho = 0, z < 0, for n >= -3, m >= 0; where rho > 0 or n >= m it is real and
/// has the logarithms of Lambda in units of the coordinates. I_-3,0, whose value no gradient needs, is left zero.
class IrregularFunctions
{
public:
  /// For 0 <= m <= @p highest + 3, n <= @p highest.
  IrregularFunctions(int highest, double rho, double z);

  /// With @p m of any sign.
  double operator()(int n, int m) const;

private:
  double &entry(int n, int m);
  int n_degrees;
  std::vector<double> values;
};

/// What translations with the same rho and z of their shifts share.
class HalfLineMatrices
{
public:
  HalfLineMatrices(int n_antiderivatives, int source_order, int target_order, double rho, double z);

  int source_order, target_order;
  std::vector<double> cosines, sines; ///< target harmonics by source harmonics, each by l, then m
};

/// For shifts in whole cubes; kept, since few occur, again and again.
std::shared_ptr<const HalfLineMatrices> half_line_matrices(int n_antiderivatives, int source_order, int target_order,
                                                           long rho_squared, long z);

class HalfLineTranslation
{
public:
  HalfLineTranslation(std::shared_ptr<const HalfLineMatrices> matrices, const Vec3 &vector);

  /// Adds the local expansions of the sources, n_harmonics(source_order) rows of eight expansions, to @p target, n_harmonics(target_order)
  /// rows, both as in translation.h, for boxes of size 1: integrals have the unit of length of their number.
  void add(const Row *source, Row *target) const;

  int source_order() const { return matrices->source_order; }
  int target_order() const { return matrices->target_order; }
  const Vec3 &vector() const { return shift; } ///< target - source centre in units of the box size

private:
  std::shared_ptr<const HalfLineMatrices> matrices;
  Vec3 shift;
  std::vector<double> phase; ///< cos(m phi), sin(m phi)
};
} // namespace ddfem::fmm
