// Force of a straight segment on itself, and the core energy with its forces.
#pragma once

#include "dd/elasticity/segment_force.h"

namespace ddfem
{
/// Core energy per length E(b, t) = mu/(4 pi) ln(a/r_core) (b_s^2 + b_e^2/(1-nu)), with b_s = b.t and b_e the screw and
/// edge parts of the Burgers vector. The non-singular elastic energy depends on the core radius a as
/// -mu/(4 pi) ln(a) (b_s^2 + b_e^2/(1-nu)) per length, so that with this core energy the total depends, to leading
/// order, on r_core only: r_core is the physical parameter, a the numerical one.
struct CoreEnergy
{
  double core_radius_cutoff = 0.0; ///< r_core, nm; > 0. Equal to the core radius a: no core energy.
};

/// Forces (MPa nm^2) on the nodes of segment @p x1 -> @p x2 (nm) with Burgers vector @p b (nm) due to its own
/// non-singular stress, in closed form (cf. Arsenlis et al., MSMSE 15 (2007) 553; derived here by integrating
/// segment_stress() on the segment):
///   f_end = mu/(4 pi) b_s b_e { nu/(1-nu) [ln((L_a + L)/a) - 2 (L_a - a)/L] - (L_a - a)^2/(2 L L_a) },
///   f_start = -f_end, L_a = sqrt(L^2 + a^2), b_e = b - b_s t.
/// Along +b_e at the end node when nu is large enough: the segment turns towards screw character. Needs a > 0.
SegmentForces self_force(const IsotropicMedium &medium, const Vec3 &x1, const Vec3 &x2, const Vec3 &b);

/// Core energy of the segment, MPa nm^3.
double core_energy(const IsotropicMedium &medium, const CoreEnergy &core, const Vec3 &x1, const Vec3 &x2,
                   const Vec3 &b);

/// Minus the derivative of core_energy() with respect to the node positions, MPa nm^2: line tension along the segment
/// and torque (the derivative with respect to character) across it.
SegmentForces core_force(const IsotropicMedium &medium, const CoreEnergy &core, const Vec3 &x1, const Vec3 &x2,
                         const Vec3 &b);
} // namespace ddfem
