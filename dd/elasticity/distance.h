// Smallest distances between points, segments and rays.
#pragma once

#include "dd/common/types.h"

namespace ddfem
{
/// Closest point of a segment or ray to a given point.
struct PointDistance
{
  double squared;   ///< square of the smallest distance, nm^2
  double parameter; ///< where: fraction of the segment in [0, 1], or length along the ray in nm
};

/// Closest points of two straight pieces of line.
struct PairDistance
{
  double squared; ///< square of the smallest distance, nm^2
  double first;   ///< closest point on the first piece: fraction of a segment in [0, 1], or length along a ray in nm
  double second;  ///< the same on the second piece
};

/// Distance of point @p x from segment @p x1 -> @p x2 (which may have length zero). All positions in nm.
PointDistance distance_point_segment(const Vec3 &x, const Vec3 &x1, const Vec3 &x2);

/// Distance of point @p x from the ray that starts at @p origin and runs along the unit vector @p direction.
PointDistance distance_point_ray(const Vec3 &x, const Vec3 &origin, const Vec3 &direction);

/// Distance of segments @p x1 -> @p x2 and @p x3 -> @p x4. The smallest of the four end-to-segment distances and, where
/// it exists, of the interior stationary point: no angle threshold, so parallel pairs need no special treatment (they
/// have a continuum of closest points, of which one is returned).
PairDistance distance_segment_segment(const Vec3 &x1, const Vec3 &x2, const Vec3 &x3, const Vec3 &x4);

/// Distance of segment @p x1 -> @p x2 (parameter `first`) and a ray (parameter `second`).
PairDistance distance_segment_ray(const Vec3 &x1, const Vec3 &x2, const Vec3 &origin, const Vec3 &direction);
} // namespace ddfem
