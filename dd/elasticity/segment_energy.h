// Elastic energy of straight segments in the isotropic non-singular theory.
#pragma once

#include "dd/common/types.h"
#include "dd/elasticity/isotropic.h"

namespace ddfem
{
/// Interaction energy (MPa nm^3) of segments @p x1 -> @p x2 and @p x3 -> @p x4 (nm, FS/RH):
///   W = mu/(4 pi) int int { lap R_a [ -(b12 x b34).(t12 x t34) + (b12.t12)(b34.t34)/2 ]
///                           + (b12 x t12) . grad grad R_a . (b34 x t34) / (1-nu) } ds ds',
/// Blin's formula (Hirth & Lothe, Theory of Dislocations, ch. 4) with R replaced by R_a = sqrt(R^2 + a^2), as Cai et
/// al., JMPS 54 (2006) 561 show for the non-singular theory; lap R_a = 2/R_a + a^2/R_a^3. Only the sum over closed (or
/// infinite) lines has a physical meaning: each pair counted once, plus segment_self_energy() of every segment. Inner
/// integral in closed form, outer one by Gauss rules with the error control of segment_force(), to @p tolerance.
double segment_interaction_energy(const IsotropicMedium &medium, const Vec3 &x1, const Vec3 &x2, const Vec3 &b12,
                                  const Vec3 &x3, const Vec3 &x4, const Vec3 &b34, double tolerance = 1e-12);

/// Self energy (MPa nm^3) of one segment: half of the interaction energy with itself, in closed form,
///   W = mu/(4 pi) { b_s^2 [L asinh(L/a) - (L_a - a)/2] + b_e^2/(1-nu) [L asinh(L/a) - (L_a - a)] },
/// L_a = sqrt(L^2 + a^2). Needs a > 0.
double segment_self_energy(const IsotropicMedium &medium, const Vec3 &x1, const Vec3 &x2, const Vec3 &b);
} // namespace ddfem
