#include "dd/topology/product_plane_rule.h"

#include "dd/crystal/product_plane.h"

#include <vector>

namespace ddfem
{
namespace
{
/// Numbers of the crystal's planes with these normals (either sense); others are left out.
std::vector<std::size_t> planes_with(const SlipSystems &systems, const std::span<const Vec3> normals)
{
  constexpr double parallel_sine = 1e-4;
  std::vector<std::size_t> found;
  for (const Vec3 &n : normals)
    for (std::size_t p = 0; p < systems.planes().size(); ++p)
      if (!n.isZero(0) && systems.planes()[p].normal.cross(n).norm() < parallel_sine)
        found.push_back(p);
  return found;
}
} // namespace

ProductPlane product_plane_rule(const SlipSystems &systems)
{
  return [systems](Network &network, const Vec3 &xi, const Vec3 &b, const Vec3 &point,
                   const std::span<const Vec3> parents) -> PlaneIndex
  {
    const auto k = product_plane(systems, xi, b, planes_with(systems, parents));
    if (!k)
      return {};
    const SlipPlane &plane = systems.planes()[*k];
    return network.planes().find_or_insert(plane.miller, plane.normal, point);
  };
}
} // namespace ddfem
