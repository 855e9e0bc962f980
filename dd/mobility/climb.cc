#include "dd/mobility/climb.h"

#include <stdexcept>
#include <utility>

namespace ddfem
{
Climb::Climb(MobilityPointer glide_law, const double climb_drag) : glide(std::move(glide_law)), coefficient(climb_drag)
{
  if (!(coefficient > 0))
    throw std::invalid_argument("the climb drag must be positive");
}

ArmConstraint Climb::constraint(const LineState &line) const
{
  ArmConstraint c = glide->constraint(line);
  c.climbs = c.is_sessile();
  return c;
}

Resistance Climb::resistance(const LineState &line, const Vec3 &velocity) const
{
  if (!constraint(line).climbs)
    return glide->resistance(line, velocity);
  const Mat3 slope = coefficient * (Mat3::Identity() - line.direction * line.direction.transpose());
  return {slope * velocity, slope};
}

double Climb::drag(const LineState &line) const
{
  return constraint(line).climbs ? coefficient : glide->drag(line);
}
} // namespace ddfem
