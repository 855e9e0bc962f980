// Resistance of a line that glides against a friction which depends on its speed.
#pragma once

#include "dd/mobility/mobility_law.h"

namespace ddfem
{
/// Friction per length at a speed, and how it grows.
struct Friction
{
  double force = 0; ///< MPa nm
  double slope = 0; ///< MPa ns
};

/// The resistance to @p velocity: @p friction(speed), a Friction for the speed across the line, nm/ns, against that part of the velocity.
template <class F> Resistance resistance_across(const LineState &line, const Vec3 &velocity, F &&friction)
{
  const Mat3 across = Mat3::Identity() - line.direction * line.direction.transpose();
  const Vec3 v = across * velocity;
  const double speed = v.norm();
  const Friction f = friction(speed);
  if (speed == 0)
    return {Vec3::Zero(), f.slope * across};
  const Vec3 u = v / speed;
  return {f.force * u, f.force / speed * (across - u * u.transpose()) + f.slope * u * u.transpose()};
}
} // namespace ddfem
