// When and where two moving straight segments come within a given distance of each other.
#pragma once

#include "dd/common/types.h"

#include <optional>

namespace ddfem
{
/// A straight segment whose ends move at constant velocity. At time t the ends are at start + t start_velocity and
/// end + t end_velocity (nm; time in parts of the step, so that a velocity is a displacement per step).
struct MovingSegment
{
  Vec3 start, end;
  Vec3 start_velocity, end_velocity;

  Vec3 start_at(double t) const { return start + t * start_velocity; }
  Vec3 end_at(double t) const { return end + t * end_velocity; }
};

/// First contact of two segments.
struct Contact
{
  double time;          ///< of the first contact
  double first, second; ///< nearest points at that time, as fractions of the two segments in [0, 1]
  double distance;      ///< between these points, nm
  double closest_time;  ///< end of the approach: where the distance has its first local minimum at or after `time`, to
                        ///< 1e-7 of the interval; t1 if it falls until then. Minima that follow each other while ends
                        ///< move by less than a quarter of the radius may be taken for one
};

/// A contact is the earliest time in [t0, t1] at which the distance d of the two segments falls to the reach R, where
///   R = (1 + contact_margin) radius             if d(t0) is more than that,
///   R = (1 - contact_margin) d(t0)              if the two are within it at t0 already: they must come nearer;
///   contact at t0 at once                       if d(t0) < touching_fraction * radius: they touch.
/// The margin covers the rounding of the polynomial roots from which the times come: no approach below R / (1 +
/// contact_margin), which is `radius` in the first case, is missed, and the distance at a contact is never above R.
/// This holds for segments and displacements up to some 1e5 R; contact.cc has the argument. The radius must be
/// positive.
inline constexpr double contact_margin = 1e-3;
inline constexpr double touching_fraction = 1e-6;

/// Segments without a common node. Empty if there is no contact.
std::optional<Contact> first_contact(const MovingSegment &a, const MovingSegment &b, double radius, double t0,
                                     double t1);

/// Two arms of one node, both of which start at it (same start and start_velocity), that close like scissors: d is the
/// distance of the end of one arm from the other arm, the smaller of the two, and counts only while the arms make an
/// acute angle. Arms that turn from obtuse to acute within the interval are taken as if it began there: d, then the
/// length of the shorter arm, must fall from above R, or by contact_margin if it is within R already. closest_time is
/// where the angle stops being acute if d still falls there.
std::optional<Contact> first_hinge_contact(const MovingSegment &a, const MovingSegment &b, double radius, double t0,
                                           double t1);

/// A segment that shrinks to nothing: d is its length. `first` and `second` are 0 and 1, its ends.
std::optional<Contact> first_collapse(const MovingSegment &a, double radius, double t0, double t1);
} // namespace ddfem
