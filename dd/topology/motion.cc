#include "dd/topology/motion.h"

#include "dd/topology/line_operations.h"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace ddfem
{
namespace
{
/// The common glide plane of all arms; invalid if they differ or have none.
PlaneIndex single_plane(const Network &network, const NodeIndex i)
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

/// Removes the rounding that would let a node drift off its glide plane. In a periodic cell the planes of a line that
/// crosses the boundary differ by an image, and only directions count.
Vec3 keep_on_plane(const Network &network, const NodeIndex i, const Vec3 &x)
{
  const PlaneIndex plane = single_plane(network, i);
  if (!plane.is_valid() || !network.period().isZero())
    return x;
  const GlidePlane &p = network.planes()[plane];
  return x - (p.normal.dot(x) - p.offset) * p.normal;
}

Vec3 plane_normal_or_zero(const Network &network, const NodeIndex i)
{
  const PlaneIndex plane = single_plane(network, i);
  return plane.is_valid() ? network.planes()[plane].normal : Vec3(Vec3::Zero());
}

bool is_impenetrable(const GrainShape &shape, const Vec3 &x)
{
  return shape.face_kind(shape.face(x)) == FaceKind::impenetrable;
}

/// Where a surface node that heads for @p target slides to; empty if an impenetrable face is in its way.
std::optional<Vec3> sliding_target(const TopologyContext &context, const NodeIndex i, const Vec3 &target)
{
  const auto x = project_to_surface(*context.shape, target, plane_normal_or_zero(context.network, i));
  return x && !is_impenetrable(*context.shape, *x) ? x : std::nullopt;
}

/// Where the way along the surface from @p p to @p q in a glide plane turns from one face to another; empty on one face.
std::optional<Vec3> edge_between(const GrainShape &shape, const Vec3 &p, const Vec3 &q, const Vec3 &normal)
{
  if (normal.isZero(0) || shape.face(p) == shape.face(q))
    return std::nullopt;
  Mat3 rows;
  rows << normal.transpose(), shape.outward_normal(p).transpose(), shape.outward_normal(q).transpose();
  if (std::abs(rows.determinant()) < 1e-6)
    return std::nullopt;
  const Vec3 x = rows.inverse() * Vec3(normal.dot(p), rows.row(1).dot(p), rows.row(2).dot(q));
  if ((x - p).norm() > 10 * (q - p).norm())
    return std::nullopt;                       // the faces meet elsewhere
  return project_to_surface(shape, x, normal); // exact already where both faces are flat
}

/// Moves a surface node along the surface: over an edge in two parts, so that the corner counts as swept.
void slide_surface_node(TopologyContext &context, const NodeIndex i, const Vec3 &target)
{
  const auto x = sliding_target(context, i, target);
  if (!x)
  {
    context.remaining[i.value].setZero();
    return;
  }
  const Vec3 normal = plane_normal_or_zero(context.network, i);
  if (const auto edge = edge_between(*context.shape, context.network.position(i), *x, normal))
    move_node(context, i, *edge);
  move_node(context, i, *x);
}

/// Where an interior node stops that heads for @p target, outside the grain, and meets an impenetrable face at @p crossing: a
/// node on one glide plane slides along the face, one on several has only its straight way.
Vec3 stopping_point(const TopologyContext &context, const NodeIndex i, const Vec3 &target, const Vec3 &crossing)
{
  const Vec3 normal = plane_normal_or_zero(context.network, i);
  return normal.isZero(0) ? crossing : project_to_surface(*context.shape, target, normal).value_or(crossing);
}

/// Cuts the line at node @p i, which has just reached a free face.
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

void move_interior_node(TopologyContext &context, const NodeIndex i, const Vec3 &target)
{
  const GrainShape &shape = *context.shape;
  if (shape.signed_distance(target) <= 0)
  {
    move_node(context, i, target);
    return;
  }
  const Vec3 crossing = surface_crossing(shape, context.network.position(i), target);
  if (is_impenetrable(shape, crossing))
  {
    move_node(context, i, stopping_point(context, i, target, crossing));
    return;
  }
  move_node(context, i, crossing);
  exit_through_surface(context, i);
}

/// Nearest point on the surface within the plane, or @p x itself if the plane does not meet it there.
Vec3 onto_surface(const GrainShape &shape, const Vec3 &x, const Vec3 &normal)
{
  return project_to_surface(shape, x, normal).value_or(x);
}
} // namespace

void bend_displacements_along_surface(TopologyContext &context)
{
  if (!context.shape)
    return;
  const Network &network = context.network;
  for (const NodeIndex i : network.nodes())
  {
    Vec3 &dx = context.remaining[i.value];
    if (dx.isZero(0))
      continue;
    const Vec3 x = network.position(i), target = x + dx;
    if (network.constraint(i) == NodeConstraint::surface)
      dx = sliding_target(context, i, target).value_or(x) - x;
    else if (context.shape->signed_distance(target) > 0)
      if (const Vec3 crossing = surface_crossing(*context.shape, x, target); is_impenetrable(*context.shape, crossing))
        dx = stopping_point(context, i, target, crossing) - x;
  }
}

void move_nodes(TopologyContext &context, const double fraction)
{
  Network &network = context.network;
  const std::vector<NodeIndex> nodes(network.nodes().begin(), network.nodes().end());
  for (const NodeIndex i : nodes)
  {
    const Vec3 dx = fraction * context.remaining[i.value];
    if (dx.isZero(0))
      continue;
    const Vec3 target = keep_on_plane(network, i, network.position(i) + dx);
    if (!context.shape)
      move_node(context, i, target);
    else if (network.constraint(i) == NodeConstraint::surface)
      slide_surface_node(context, i, target);
    else
      move_interior_node(context, i, target);
  }
  if (context.shape)
    remove_surface_segments(context);
}

void leave_through_surface(TopologyContext &context, const SegmentIndex s)
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
  erase_if_orphan(network, old.start);
  erase_if_orphan(network, old.end);
}

void remove_surface_segments(TopologyContext &context)
{
  Network &network = context.network;
  constexpr double flatness = 0.1;
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
