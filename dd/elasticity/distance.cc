#include "dd/elasticity/distance.h"

#include <algorithm>
#include <optional>

namespace ddfem
{
namespace
{
/// Parameters along u and v where the lines p + s u and q + t v are closest; nothing for parallel lines.
struct Stationary
{
  double s, t;
};

std::optional<Stationary> stationary_point(const Vec3 &p, const Vec3 &u, const Vec3 &q, const Vec3 &v)
{
  // Cross products instead of the usual u.u v.v - (u.v)^2: half of the digits are not lost for small angles.
  const Vec3 normal = u.cross(v);
  const double normal2 = normal.squaredNorm();
  if (normal2 == 0.0)
    return std::nullopt;
  const Vec3 offset = q - p;
  return Stationary{offset.cross(v).dot(normal) / normal2, offset.cross(u).dot(normal) / normal2};
}

void keep_smaller(PairDistance &best, const PairDistance &candidate)
{
  if (candidate.squared < best.squared)
    best = candidate;
}
} // namespace

PointDistance distance_point_segment(const Vec3 &x, const Vec3 &x1, const Vec3 &x2)
{
  const Vec3 u = x2 - x1;
  const double length2 = u.squaredNorm();
  const double s = length2 > 0.0 ? std::clamp((x - x1).dot(u) / length2, 0.0, 1.0) : 0.0;
  return {(x - x1 - s * u).squaredNorm(), s};
}

PointDistance distance_point_ray(const Vec3 &x, const Vec3 &origin, const Vec3 &direction)
{
  const double s = std::max((x - origin).dot(direction), 0.0);
  return {(x - origin - s * direction).squaredNorm(), s};
}

PairDistance distance_segment_segment(const Vec3 &x1, const Vec3 &x2, const Vec3 &x3, const Vec3 &x4)
{
  const PointDistance of_x1 = distance_point_segment(x1, x3, x4), of_x2 = distance_point_segment(x2, x3, x4);
  const PointDistance of_x3 = distance_point_segment(x3, x1, x2), of_x4 = distance_point_segment(x4, x1, x2);
  PairDistance best{of_x1.squared, 0.0, of_x1.parameter};
  keep_smaller(best, {of_x2.squared, 1.0, of_x2.parameter});
  keep_smaller(best, {of_x3.squared, of_x3.parameter, 0.0});
  keep_smaller(best, {of_x4.squared, of_x4.parameter, 1.0});

  const Vec3 u = x2 - x1, v = x4 - x3;
  const auto inner = stationary_point(x1, u, x3, v);
  if (inner && inner->s > 0.0 && inner->s < 1.0 && inner->t > 0.0 && inner->t < 1.0)
    keep_smaller(best, {(x1 + inner->s * u - x3 - inner->t * v).squaredNorm(), inner->s, inner->t});
  return best;
}

PairDistance distance_segment_ray(const Vec3 &x1, const Vec3 &x2, const Vec3 &origin, const Vec3 &direction)
{
  const PointDistance of_x1 = distance_point_ray(x1, origin, direction);
  const PointDistance of_x2 = distance_point_ray(x2, origin, direction);
  const PointDistance of_origin = distance_point_segment(origin, x1, x2);
  PairDistance best{of_x1.squared, 0.0, of_x1.parameter};
  keep_smaller(best, {of_x2.squared, 1.0, of_x2.parameter});
  keep_smaller(best, {of_origin.squared, of_origin.parameter, 0.0});

  const Vec3 u = x2 - x1;
  const auto inner = stationary_point(x1, u, origin, direction);
  if (inner && inner->s > 0.0 && inner->s < 1.0 && inner->t > 0.0)
    keep_smaller(best, {(x1 + inner->s * u - origin - inner->t * direction).squaredNorm(), inner->s, inner->t});
  return best;
}
} // namespace ddfem
