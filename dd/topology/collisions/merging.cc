#include "dd/topology/collisions/merging.h"

#include "dd/forces/virtual_rays.h"
#include "dd/mobility/glide_constraints.h"
#include "dd/topology/line_operations.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace ddfem
{
namespace
{
using End = MergePlan::End;

/// Pieces of a cut segment are not shorter than this part of the capture radius.
constexpr double shortest_piece = 0.25;

/// How firmly a node is held: the more firmly held one stays where it is when two meet. A new node is free.
enum class Hold
{
  free,
  surface,
  pinned,
};

Hold hold_of(const TopologyContext &c, const End &e)
{
  if (e.is_cut())
    return Hold::free;
  switch (c.network.constraint(e.node))
  {
    case NodeConstraint::pinned: return Hold::pinned;
    case NodeConstraint::surface: return Hold::surface;
    case NodeConstraint::free: break;
  }
  return Hold::free;
}

/// The choices for one point, the preferred one first.
std::vector<End> choices(const TopologyContext &c, const LinePoint &point, const double t)
{
  const Network &n = c.network;
  const SegmentIndex s = point.segment;
  const double u = point.fraction, r = c.settings.collision_radius;
  const Vec3 xs = c.position_at(n.start(s), t), xe = c.position_at(n.end(s), t);
  const Vec3 direction = n.minimum_image(xe - xs);
  const double length = direction.norm();
  const SegmentOrigin o = c.origin(s);
  std::vector<End> found;
  const bool at_start = u <= 0.5;
  const double to_end = std::min(u, 1 - u) * length;
  if (to_end <= r)
    found.push_back(at_start ? End{point, n.start(s), xs, xs, o.start_displacement}
                             : End{point, n.end(s), xe, xe, o.end_displacement});
  if (to_end > shortest_piece * r)
  {
    const Vec3 x = xs + u * direction;
    found.push_back({point, {}, x, x, (1 - u) * o.start_displacement + u * o.end_displacement});
  }
  return found;
}

/// Directions in which a line may not move: the normal of its glide plane, or everything across a line without one.
void append_forbidden(const TopologyContext &c, const SegmentIndex s, const double t, std::vector<Vec3> &directions)
{
  const Network &n = c.network;
  if (n.plane(s).is_valid())
  {
    directions.push_back(n.normal(s));
    return;
  }
  const Vec3 xi = n.minimum_image(c.position_at(n.end(s), t) - c.position_at(n.start(s), t)).normalized();
  const auto across = directions_across(xi);
  directions.insert(directions.end(), across.begin(), across.end());
}

std::vector<Vec3> forbidden_directions(const TopologyContext &c, const End &e, const double t)
{
  std::vector<Vec3> directions;
  if (e.is_cut())
    append_forbidden(c, e.point.segment, t, directions);
  else
    for (const SegmentIndex s : c.network.connected_segments(e.node))
      append_forbidden(c, s, t, directions);
  return directions;
}

/// Point nearest to @p x that lies on the glide planes of all arms of both ends (through the points' own positions: in a
/// periodic cell the plane's offset belongs to another image), and on those without a plane. Empty if there is none within
/// twice the capture radius.
std::optional<Vec3> common_point(const TopologyContext &c, const End &a, const End &b, const Vec3 &xb, const Vec3 &x,
                                 const double t)
{
  const auto of_a = forbidden_directions(c, a, t), of_b = forbidden_directions(c, b, t);
  Eigen::Matrix<double, Eigen::Dynamic, 3> normals(static_cast<Eigen::Index>(of_a.size() + of_b.size()), 3);
  Eigen::VectorXd offsets(normals.rows());
  Eigen::Index row = 0;
  for (const auto &[list, position] : {std::pair(&of_a, &a.position), std::pair(&of_b, &xb)})
    for (const Vec3 &normal : *list)
    {
      normals.row(row) = normal.transpose();
      offsets[row++] = normal.dot(*position - x);
    }
  const Vec3 dx = normals.completeOrthogonalDecomposition().solve(offsets);
  const double r = c.settings.collision_radius;
  if ((normals * dx - offsets).cwiseAbs().maxCoeff() > 1e-6 * r || dx.norm() > 2 * r)
    return std::nullopt;
  return x + dx;
}

bool may_merge(const TopologyContext &c, const End &firm, const End &other)
{
  if (!firm.is_cut() && firm.node == other.node)
    return false;
  const Hold a = hold_of(c, firm), b = hold_of(c, other);
  if (a == Hold::surface && b == Hold::surface)
    return (ray_burgers(c.network, firm.node) + ray_burgers(c.network, other.node)).norm() < 1e-9;
  // A line that comes near the end of another at the surface reaches the surface by itself; two held nodes stay apart.
  return a == Hold::free || (a == Hold::pinned && b == Hold::free);
}

/// Where two surface nodes become one, near the point @p x that is on the planes of both: between two times of the step they move
/// along chords of the surface, thus it is on the surface only if it goes there, in the directions that both planes leave.
std::optional<Vec3> point_on_surface(const TopologyContext &c, const End &a, const End &b, const Vec3 &x)
{
  std::vector<ArmConstraint> arms;
  for (const NodeIndex i : {a.node, b.node})
    for (const SegmentIndex s : c.network.connected_segments(i))
      arms.push_back(arm_constraint(c.network, s));
  auto y = project_to_surface_within(*c.shape, x, free_directions(arms));
  if (y && (*y - x).norm() > 2 * c.settings.collision_radius)
    y.reset(); // they meet the surface elsewhere
  return y;
}

std::optional<MergePlan> plan_for(const TopologyContext &c, End a, End b, const double t)
{
  if (hold_of(c, b) > hold_of(c, a))
    std::swap(a, b);
  if (!may_merge(c, a, b))
    return std::nullopt;
  const bool held = hold_of(c, a) != Hold::free;
  const Vec3 xb = a.position + c.network.minimum_image(b.position - a.position);
  const auto x = common_point(c, a, b, xb, held ? a.position : Vec3(0.5 * (a.position + xb)), t);
  if (!x || (held && (*x - a.position).norm() > 1e-6 * c.settings.collision_radius))
    return std::nullopt;
  a.target = held ? a.position : *x;
  if (hold_of(c, b) == Hold::surface)
  {
    const auto y = point_on_surface(c, a, b, a.target);
    if (!y)
      return std::nullopt;
    a.target = *y;
  }
  b.target = b.position + (a.target - xb);
  if (c.shape && !held && c.shape->signed_distance(a.target) > 0)
    return std::nullopt; // the line leaves the grain before
  return MergePlan{{a, b}, t};
}

NodeIndex node_of(TopologyContext &c, const End &e)
{
  if (!e.is_cut())
    return e.node;
  const Network &n = c.network;
  const SegmentIndex s = e.point.segment;
  return split_segment(c, s, n.position(n.start(s)) + e.point.fraction * n.direction(s), Vec3::Zero());
}
} // namespace

std::optional<MergePlan> plan_merge(const TopologyContext &context, const LinePoint &first, const LinePoint &second,
                                    const double t)
{
  const auto of_first = choices(context, first, t), of_second = choices(context, second, t);
  const bool one_segment = first.segment == second.segment;
  for (const End &a : of_first)
    for (const End &b : of_second)
    {
      if (one_segment && (a.is_cut() || b.is_cut()))
        continue;
      if (auto plan = plan_for(context, a, b, t))
        return plan;
    }
  return std::nullopt;
}

NodeIndex perform_merge(TopologyContext &context, const MergePlan &plan)
{
  Network &n = context.network;
  const NodeIndex kept = node_of(context, plan.ends[0]);
  const NodeIndex gone = node_of(context, plan.ends[1]);
  const bool both_on_surface =
      n.constraint(kept) == NodeConstraint::surface && n.constraint(gone) == NodeConstraint::surface;
  move_node(context, kept, plan.ends[0].target);
  move_node(context, gone, plan.ends[1].target);
  for (const NodeIndex i : {kept, gone})
  {
    context.remaining[i.value].setZero();
    context.set_time(i, plan.time);
  }
  merge_nodes(context, kept, gone);
  if (n.contains(kept) && both_on_surface)
    n.set_constraint(kept, NodeConstraint::free);
  return kept;
}
} // namespace ddfem
