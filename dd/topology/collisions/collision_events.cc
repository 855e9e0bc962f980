#include "dd/topology/collisions/collision_events.h"

#include "dd/elasticity/distance.h"
#include "dd/topology/collisions/common_node.h"
#include "dd/topology/collisions/contact.h"

#include <algorithm>
#include <array>

namespace ddfem
{
namespace
{
/// The moving segment with its own straight motion continued back to time 0; @p t: a time at which both nodes exist.
MovingSegment moving_segment(const TopologyContext &c, const NodeIndex start, const NodeIndex end, const double t)
{
  const Vec3 vs = c.velocity(start), ve = c.velocity(end);
  const Vec3 xs = c.position_at(start, t);
  const Vec3 xe = xs + c.network.minimum_image(c.position_at(end, t) - xs);
  return {xs - t * vs, xe - t * ve, vs, ve};
}

/// Two segments without a common node, the second in the periodic image nearest to the first at time @p t.
std::pair<MovingSegment, MovingSegment> moving_pair(const TopologyContext &c, const SegmentIndex a,
                                                    const SegmentIndex b, const double t)
{
  const Network &n = c.network;
  const MovingSegment ma = moving_segment(c, n.start(a), n.end(a), t);
  MovingSegment mb = moving_segment(c, n.start(b), n.end(b), t);
  const Vec3 apart = 0.5 * (mb.start_at(t) + mb.end_at(t) - ma.start_at(t) - ma.end_at(t));
  const Vec3 shift = n.minimum_image(apart) - apart;
  mb.start += shift;
  mb.end += shift;
  return {ma, mb};
}

CollisionEvent make_event(const Network &n, const SegmentIndex a, const SegmentIndex b, const Contact &contact)
{
  return {contact.time, n.id(a), n.id(b), a, b, contact.first, contact.second, contact.closest_time, 0};
}

std::optional<CollisionEvent> detect_hinge(const TopologyContext &c, const SegmentIndex a, const SegmentIndex b,
                                           const NodeIndex o, const double t)
{
  const Network &n = c.network;
  auto contact = first_hinge_contact(moving_segment(c, o, n.other_end(a, o), t),
                                     moving_segment(c, o, n.other_end(b, o), t), c.settings.collision_radius, t, 1);
  if (!contact)
    return std::nullopt;
  if (n.end(a) == o)
    contact->first = 1 - contact->first;
  if (n.end(b) == o)
    contact->second = 1 - contact->second;
  return make_event(n, a, b, *contact);
}

std::optional<CollisionEvent> detect_pair(const TopologyContext &c, const SegmentIndex a, const SegmentIndex b,
                                          const double t)
{
  const Network &n = c.network;
  const auto [ma, mb] = moving_pair(c, a, b, t);
  const auto contact = first_contact(ma, mb, c.settings.collision_radius, t, 1);
  if (!contact)
    return std::nullopt;
  return make_event(n, a, b, *contact);
}

/// Contacts among the arms of one node.
void detect_hinges(const TopologyContext &c, const NodeIndex i, const double t, std::vector<CollisionEvent> &found)
{
  const auto arms = c.network.connected_segments(i);
  for (std::size_t k = 0; k < arms.size(); ++k)
    for (std::size_t m = k + 1; m < arms.size(); ++m)
      if (const auto event = detect(c, arms[k], arms[m], t))
        found.push_back(*event);
}

void detect_collapse(const TopologyContext &c, const SegmentIndex s, const double t, std::vector<CollisionEvent> &found)
{
  if (const auto event = detect(c, s, s, t))
    found.push_back(*event);
}

/// f(k, found) for all k < n, threaded; the results are appended to @p found in the order of events.
template <class F> void collect(const std::size_t n, std::vector<CollisionEvent> &found, F &&f)
{
  constexpr std::size_t worth_a_team = 2000; // waking threads takes as long as hundreds of contacts
#pragma omp parallel if (n > worth_a_team)
  {
    std::vector<CollisionEvent> mine;
#pragma omp for schedule(static) nowait
    for (std::size_t k = 0; k < n; ++k)
      f(k, mine);
#pragma omp critical(ddfem_collect_events)
    found.insert(found.end(), mine.begin(), mine.end());
  }
}
} // namespace

std::optional<CollisionEvent> detect(const TopologyContext &context, SegmentIndex a, SegmentIndex b, double t)
{
  const Network &n = context.network;
  for (const NodeIndex i : {n.start(a), n.end(a), n.start(b), n.end(b)})
    t = std::max(t, context.time_of(i)); // a node has no past before the event that made it
  if (a == b)
  {
    const auto contact =
        first_collapse(moving_segment(context, n.start(a), n.end(a), t), context.settings.collision_radius, t, 1);
    return contact ? std::optional(make_event(n, a, a, *contact)) : std::nullopt;
  }
  if (n.id(b) < n.id(a))
    std::swap(a, b);
  const auto shared = common_node(n, a, b);
  return shared ? detect_hinge(context, a, b, *shared, t) : detect_pair(context, a, b, t);
}

std::pair<double, double> nearest_fractions(const TopologyContext &context, const SegmentIndex a, const SegmentIndex b,
                                            const double t)
{
  const Network &n = context.network;
  if (a == b)
    return {0, 1};
  const auto shared = common_node(n, a, b);
  if (!shared)
  {
    const auto [ma, mb] = moving_pair(context, a, b, t);
    const PairDistance d = distance_segment_segment(ma.start_at(t), ma.end_at(t), mb.start_at(t), mb.end_at(t));
    return {d.first, d.second};
  }
  const auto point = [&](const NodeIndex i) { return context.position_at(i, t); };
  const NodeIndex far_a = n.other_end(a, *shared), far_b = n.other_end(b, *shared);
  const Vec3 o = point(*shared);
  const Vec3 arm_a = n.minimum_image(point(far_a) - o), arm_b = n.minimum_image(point(far_b) - o);
  const auto from_start = [&](const SegmentIndex s, const double u) { return n.start(s) == *shared ? u : 1 - u; };
  const PointDistance on_b = distance_point_segment(arm_a, Vec3::Zero(), arm_b);
  const PointDistance on_a = distance_point_segment(arm_b, Vec3::Zero(), arm_a);
  if (on_b.squared <= on_a.squared)
    return {from_start(a, 1), from_start(b, on_b.parameter)};
  return {from_start(a, on_a.parameter), from_start(b, 1)};
}

std::vector<CollisionEvent> detect_all(const TopologyContext &context, const CandidateList &candidates)
{
  const Network &n = context.network;
  std::vector<CollisionEvent> found;
  const auto pairs = candidates.pairs();
  collect(pairs.size(), found,
          [&](const std::size_t k, std::vector<CollisionEvent> &mine)
          {
            if (const auto event = detect_pair(context, pairs[k].first, pairs[k].second, 0))
              mine.push_back(*event);
          });
  const auto nodes = n.nodes();
  collect(nodes.size(), found,
          [&](const std::size_t k, std::vector<CollisionEvent> &mine) { detect_hinges(context, nodes[k], 0, mine); });
  const auto segments = n.segments();
  collect(segments.size(), found,
          [&](const std::size_t k, std::vector<CollisionEvent> &mine)
          { detect_collapse(context, segments[k], 0, mine); });
  std::sort(found.begin(), found.end());
  return found;
}

SweptBall swept_ball(const TopologyContext &context, const SegmentIndex s, const double t)
{
  const Network &n = context.network;
  const MovingSegment m = moving_segment(context, n.start(s), n.end(s), t);
  const std::array<Vec3, 4> corners{m.start_at(t), m.end_at(t), m.start_at(1), m.end_at(1)};
  const Vec3 centre = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  double squared = 0;
  for (const Vec3 &x : corners)
    squared = std::max(squared, (x - centre).squaredNorm());
  return {centre, std::sqrt(squared)};
}

void detect_around(const TopologyContext &context, const CandidateList &candidates, const NodeIndex i, const double t,
                   std::vector<CollisionEvent> &found)
{
  const Network &n = context.network;
  if (!n.contains(i))
    return;
  const double reach = 1.01 * context.settings.collision_radius; // contact_margin included
  const auto arms = n.connected_segments(i);
  const auto is_arm = [&](const SegmentIndex s) { return n.start(s) == i || n.end(s) == i; };
  std::vector<SegmentIndex> near;
  detect_hinges(context, i, t, found);
  for (const SegmentIndex s : arms)
  {
    detect_collapse(context, s, t, found);
    const SweptBall ball = swept_ball(context, s, t);
    near.clear();
    candidates.neighbours(n, ball.centre, ball.radius, reach, near);
    for (const SegmentIndex other : near)
      if (!is_arm(other) && !common_node(n, s, other))
        if (const auto event = detect(context, s, other, t))
          found.push_back(*event);
    const NodeIndex far = n.other_end(s, i);
    for (const SegmentIndex other : n.connected_segments(far))
      if (other != s && !is_arm(other))
        if (const auto event = detect(context, s, other, t))
          found.push_back(*event);
  }
}
} // namespace ddfem
