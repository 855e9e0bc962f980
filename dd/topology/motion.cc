#include "dd/topology/motion.h"

#include "dd/topology/line_operations.h"
#include "dd/topology/surface_lines.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace ddfem
{
namespace
{
/// Removes the rounding that would let a node drift off its glide plane. In a periodic cell the planes of a line that
/// crosses the boundary differ by an image, and only directions count.
Vec3 keep_on_plane(const Network &network, const NodeIndex i, const Vec3 &x)
{
  const PlaneIndex plane = common_plane(network, i);
  if (!plane.is_valid() || !network.period().isZero())
    return x;
  const GlidePlane &p = network.planes()[plane];
  return x - (p.normal.dot(x) - p.offset) * p.normal;
}

/// Where surface node @p i that heads for @p x stops before the other end of its line, if that is pinned at the surface. Such a line
/// cannot leave, or the Burgers vector that ends there would go nowhere: it becomes no shorter than L_min.
Vec3 clear_of_own_pin(const TopologyContext &context, const NodeIndex i, const Vec3 &x)
{
  const Network &network = context.network;
  if (network.degree(i) != 1)
    return x;
  const NodeIndex other = network.other_end(network.connected_segments(i)[0], i);
  const Vec3 &pin = network.position(other), &old = network.position(i);
  const double depth_at_surface = 0.25 * context.settings.collision_radius, shortest = context.settings.min_segment;
  if (network.constraint(other) != NodeConstraint::pinned || context.shape->signed_distance(pin) < -depth_at_surface)
    return x;
  const double length = (old - pin).norm();
  if ((x - pin).norm() >= std::min(length, shortest))
    return x;
  return length <= shortest ? old : Vec3(pin + shortest / length * (old - pin));
}

/// Where a surface node that heads for @p target slides to; empty if an impenetrable face is in its way.
std::optional<Vec3> sliding_target(const TopologyContext &context, const NodeIndex i, const Vec3 &target)
{
  const Vec3 normal = common_normal(context.network, i);
  auto x = project_to_surface(*context.shape, target, normal);
  if (x)
    if (const Vec3 y = clear_of_own_pin(context, i, *x); y != *x)
      x = project_to_surface(*context.shape, y, normal);
  return x && !is_impenetrable(*context.shape, *x) ? x : std::nullopt;
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
  const Vec3 normal = common_normal(context.network, i);
  if (const auto edge = edge_between(*context.shape, context.network.position(i), *x, normal))
    move_node(context, i, *edge);
  move_node(context, i, *x);
}

/// Where an interior node stops that heads for @p target, outside the grain, and meets an impenetrable face at @p crossing: a
/// node on one glide plane slides along the face, one on several has only its straight way.
Vec3 stopping_point(const TopologyContext &context, const NodeIndex i, const Vec3 &target, const Vec3 &crossing)
{
  const Vec3 normal = common_normal(context.network, i);
  return normal.isZero(0) ? crossing : project_to_surface(*context.shape, target, normal).value_or(crossing);
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
    settle_at_surface(context);
}

} // namespace ddfem
