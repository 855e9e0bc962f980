// Lines end only at infinity: the continuation of surface nodes outside the grain.
#pragma once

#include "dd/geometry/grain_shape.h"
#include "dd/network/network.h"

#include <vector>

namespace ddfem
{
/// Semi-infinite straight line that leaves `origin` along the unit vector `direction`.
struct VirtualRay
{
  Vec3 origin, direction;
  Vec3 burgers;      ///< for the line sense that leaves the origin, nm
  ObjectId node = 0; ///< at the origin, where there is one
};

/// How rays are directed if nothing is in the way; the total field does not depend on it.
enum class RayDirection : std::uint8_t
{
  normal, ///< outward normal of the face
  radial, ///< away from the centre of the grain's bounding box
};

/// Whether the ray from surface point @p x along the unit vector @p d stays outside the grain, at a distance of at least
/// @p clearance times the way from @p x, up to a way of a twentieth of the grain's diameter.
bool ray_is_free(const GrainShape &shape, const Vec3 &x, const Vec3 &d, double clearance);

/// Unit direction of the ray that starts at surface point @p x and does not meet the grain again: that of the rule if
/// it is free, and otherwise the free one nearest to the outward normal among 98 fixed directions. It depends on @p shape,
/// @p rule and @p x only. Throws std::runtime_error naming the point if no direction is free, as in a closed cavity.
Vec3 ray_direction(const GrainShape &shape, RayDirection rule, const Vec3 &x);

/// Rays of all surface nodes whose Burgers vectors do not balance, derived afresh from the network.
std::vector<VirtualRay> virtual_rays(const Network &network, const GrainShape &shape, RayDirection rule);

/// Burgers vector that the ray of surface node @p i carries away from the node: minus the sum over its arms.
Vec3 ray_burgers(const Network &network, NodeIndex i);
} // namespace ddfem
