#include "dd/topology/proximity_collisions.h"

#include "dd/elasticity/distance.h"
#include "dd/topology/line_operations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace ddfem
{
namespace
{
struct Contact
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
std::optional<Contact> find_near(const TopologyContext &c, const SegmentIndex s1, const SegmentIndex s2, const double r)
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
  return Contact{d.first, d.second, a2 + d.second * t2 - a1 - d.first * t1};
}

/// Two arms of node o that close like scissors: the end of the shorter and the nearest point of the longer, if within @p r.
std::optional<Contact> find_near_hinge(const TopologyContext &c, const SegmentIndex s1, const SegmentIndex s2,
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
  return Contact{from_o(s1, first_is_shorter ? 1.0 : u), from_o(s2, first_is_shorter ? u : 1.0),
                 first_is_shorter ? separation : Vec3(-separation)};
}

std::optional<NodeIndex> common_node(const Network &n, const SegmentIndex s1, const SegmentIndex s2)
{
  for (const NodeIndex i : {n.start(s1), n.end(s1)})
    if (i == n.start(s2) || i == n.end(s2))
      return i;
  return std::nullopt;
}

/// Nearest points of two different segments within @p r, with or without a common node.
std::optional<Contact> find_pair(const TopologyContext &c, const SegmentIndex s1, const SegmentIndex s2, const double r)
{
  const auto shared = common_node(c.network, s1, s2);
  return shared ? find_near_hinge(c, s1, s2, *shared, r) : find_near(c, s1, s2, r);
}

/// Whether the two points touch, or approach each other in this step.
bool is_closing(const TopologyContext &c, const SegmentIndex s1, const SegmentIndex s2, const Contact &contact)
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

/// Point nearest to @p x that lies on the glide planes of all arms of both nodes (through the nodes' own positions: in a
/// periodic cell the plane's offset belongs to another image). Empty if there is none within twice the collision radius.
std::optional<Vec3> meeting_point(const TopologyContext &c, const NodeIndex i, const NodeIndex j, const Vec3 &xj,
                                  const Vec3 &x)
{
  const Network &n = c.network;
  Eigen::Matrix<double, Eigen::Dynamic, 3> normals(static_cast<Eigen::Index>(n.degree(i) + n.degree(j)), 3);
  Eigen::VectorXd offsets(normals.rows());
  Eigen::Index row = 0;
  for (const auto &[node, position] : {std::pair(i, n.position(i)), std::pair(j, xj)})
    for (const SegmentIndex s : n.connected_segments(node))
    {
      normals.row(row) = n.normal(s).transpose();
      offsets[row] = n.normal(s).dot(position - x);
      ++row;
    }
  const Vec3 dx = normals.completeOrthogonalDecomposition().solve(offsets);
  const double tolerance = 1e-6 * c.settings.collision_radius;
  if ((normals * dx - offsets).cwiseAbs().maxCoeff() > tolerance || dx.norm() > 2 * c.settings.collision_radius)
    return std::nullopt;
  return x + dx;
}

/// Node at parameter @p u of segment @p s: one of its ends if that is within the collision radius, else a new one.
NodeIndex node_at(TopologyContext &c, const SegmentIndex s, const double u)
{
  Network &n = c.network;
  const double length = n.length(s), r = c.settings.collision_radius;
  if (u * length <= r && u <= 0.5)
    return n.start(s);
  if ((1 - u) * length <= r)
    return n.end(s);
  return split_segment(c, s, n.position(n.start(s)) + u * n.direction(s), displacement_at(c, s, u));
}

/// How firmly a node is held: the more firmly held one stays where it is when two meet.
int firmness(const Network &n, const NodeIndex i)
{
  return n.constraint(i) == NodeConstraint::pinned ? 2 : n.constraint(i) == NodeConstraint::surface ? 1 : 0;
}

/// Whether the two lines have been merged: it may be that no point can take both.
bool merge_at_contact(TopologyContext &c, const SegmentIndex s1, const SegmentIndex s2, const Contact &contact)
{
  Network &n = c.network;
  NodeIndex i = node_at(c, s1, contact.s);
  NodeIndex j = node_at(c, s2, contact.t);
  if (i == j)
    return false;
  if (firmness(n, j) > firmness(n, i))
    std::swap(i, j);
  const bool both_held = firmness(n, i) > 0 && firmness(n, j) > 0;
  const bool both_on_surface = n.constraint(i) == NodeConstraint::surface && n.constraint(j) == NodeConstraint::surface;
  // A line that comes near the end of another at the surface reaches the surface by itself; two pinned nodes stay apart.
  if ((both_held && !both_on_surface) || (firmness(n, i) == 1 && firmness(n, j) == 0))
    return false;
  // Surface nodes meet only to annihilate: a surface node is the end of one line.
  if (both_on_surface && (ray_burgers(n, i) + ray_burgers(n, j)).norm() > 1e-9)
    return false;
  const Vec3 xi = n.position(i), xj = xi + n.minimum_image(n.position(j) - xi);
  const auto x = meeting_point(c, i, j, xj, firmness(n, i) > 0 ? xi : Vec3(0.5 * (xi + xj)));
  if (!x || (firmness(n, i) > 0 && (*x - xi).norm() > 1e-6 * c.settings.collision_radius))
    return false;
  if (firmness(n, i) == 0)
    move_node(c, i, *x);
  move_node(c, j, n.position(j) + (n.position(i) - xj));
  ++c.counts.collisions;
  c.remaining[i.value].setZero();
  merge_nodes(c, i, j);
  if (n.contains(i) && both_on_surface)
    n.set_constraint(i, NodeConstraint::free);
  return true;
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
      if (contact && is_closing(context, s1, s2, *contact) && merge_at_contact(context, s1, s2, *contact))
        ++events;
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
