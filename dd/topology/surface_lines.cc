#include "dd/topology/surface_lines.h"

#include "dd/topology/line_operations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace ddfem
{
std::optional<Vec3> edge_between(const GrainShape &shape, const Vec3 &p, const Vec3 &q, const Vec3 &normal)
{
  const Vec3 n_p = shape.outward_normal(p), n_q = shape.outward_normal(q);
  constexpr double smooth_cosine = 0.9;
  if (normal.isZero(0) || (shape.face(p) == shape.face(q) && n_p.dot(n_q) > smooth_cosine))
    return std::nullopt;
  Mat3 rows;
  rows << normal.transpose(), n_p.transpose(), n_q.transpose();
  if (std::abs(rows.determinant()) < 1e-6)
    return std::nullopt;
  const Vec3 x = rows.inverse() * Vec3(normal.dot(p), rows.row(1).dot(p), rows.row(2).dot(q));
  if ((x - p).norm() > 10 * (q - p).norm())
    return std::nullopt;                       // the faces meet elsewhere
  return project_to_surface(shape, x, normal); // exact already where both faces are flat
}

namespace
{
/// A line whose middle is nearer to the surface than this part of its length lies in the surface, or outside.
constexpr double flatness = 0.1;

/// Nearest point on the surface within the plane, or @p x itself if the plane does not meet it there.
Vec3 onto_surface(const GrainShape &shape, const Vec3 &x, const Vec3 &normal)
{
  return project_to_surface(shape, x, normal).value_or(x);
}
/// The point of a segment that is farthest outside, of a few looked at.
struct Outermost
{
  double fraction = 0, distance = 0;
};

Outermost outermost_point(const GrainShape &shape, const Vec3 &p, const Vec3 &d)
{
  Outermost best;
  constexpr int n_looks = 6;
  for (int k = 1; k < n_looks; ++k)
  {
    const double t = static_cast<double>(k) / n_looks;
    if (const double distance = shape.signed_distance(p + t * d); distance > best.distance)
      best = {t, distance};
  }
  return best;
}

/// The node where segment @p s, which starts or ends at @p from inside or on the surface, passes through the surface on the way to
/// @p outside: made there, unless it is @p from.
NodeIndex passage(TopologyContext &context, const NodeIndex from, const SegmentIndex s, const Vec3 &outside)
{
  const Network &network = context.network;
  const Vec3 x = network.position(from);
  if (network.constraint(from) == NodeConstraint::surface)
    return from;
  const Vec3 crossing = surface_crossing(*context.shape, x, outside);
  const double shortest = 1e-2 * context.settings.collision_radius;
  if ((crossing - x).norm() < shortest)
    return from;
  return split_segment(context, s, crossing, Vec3::Zero());
}

/// Books what a segment between two surface points sweeps as it leaves, and erases it; its nodes stay.
void erase_through_surface(TopologyContext &context, const SegmentIndex s)
{
  Network &network = context.network;
  const GrainShape &shape = *context.shape;
  const Segment old = network.get(s);
  const Vec3 p = network.position(old.start), q = network.position(old.end), normal = network.normal(s);
  // The curve in which plane and surface intersect, by repeated halving.
  std::vector<Vec3> path{p, q};
  if (const auto edge = edge_between(shape, p, q, normal))
    path.insert(path.begin() + 1, *edge);
  for (int level = 0; level < 3; ++level)
  {
    std::vector<Vec3> finer{path.front()};
    for (std::size_t k = 0; k + 1 < path.size(); ++k)
    {
      finer.push_back(onto_surface(shape, 0.5 * (path[k] + path[k + 1]), normal));
      finer.push_back(path[k + 1]);
    }
    path = std::move(finer);
  }
  for (std::size_t k = 1; k + 1 < path.size(); ++k)
    context.swept.add_triangle(p, path[k], path[k + 1], old.burgers, old.plane);
  const auto direction = [&](const Vec3 &x) { return ray_direction(shape, context.ray_direction, x); };
  for (std::size_t k = 0; k + 1 < path.size(); ++k)
    context.swept.add_opening(path[k], direction(path[k]), path[k + 1], direction(path[k + 1]), old.burgers, old.plane);
  network.erase(s);
}

/// Lets the part of segment @p s about the point @p outside leave the grain, which it does not touch; whether that is possible.
bool cut_out(TopologyContext &context, const SegmentIndex s, const Vec3 &outside)
{
  Network &network = context.network;
  const NodeIndex start = network.start(s), end = network.end(s);
  const NodeIndex first = passage(context, start, s, outside);
  const NodeIndex second = passage(context, end, *network.find(first, end), outside);
  if (network.constraint(first) == NodeConstraint::pinned || network.constraint(second) == NodeConstraint::pinned)
    return false; // a line that is held at the surface does not leave there
  for (const NodeIndex i : {first, second})
    move_node(context, i, onto_surface(*context.shape, network.position(i), common_normal(network, i)));
  erase_through_surface(context, *network.find(first, second));
  for (const NodeIndex i : {first, second})
    if (network.degree(i) == 0)
      erase_if_orphan(network, i);
    else if (network.constraint(i) == NodeConstraint::free)
      exit_through_surface(context, i);
  return true;
}

/// Lets a line bend around the part of an impenetrable face that it has passed through.
void bend_around(TopologyContext &context, const SegmentIndex s, const Vec3 &outside)
{
  const Network &network = context.network;
  const auto x = project_to_surface(*context.shape, outside, network.normal(s));
  const double shortest = 0.25 * context.settings.collision_radius;
  if (x && (*x - network.position(network.start(s))).norm() > shortest &&
      (*x - network.position(network.end(s))).norm() > shortest)
    move_node(context, split_segment(context, s, outside, Vec3::Zero()), *x);
}

/// Lines of a re-entrant grain whose ends are inside but which pass through an edge on their way.
void cut_protruding_lines(TopologyContext &context)
{
  Network &network = context.network;
  const GrainShape &shape = *context.shape;
  std::vector<SegmentIndex> segments(network.segments().begin(), network.segments().end());
  constexpr int most_passes = 10; // a piece may pass through another edge
  constexpr double least = 0.1;   // in collision radii: less would leave pieces without length
  for (int pass = 0; pass < most_passes && !segments.empty(); ++pass)
  {
    const auto known = static_cast<std::uint32_t>(network.segment_capacity());
    for (const SegmentIndex s : segments)
    {
      if (!network.contains(s))
        continue;
      const Vec3 p = network.position(network.start(s)), d = network.direction(s);
      const Outermost top = outermost_point(shape, p, d);
      if (top.distance <= std::max(flatness * d.norm(), least * context.settings.collision_radius))
        continue;
      const Vec3 outside = p + top.fraction * d;
      if (is_impenetrable(shape, outside))
        bend_around(context, s, outside);
      else
        cut_out(context, s, outside);
    }
    segments.clear();
    for (const SegmentIndex s : network.segments())
      if (s.value >= known)
        segments.push_back(s);
  }
}

/// Where a node outside comes back to the surface within its glide plane: the nearest point if it is near, or that on the way to a
/// neighbour inside, but not the neighbour itself: one that lies on the surface counts as inside or outside by rounding.
std::optional<Vec3> way_back(const TopologyContext &context, const NodeIndex i)
{
  const Network &network = context.network;
  const GrainShape &shape = *context.shape;
  const Vec3 x = network.position(i);
  const double distance = shape.signed_distance(x);
  constexpr double near = 4; // times the distance: the plane meets the surface at more than a quarter of a right angle
  auto nearest = project_to_surface(shape, x, common_normal(network, i));
  if (nearest && (*nearest - x).norm() < near * distance)
    return nearest;
  const double shortest_piece = 0.25 * context.settings.collision_radius;
  double shortest_arm = std::numeric_limits<double>::infinity();
  for (const SegmentIndex s : network.connected_segments(i))
  {
    const Vec3 &q = network.position(network.other_end(s, i));
    shortest_arm = std::min(shortest_arm, (q - x).norm());
    if (shape.signed_distance(q) < 0)
      if (const Vec3 y = surface_crossing(shape, q, x); (y - q).norm() > shortest_piece)
        return y;
  }
  return nearest && (*nearest - x).norm() < 0.5 * shortest_arm ? nearest : std::nullopt;
}

/// Nodes of a re-entrant grain that were made on lines which pass through an edge. One without a way back is taken out of its line:
/// its neighbours lie on both sides of a re-entrant edge that is sharper than the line is fine.
void bring_nodes_back(TopologyContext &context)
{
  Network &network = context.network;
  const GrainShape &shape = *context.shape;
  const double tolerance = 1e-9 * shape.diameter();
  const std::vector<NodeIndex> nodes(network.nodes().begin(), network.nodes().end());
  for (const NodeIndex i : nodes)
  {
    if (!network.contains(i) || network.constraint(i) != NodeConstraint::free ||
        shape.signed_distance(network.position(i)) <= tolerance)
      continue;
    if (const auto y = way_back(context, i))
    {
      move_node(context, i, *y);
      if (!is_impenetrable(shape, *y))
        exit_through_surface(context, i);
    }
    else if (is_discretisation_node(network, i))
      remove_node(context, i);
  }
}

/// Nodes that several lines hold in their planes, and that have come to where one of these ends at the surface, leave there.
void release_nodes_at_ends(TopologyContext &context)
{
  Network &network = context.network;
  constexpr double same_place = 10 * GlidePlanes::offset_quantum;
  const std::vector<SegmentIndex> segments(network.segments().begin(), network.segments().end());
  for (const SegmentIndex s : segments)
  {
    if (!network.contains(s) || network.length(s) > same_place)
      continue;
    NodeIndex i = network.start(s), end = network.end(s);
    if (network.constraint(i) == NodeConstraint::surface)
      std::swap(i, end);
    if (network.constraint(i) != NodeConstraint::free || network.constraint(end) != NodeConstraint::surface)
      continue;
    move_node(context, i, network.position(end));
    exit_through_surface(context, i);
  }
}
} // namespace

PlaneIndex common_plane(const Network &network, const NodeIndex i)
{
  PlaneIndex plane;
  for (const SegmentIndex s : network.connected_segments(i))
  {
    if (plane.is_valid() && !(network.plane(s) == plane))
      return {};
    plane = network.plane(s);
  }
  return plane;
}

Vec3 common_normal(const Network &network, const NodeIndex i)
{
  const PlaneIndex plane = common_plane(network, i);
  return plane.is_valid() ? network.planes()[plane].normal : Vec3(Vec3::Zero());
}

bool is_impenetrable(const GrainShape &shape, const Vec3 &x)
{
  return shape.face_kind(shape.face(x)) == FaceKind::impenetrable;
}

void exit_through_surface(TopologyContext &context, const NodeIndex i)
{
  Network &network = context.network;
  ++context.counts.surface_exits;
  context.remaining[i.value].setZero();
  while (network.degree(i) > 1)
  {
    const std::array<SegmentIndex, 1> last{network.connected_segments(i).back()};
    detach_arms(context, i, last, NodeConstraint::surface);
  }
  network.set_constraint(i, NodeConstraint::surface);
}

void leave_through_surface(TopologyContext &context, const SegmentIndex s)
{
  const NodeIndex start = context.network.start(s), end = context.network.end(s);
  erase_through_surface(context, s);
  erase_if_orphan(context.network, start);
  erase_if_orphan(context.network, end);
}

void settle_at_surface(TopologyContext &context)
{
  if (!context.shape->is_convex())
  {
    cut_protruding_lines(context);
    bring_nodes_back(context);
  }
  release_nodes_at_ends(context);
  remove_surface_segments(context);
}

void remove_surface_segments(TopologyContext &context)
{
  Network &network = context.network;
  const std::vector<SegmentIndex> segments(network.segments().begin(), network.segments().end());
  for (const SegmentIndex s : segments)
  {
    const NodeIndex i = network.start(s), j = network.end(s);
    if (network.constraint(i) != NodeConstraint::surface || network.constraint(j) != NodeConstraint::surface)
      continue;
    const Vec3 middle = 0.5 * (network.position(i) + network.position(j));
    // Both ends of a line along its own direction of motion leave at one point: then nothing is left of it.
    const double rounding = 1e-9 * context.shape->diameter();
    if (-context.shape->signed_distance(middle) < flatness * network.length(s) + rounding)
      leave_through_surface(context, s);
  }
}
} // namespace ddfem
