#include "dd/crystal/product_plane.h"

#include <algorithm>
#include <cmath>

namespace ddfem
{
std::optional<std::size_t> product_plane(const SlipSystems &systems, const Vec3 &xi, const Vec3 &burgers,
                                         const std::span<const std::size_t> parents)
{
  constexpr double tolerance = 1e-4; // rad
  std::vector<std::size_t> possible = systems.glissile_planes(burgers);
  std::erase_if(possible,
                [&](const std::size_t p) { return !(std::abs(systems.planes()[p].normal.dot(xi)) < tolerance); });
  for (const std::size_t parent : parents)
    if (std::ranges::find(possible, parent) != possible.end())
      return parent;
  if (possible.empty())
    return {};
  return possible.front();
}
} // namespace ddfem
