#include "dd/topology/line_operations.h"

#include <algorithm>
#include <array>
#include <vector>

namespace ddfem
{
namespace
{
std::vector<SegmentIndex> copy_of_arms(const Network &network, const NodeIndex i)
{
  const auto arms = network.connected_segments(i);
  return {arms.begin(), arms.end()};
}

SegmentOrigin reversed(const SegmentOrigin &o)
{
  return {o.lineage, o.end_displacement, o.start_displacement};
}

/// The origin of @p s for the line sense that leaves node @p i.
SegmentOrigin origin_from(const TopologyContext &context, const SegmentIndex s, const NodeIndex i)
{
  const SegmentOrigin o = context.origin(s);
  return context.network.start(s) == i ? o : reversed(o);
}

/// Two lines that have become one.
SegmentOrigin combined(const SegmentOrigin &o, const SegmentOrigin &p)
{
  return {std::min(o.lineage, p.lineage), 0.5 * (o.start_displacement + p.start_displacement),
          0.5 * (o.end_displacement + p.end_displacement)};
}

/// Joins a -> c with Burgers vector b. If a segment joins the two already the Burgers vectors add up: opposite ones
/// annihilate, others make a product line whose plane is looked up.
void join(TopologyContext &context, const NodeIndex a, const NodeIndex c, const Vec3 &b, const PlaneIndex plane,
          const SegmentOrigin &origin)
{
  Network &network = context.network;
  const auto existing = network.find(a, c);
  if (!existing)
  {
    context.insert_segment(Segment{a, c, b, plane}, origin);
    return;
  }
  const Vec3 sum = network.burgers_from(*existing, a) + b;
  const PlaneIndex old_plane = network.plane(*existing);
  const auto normal = [&](const PlaneIndex p)
  { return p.is_valid() ? network.planes()[p].normal : Vec3(Vec3::Zero()); };
  const std::array<Vec3, 2> parents{normal(plane), normal(old_plane)};
  const SegmentOrigin both = combined(origin, origin_from(context, *existing, a));
  network.erase(*existing);
  if (sum.norm() < 1e-6 * b.norm())
  {
    ++context.counts.annihilations;
    return;
  }
  PlaneIndex product = plane;
  const bool same_plane = plane.is_valid() && old_plane.is_valid() && network.planes().parallel(plane, old_plane);
  if (!same_plane && !(plane == old_plane))
  {
    const Vec3 xi = network.minimum_image(network.position(c) - network.position(a)).normalized();
    product = context.product_plane(network, xi, sum, network.position(a), parents);
  }
  context.insert_segment(Segment{a, c, sum, product}, both);
}
} // namespace

void erase_if_orphan(Network &network, const NodeIndex i)
{
  if (network.contains(i) && network.degree(i) == 0 && network.constraint(i) != NodeConstraint::pinned)
    network.erase(i);
}

bool is_discretisation_node(const Network &network, const NodeIndex i)
{
  return network.constraint(i) == NodeConstraint::free && !network.is_physical(i);
}

NodeIndex split_segment(TopologyContext &context, const SegmentIndex s, const Vec3 &x, const Vec3 &displacement)
{
  Network &network = context.network;
  const Segment old = network.get(s);
  const SegmentOrigin origin = context.origin(s);
  const double u = network.minimum_image(x - network.position(old.start)).norm() / network.length(s);
  const Vec3 here = (1 - u) * origin.start_displacement + u * origin.end_displacement;
  const NodeIndex m = context.insert_node(Node{x, NodeConstraint::free}, displacement);
  network.erase(s);
  context.insert_segment(Segment{old.start, m, old.burgers, old.plane},
                         {origin.lineage, origin.start_displacement, here});
  context.insert_segment(Segment{m, old.end, old.burgers, old.plane}, {origin.lineage, here, origin.end_displacement});
  return m;
}

void move_node(TopologyContext &context, const NodeIndex i, const Vec3 &x)
{
  Network &network = context.network;
  const Vec3 old = network.position(i);
  if (old == x)
    return;
  PlaneIndex plane;
  for (const SegmentIndex s : network.connected_segments(i))
  {
    // The line from the other end q: q -> old becomes q -> x.
    const NodeIndex q = network.other_end(s, i);
    const Vec3 xq = old + network.minimum_image(network.position(q) - old);
    plane = network.plane(s);
    context.swept.add_triangle(xq, x, old, -network.burgers_from(s, i), plane);
  }
  if (network.constraint(i) == NodeConstraint::surface && context.shape)
    context.swept.add_ray_motion(old, ray_direction(*context.shape, context.ray_direction, old), x,
                                 ray_direction(*context.shape, context.ray_direction, x), ray_burgers(network, i),
                                 plane);
  network.set_position(i, x);
}

void merge_nodes(TopologyContext &context, const NodeIndex kept, const NodeIndex gone)
{
  Network &network = context.network;
  for (const SegmentIndex s : copy_of_arms(network, gone))
  {
    const Vec3 b = network.burgers_from(s, gone);
    const PlaneIndex plane = network.plane(s);
    const NodeIndex other = network.other_end(s, gone);
    const SegmentOrigin origin = origin_from(context, s, gone);
    network.erase(s);
    if (other != kept) // a segment between the two has shrunk to nothing
      join(context, kept, other, b, plane, origin);
    if (other != kept && network.degree(other) == 0)
      erase_if_orphan(network, other);
  }
  network.erase(gone);
  erase_if_orphan(network, kept);
}

NodeIndex detach_arms(TopologyContext &context, const NodeIndex i, std::span<const SegmentIndex> arms,
                      const NodeConstraint constraint)
{
  Network &network = context.network;
  const NodeIndex n = context.insert_node(Node{network.position(i), constraint}, context.remaining[i.value]);
  for (const SegmentIndex s : std::vector<SegmentIndex>(arms.begin(), arms.end()))
  {
    Segment moved = network.get(s);
    const SegmentOrigin origin = context.origin(s);
    (moved.start == i ? moved.start : moved.end) = n;
    network.erase(s);
    context.insert_segment(moved, origin);
  }
  return n;
}

void remove_node(TopologyContext &context, const NodeIndex i)
{
  Network &network = context.network;
  const auto arms = copy_of_arms(network, i);
  const NodeIndex a = network.other_end(arms[0], i);
  const NodeIndex c = network.other_end(arms[1], i);
  const Vec3 b = network.burgers_from(arms[0], a); // line sense a -> i -> c
  const PlaneIndex plane = network.plane(arms[0]);
  const Vec3 x = network.position(i);
  const Vec3 xa = x + network.minimum_image(network.position(a) - x);
  const Vec3 xc = x + network.minimum_image(network.position(c) - x);
  context.swept.add_triangle(xa, xc, x, b, plane);
  const SegmentOrigin origin{context.origin(arms[0]).lineage, origin_from(context, arms[0], a).start_displacement,
                             origin_from(context, arms[1], i).end_displacement};
  network.erase(arms[0]);
  network.erase(arms[1]);
  network.erase(i);
  if (a != c)
    join(context, a, c, b, plane, origin);
  erase_if_orphan(network, a);
  erase_if_orphan(network, c);
}
} // namespace ddfem
