#include "dd/topology/collisions/proximity_collisions.h"

#include "dd/elasticity/distance.h"
#include "dd/topology/collisions/common_node.h"
#include "dd/topology/collisions/merging.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace ddfem
{
namespace
{
struct NearPoints
{
  double s, t;     ///< parameters of the nearest points on the two segments, in [0, 1]
  Vec3 separation; ///< from the first point to the second, nm
};

Vec3 displacement_at(const TopologyContext &c, const SegmentIndex s, const double parameter)
{
  const Network &n = c.network;
  return (1 - parameter) * c.remaining[n.start(s).value] + parameter * c.remaining[n.end(s).value];
}

/// Nearest points of two segments without a common node, if they are within @p r.
std::optional<NearPoints> find_near(const TopologyContext &c, const SegmentIndex s1, const SegmentIndex s2,
                                    const double r)
{
  const Network &n = c.network;
  const Vec3 a1 = n.position(n.start(s1)), t1 = n.direction(s1), t2 = n.direction(s2);
  const Vec3 middle1 = a1 + 0.5 * t1;
  const Vec3 middle2 = middle1 + n.minimum_image(n.position(n.start(s2)) + 0.5 * t2 - middle1);
  if ((middle2 - middle1).norm() > 0.5 * (t1.norm() + t2.norm()) + r)
    return std::nullopt;
  const Vec3 a2 = middle2 - 0.5 * t2;
  const PairDistance d = distance_segment_segment(a1, a1 + t1, a2, a2 + t2);
  if (d.squared > r * r)
    return std::nullopt;
  return NearPoints{d.first, d.second, a2 + d.second * t2 - a1 - d.first * t1};
}

/// Two arms of node o that close like scissors: the end of the shorter and the nearest point of the longer, if within @p r.
std::optional<NearPoints> find_near_hinge(const TopologyContext &c, const SegmentIndex s1, const SegmentIndex s2,
                                          const NodeIndex o, const double r)
{
  const Network &n = c.network;
  const Vec3 t1 = (n.start(s1) == o ? 1.0 : -1.0) * n.direction(s1);
  const Vec3 t2 = (n.start(s2) == o ? 1.0 : -1.0) * n.direction(s2);
  if (t1.dot(t2) <= 0)
    return std::nullopt;
  const bool first_is_shorter = t1.norm() <= t2.norm();
  const Vec3 &shorter = first_is_shorter ? t1 : t2, &longer = first_is_shorter ? t2 : t1;
  const double u = std::clamp(shorter.dot(longer) / longer.squaredNorm(), 0.0, 1.0);
  const Vec3 separation = u * longer - shorter; // from the end of the shorter arm to the longer
  if (separation.norm() > r)
    return std::nullopt;
  const auto from_o = [&](const SegmentIndex s, const double v) { return n.start(s) == o ? v : 1 - v; };
  return NearPoints{from_o(s1, first_is_shorter ? 1.0 : u), from_o(s2, first_is_shorter ? u : 1.0),
                    first_is_shorter ? separation : Vec3(-separation)};
}

/// Nearest points of two different segments within @p r, with or without a common node.
std::optional<NearPoints> find_pair(const TopologyContext &c, const SegmentIndex s1, const SegmentIndex s2,
                                    const double r)
{
  const auto shared = common_node(c.network, s1, s2);
  return shared ? find_near_hinge(c, s1, s2, *shared, r) : find_near(c, s1, s2, r);
}

/// Whether the two points touch, or approach each other in this step.
bool is_closing(const TopologyContext &c, const SegmentIndex s1, const SegmentIndex s2, const NearPoints &contact)
{
  const Vec3 relative = displacement_at(c, s2, contact.t) - displacement_at(c, s1, contact.s);
  return contact.separation.norm() < 1e-9 || relative.dot(contact.separation) < 0;
}

/// Whether any two lines are within @p r, so that they might meet.
bool any_within(const TopologyContext &c, const double r)
{
  const auto segments = c.network.segments();
  for (std::size_t k = 0; k < segments.size(); ++k)
    for (std::size_t m = k + 1; m < segments.size(); ++m)
      if (find_pair(c, segments[k], segments[m], r))
        return true;
  return false;
}

/// One pass over all pairs present at its start; returns the number of merged pairs.
std::size_t collide_once(TopologyContext &context)
{
  Network &n = context.network;
  std::vector<SegmentIndex> segments(n.segments().begin(), n.segments().end());
  std::sort(segments.begin(), segments.end(),
            [&](const SegmentIndex a, const SegmentIndex b) { return n.id(a) < n.id(b); });
  std::size_t events = 0;
  for (std::size_t k = 0; k < segments.size(); ++k)
    for (std::size_t m = k + 1; m < segments.size(); ++m)
    {
      const SegmentIndex s1 = segments[k], s2 = segments[m];
      if (!n.contains(s1))
        break;
      if (!n.contains(s2))
        continue;
      const auto contact = find_pair(context, s1, s2, context.settings.collision_radius);
      if (!contact || !is_closing(context, s1, s2, *contact))
        continue;
      if (const auto plan = plan_merge(context, {s1, contact->s}, {s2, contact->t}, 0))
      {
        perform_merge(context, *plan);
        ++context.counts.collisions;
        ++events;
      }
    }
  return events;
}
} // namespace

unsigned motion_substeps(const TopologyContext &context)
{
  double largest = 0;
  for (const NodeIndex i : context.network.nodes())
    largest = std::max(largest, context.remaining[i.value].norm());
  const double radius = context.settings.collision_radius;
  if (!any_within(context, radius + 2 * largest))
    return 1;
  return std::max(1U, static_cast<unsigned>(std::ceil(2 * largest / radius)));
}

void collide(TopologyContext &context)
{
  // Merging replaces segments; the new ones are looked at in the next pass. A merged node has stopped, so that a pair of
  // merged nodes no longer approaches: the passes come to an end. The bound only guards against rounding.
  const std::size_t max_passes = context.network.n_segments() + 1;
  for (std::size_t pass = 0; pass < max_passes && collide_once(context) > 0; ++pass)
  {
  }
}
} // namespace ddfem
