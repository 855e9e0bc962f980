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
  Vec3 burgers; ///< for the line sense that leaves the origin, nm
};

/// How the rays of a convex grain are directed; the total field does not depend on it.
enum class RayDirection : std::uint8_t
{
  normal, ///< outward normal of the face
  radial, ///< away from the centre of the grain's bounding box
};

/// Unit direction of the ray that starts at surface point @p x; does not re-enter a convex grain.
Vec3 ray_direction(const GrainShape &shape, RayDirection rule, const Vec3 &x);

/// Rays of all surface nodes whose Burgers vectors do not balance, derived afresh from the network.
std::vector<VirtualRay> virtual_rays(const Network &network, const GrainShape &shape, RayDirection rule);

/// Burgers vector that the ray of surface node @p i carries away from the node: minus the sum over its arms.
Vec3 ray_burgers(const Network &network, NodeIndex i);
} // namespace ddfem
