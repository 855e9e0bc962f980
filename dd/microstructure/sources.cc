#include "dd/microstructure/sources.h"

#include "dd/crystal/product_plane.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace ddfem
{
namespace
{
void require_positive(const double value, const char *what)
{
  if (!(value > 0) || !std::isfinite(value))
    throw std::invalid_argument(std::string(what) + " must be positive");
}

/// Unit vectors in the plane of a loop; u x v is its normal. Angles run from u to v.
struct LoopFrame
{
  Vec3 u, v;
};

/// Corners of the polygon whose sides touch the circle of radius r at these angles (ascending, neighbours less than pi
/// apart).
std::vector<Vec3> tangent_polygon(const PolygonLoop &loop, const LoopFrame &frame, const std::vector<double> &angles)
{
  std::vector<Vec3> corners;
  for (std::size_t k = 0; k < angles.size(); ++k)
  {
    const double before = k == 0 ? angles.back() - 2 * std::numbers::pi : angles[k - 1];
    const double middle = (before + angles[k]) / 2, distance = loop.radius / std::cos((angles[k] - before) / 2);
    corners.emplace_back(loop.centre + distance * (std::cos(middle) * frame.u + std::sin(middle) * frame.v));
  }
  return corners;
}

/// Corners of the loop whose sides run along the traces of the glide planes of b.
std::vector<Vec3> crystallographic_corners(const SlipSystems &systems, const PolygonLoop &loop, const LoopFrame &frame)
{
  std::vector<double> angles;
  const Vec3 n = frame.u.cross(frame.v);
  for (const std::size_t p : systems.glissile_planes(loop.burgers))
  {
    // The outward normal of the side is the part of the plane's normal that lies in the plane of the loop.
    const Vec3 outward = systems.planes()[p].normal - n.dot(systems.planes()[p].normal) * n;
    const double angle = std::atan2(outward.dot(frame.v), outward.dot(frame.u));
    angles.push_back(angle);
    angles.push_back(angle > 0 ? angle - std::numbers::pi : angle + std::numbers::pi);
  }
  if (angles.size() < 4)
    throw std::invalid_argument("a loop whose sides lie on slip planes needs a Burgers vector with two glide planes");
  std::ranges::sort(angles);
  return tangent_polygon(loop, frame, angles);
}

std::vector<Vec3> regular_corners(const PolygonLoop &loop, const LoopFrame &frame)
{
  std::vector<Vec3> corners;
  for (unsigned k = 0; k < loop.corners; ++k)
  {
    const double angle = 2 * std::numbers::pi * k / loop.corners;
    corners.emplace_back(loop.centre + loop.radius * (std::cos(angle) * frame.u + std::sin(angle) * frame.v));
  }
  return corners;
}

/// The slip plane that holds segment @p s, exactly: a plane that is only near leaves it sessile.
PlaneIndex slip_plane_of(Network &network, const SlipSystems &systems, const SegmentIndex s)
{
  const Vec3 xi = network.direction(s).normalized(), x = network.position(network.start(s));
  const auto p = product_plane(systems, xi, network.burgers(s));
  constexpr double exact = 1e-9;
  if (!p || std::abs(systems.planes()[*p].normal.dot(xi)) > exact)
    return {};
  return network.planes().find_or_insert(systems.planes()[*p].miller, systems.planes()[*p].normal, x);
}
} // namespace

std::vector<NodeIndex> add_line(Network &network, const std::vector<Vec3> &points, const Vec3 &burgers,
                                const PlaneIndex plane, const bool closed, const NodeConstraint end_constraint)
{
  std::vector<NodeIndex> nodes;
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    const bool end = !closed && (k == 0 || k + 1 == points.size());
    nodes.push_back(network.insert(Node{points[k], end ? end_constraint : NodeConstraint::free}));
  }
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k)
    network.insert(Segment{nodes[k], nodes[k + 1], burgers, plane});
  if (closed)
    network.insert(Segment{nodes.back(), nodes.front(), burgers, plane});
  return nodes;
}

void add_frank_read_source(Network &network, const Orientation &orientation, const FrankReadSource &source,
                           const double max_segment)
{
  require_positive(source.length, "the length of a Frank-Read source");
  require_positive(source.burgers.norm(), "the Burgers vector of a Frank-Read source");
  const Vec3 n = orientation.plane_normal(source.plane);
  const Vec3 e = source.burgers.normalized();
  if (std::abs(n.dot(e)) > 1e-9)
    throw std::invalid_argument("the Burgers vector of a Frank-Read source must lie in its glide plane");
  const double angle = source.character_angle * std::numbers::pi / 180;
  const Vec3 t = std::cos(angle) * e + std::sin(angle) * n.cross(e);
  const unsigned pieces = std::max(2U, static_cast<unsigned>(std::ceil(source.length / max_segment - 1e-9)));
  const PlaneIndex plane = network.planes().find_or_insert(source.plane, n, source.centre);
  std::vector<Vec3> points;
  for (unsigned k = 0; k <= pieces; ++k)
    points.push_back(network.planes().project(plane, source.centre + (double(k) / pieces - 0.5) * source.length * t));
  add_line(network, points, source.burgers, plane, false, NodeConstraint::pinned);
}

void add_polygon_loop(Network &network, const SlipSystems &systems, const PolygonLoop &loop, const double max_segment)
{
  require_positive(loop.radius, "the radius of a loop");
  require_positive(loop.burgers.norm(), "the Burgers vector of a loop");
  const Vec3 n = systems.orientation().plane_normal(loop.plane);
  const Vec3 u = n.unitOrthogonal();
  const LoopFrame frame{u, n.cross(u)};
  const bool glide = std::abs(n.dot(loop.burgers)) < 1e-9 * loop.burgers.norm();
  if (loop.corners == 1 || loop.corners == 2 || (loop.corners == 0 && glide))
    throw std::invalid_argument("a loop needs at least three corners");
  const std::vector<Vec3> corners =
      loop.corners == 0 ? crystallographic_corners(systems, loop, frame) : regular_corners(loop, frame);
  const PlaneIndex own_plane = glide ? network.planes().find_or_insert(loop.plane, n, loop.centre) : PlaneIndex{};
  std::vector<Vec3> points;
  for (std::size_t k = 0; k < corners.size(); ++k)
  {
    const Vec3 side = corners[(k + 1) % corners.size()] - corners[k];
    const unsigned pieces = std::max(1U, static_cast<unsigned>(std::ceil(side.norm() / max_segment - 1e-9)));
    for (unsigned m = 0; m < pieces; ++m)
    {
      const Vec3 x = corners[k] + double(m) / pieces * side;
      points.push_back(glide ? network.planes().project(own_plane, x) : x);
    }
  }
  const auto nodes = add_line(network, points, loop.burgers, own_plane, true, NodeConstraint::free);
  if (glide)
    return;
  for (std::size_t k = 0; k < nodes.size(); ++k)
  {
    const SegmentIndex s = *network.find(nodes[k], nodes[(k + 1) % nodes.size()]);
    Segment segment = network.get(s);
    segment.plane = slip_plane_of(network, systems, s);
    network.set(s, segment);
  }
}
} // namespace ddfem
