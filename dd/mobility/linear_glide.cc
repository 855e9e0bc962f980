#include "dd/mobility/linear_glide.h"

namespace ddfem
{
Resistance LinearGlide::resistance(const LineState &line, const Vec3 &velocity) const
{
  const Mat3 slope = drag(line) * (Mat3::Identity() - line.direction * line.direction.transpose());
  return {slope * velocity, slope};
}

MobilityPointer linear_glide(const double edge, const double screw)
{
  return std::make_shared<LinearGlide>(CharacterDrag{edge, screw});
}
} // namespace ddfem
