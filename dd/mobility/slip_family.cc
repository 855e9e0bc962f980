#include "dd/mobility/slip_family.h"

namespace ddfem
{
std::optional<SlipFamily> slip_family(const SlipSystems &systems, const LineState &line)
{
  constexpr double angle_tolerance = 1e-4; // rad
  if (line.normal.isZero(0))
    return {};
  for (std::size_t k = 0; k < systems.planes().size(); ++k)
    if (systems.planes()[k].normal.cross(line.normal).squaredNorm() < angle_tolerance * angle_tolerance)
      return systems.family(line.burgers, k);
  return {};
}
} // namespace ddfem
