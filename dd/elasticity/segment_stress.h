// Stress of straight dislocation segments and rays in the isotropic non-singular theory.
//
// Cai, Arsenlis, Weinberger & Bulatov, JMPS 54 (2006) 561, replace R by R_a = sqrt(R^2 + a^2) in the line integral of
// Peach and Koehler (Hirth & Lothe, Theory of Dislocations, ch. 4). With R = x - x', line direction t, e = b x t, this
// reads
//
//   sigma = mu/(4 pi) int { -(1/R_a^3 + 3 a^2/(2 R_a^5)) [(R x b) t + t (R x b)]
//           + 1/(1-nu) [ -(e R + R e)/R_a^3 + 3 (R.e) R R / R_a^5 + I (R.e)(1/R_a^3 + 3 a^2/R_a^5) ] } ds
//
// whose integrals over s are elementary. They are evaluated without differences of nearly equal numbers, so that
// collinear, near and distant points are all exact to rounding. The stress of an open piece of line is not in
// equilibrium; sums over closed or infinite lines are.
#pragma once

#include "dd/common/types.h"
#include "dd/elasticity/isotropic.h"
#include "dd/elasticity/vectorised/stress_kernels.h"

namespace ddfem
{
/// Stress (MPa) at @p x (nm) of the segment @p x1 -> @p x2 (nm) with Burgers vector @p b (nm, FS/RH). Zero for a
/// segment of length zero. A core radius of zero is allowed as long as @p x is not on the segment.
SymTensor segment_stress(const IsotropicMedium &medium, const Vec3 &x, const Vec3 &x1, const Vec3 &x2, const Vec3 &b);

/// Stress (MPa) at @p x (nm) of the semi-infinite line that starts at @p origin (nm) and runs to infinity along the
/// unit vector @p direction, line sense away from @p origin, Burgers vector @p b (nm, FS/RH). The exact limit of
/// segment_stress(). A core radius of zero is allowed as long as @p x is not on the ray.
SymTensor ray_stress(const IsotropicMedium &medium, const Vec3 &x, const Vec3 &origin, const Vec3 &direction,
                     const Vec3 &b);

/// The stress field of one segment, for evaluation at many points; same arguments as segment_stress().
class SegmentStressField
{
public:
  SegmentStressField(const IsotropicMedium &medium, const Vec3 &x1, const Vec3 &x2, const Vec3 &b);

  /// Stress at @p x, MPa.
  SymTensor operator()(const Vec3 &x) const;
  /// Adds the stress at many points, as add_segment_stress() does.
  void add(const StressBatch &batch) const;

private:
  IsotropicMedium medium;
  Vec3 x1, x2, t, b;
  double length;
};

/// The stress field of one ray, for evaluation at many points; same arguments as ray_stress().
class RayStressField
{
public:
  RayStressField(const IsotropicMedium &medium, const Vec3 &origin, const Vec3 &direction, const Vec3 &b);

  /// Stress at @p x, MPa.
  SymTensor operator()(const Vec3 &x) const;
  /// As add_ray_stress().
  void add(const StressBatch &batch) const;

private:
  IsotropicMedium medium;
  Vec3 origin, direction, b;
};
} // namespace ddfem
