// Influence of the far periodic images of a line element: third derivatives of the periodic R function.
#pragma once

#include "dd/common/types.h"

#include <array>
#include <vector>

namespace ddfem
{
/// The ten independent third derivatives d_i d_j d_k of a scalar: xxx xxy xxz xyy xyz xzz yyy yyz yzz zzz.
using ThirdDerivatives = std::array<double, 10>;

/// The 27 translations n L, n in {-1,0,1}^3, of an orthorhombic cell of edge lengths @p lengths (nm). The zero shift
/// comes first, the others follow in lexicographic order of n.
std::vector<Vec3> near_image_shifts(const Vec3 &lengths);

/**
 * Third derivatives of
 *   F(x) = R_per(x) - sum_{n in {-1,0,1}^3} |x - n L|,    R_per(x) = -(8 pi / V) sum_{k != 0} exp(i k.x) / k^4,
 * i.e. of everything that an orthorhombic lattice of sources adds to the 27 nearest boxes, in the convention that the
 * cell mean vanishes (k = 0 dropped; Cai, Bulatov, Chang, Li, Yip, Phil. Mag. 83 (2003) 539). They are odd in x and
 * smooth as long as |x_i| < 2 L_i on every axis, where the nearest remaining image sits.
 *
 * Ewald splitting R = W + S with
 *   W(R) = R erf(alpha R) + exp(-alpha^2 R^2) / (alpha sqrt(pi)),   S(R) = R erfc(alpha R) - exp(...) / (...),
 * chosen so that W' = erf(alpha R) and S' = erfc(alpha R). From lap W = 2 erf(alpha R)/R + 2 alpha/sqrt(pi)
 * exp(-alpha^2 R^2) follows the transform W(k) = -(8 pi/k^4) (1 + q) exp(-q), q = k^2/(4 alpha^2). The 27 removed
 * images contribute S - R = -W, evaluated by Boys functions, without cancellation and regular at R = 0.
 */
class PeriodicKernel
{
public:
  /// @param lengths edge lengths of the cell, nm, all positive.
  /// @param alpha   splitting parameter, 1/nm; zero selects the one that balances both sums. The result does not
  ///                depend on it (to rounding).
  /// @throws std::invalid_argument for a non-positive length or a negative alpha.
  explicit PeriodicKernel(const Vec3 &lengths, double alpha = 0.0);

  /// Third derivatives of F at @p x (nm), in 1/nm^2.
  ThirdDerivatives operator()(const Vec3 &x) const;

private:
  struct Wave
  {
    Vec3 k;             ///< wave vector, 1/nm
    double coefficient; ///< 2 W(k) / V: a wave and its opposite are taken together, nm
  };

  void add_removed_images(const Vec3 &x, ThirdDerivatives &sum) const;
  void add_short_range_images(const Vec3 &x, ThirdDerivatives &sum) const;
  void add_waves(const Vec3 &x, ThirdDerivatives &sum) const;

  Vec3 edges;       ///< nm
  double splitting; ///< alpha, 1/nm
  double cutoff;    ///< distance beyond which S is below rounding, nm
  std::vector<Wave> waves;
};
} // namespace ddfem
