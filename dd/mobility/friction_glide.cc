#include "dd/mobility/friction_glide.h"

#include "dd/mobility/glide_friction.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace ddfem
{
namespace
{
constexpr double last_ratio = 0.999; // of speed and limit, beyond which the drag goes on linearly

/// v/(1 - (v/c)^2) and its derivative.
Friction with_limit(const double speed, const double limit)
{
  if (limit == 0)
    return {speed, 1};
  const double r = std::min(speed / limit, last_ratio), q = 1 - r * r, slope = (1 + r * r) / (q * q);
  return {r * limit / q + slope * std::max(0.0, speed - last_ratio * limit), slope};
}

Friction dry(const double speed)
{
  const double v0 = FrictionGlide::creep_speed, root = std::hypot(speed, v0);
  return {speed / root, v0 * v0 / (root * root * root)};
}
} // namespace

FrictionGlide::FrictionGlide(MobilityPointer linear, const FrictionSettings &friction_settings)
    : viscous(std::move(linear)), settings(friction_settings)
{
  if (!viscous->is_linear())
    throw std::invalid_argument("friction stress and largest speed complete a linear mobility law only");
  if (!(settings.stress >= 0 && settings.largest_speed >= 0))
    throw std::invalid_argument("friction stress and largest speed must not be negative");
}

Resistance FrictionGlide::resistance(const LineState &line, const Vec3 &velocity) const
{
  const double threshold = settings.stress * line.burgers.norm(), b = viscous->drag(line);
  return resistance_across(
      line, velocity,
      [&](const double speed) -> Friction
      {
        const Friction viscosity = with_limit(speed, settings.largest_speed), still = dry(speed);
        return {threshold * still.force + b * viscosity.force, threshold * still.slope + b * viscosity.slope};
      });
}
} // namespace ddfem
