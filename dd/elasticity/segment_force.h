// Nodal forces on a straight segment due to the stress of another segment or of a ray.
#pragma once

#include "dd/common/types.h"
#include "dd/elasticity/isotropic.h"

namespace ddfem
{
/// Forces on the two nodes of a segment with linear shape functions, MPa nm^2.
struct SegmentForces
{
  Vec3 start = Vec3::Zero();
  Vec3 end = Vec3::Zero();
};

/// Forces on the nodes of segment @p x3 -> @p x4 with Burgers vector @p b34 due to segment @p x1 -> @p x2 with Burgers
/// vector @p b12 (lengths in nm, FS/RH):
///   f_n = int N_n(s) (sigma_12(x(s)) . b34) x t34 ds,
/// the definition of Arsenlis et al., MSMSE 15 (2007) 553. The stress is the closed form of
/// segment_stress(); the outer integral is done by Gauss rules on panels, both chosen from the singularities of the
/// integrand in the complex plane (panel_quadrature.h), so that parallel, collinear, coincident, touching and distant
/// pairs take the same path and no angle threshold exists.
///
/// @param tolerance wanted error relative to the size of the integrated force (an a-priori estimate from the geometry
///        with a safety factor, not a strict bound), between 1e-13 and 1e-1.
///
/// For a = 0 the segments must not touch.
SegmentForces segment_force(const IsotropicMedium &medium, const Vec3 &x1, const Vec3 &x2, const Vec3 &b12,
                            const Vec3 &x3, const Vec3 &x4, const Vec3 &b34, double tolerance = 1e-10);

/// The same for the force of a ray (see ray_stress()) on segment @p x3 -> @p x4.
SegmentForces segment_force_from_ray(const IsotropicMedium &medium, const Vec3 &origin, const Vec3 &direction,
                                     const Vec3 &b_ray, const Vec3 &x3, const Vec3 &x4, const Vec3 &b34,
                                     double tolerance = 1e-10);
} // namespace ddfem
