#include "dd/microstructure/sources.h"

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

/// Glide plane of a straight line along @p t with Burgers vector @p b that is not in the loop's own plane.
PlaneIndex prism_plane(Network &network, const Orientation &orientation, const Vec3 &t, const Vec3 &b, const Vec3 &x)
{
  const Vec3 n = t.cross(b);
  if (n.norm() < 1e-6 * t.norm() * b.norm())
    return {}; // screw: any plane through it; without choosing one it does not glide
  const Vec3 normal = n.normalized();
  return network.planes().find_or_insert(rationalised(orientation.to_crystal(normal), 9, 1e-9), normal, x);
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
  const Vec3 n = orientation.unit_vector(source.plane);
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

void add_polygon_loop(Network &network, const Orientation &orientation, const PolygonLoop &loop,
                      const double max_segment)
{
  require_positive(loop.radius, "the radius of a loop");
  require_positive(loop.burgers.norm(), "the Burgers vector of a loop");
  if (loop.corners < 3)
    throw std::invalid_argument("a loop needs at least three corners");
  const Vec3 n = orientation.unit_vector(loop.plane);
  const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
  const bool glide = std::abs(n.dot(loop.burgers)) < 1e-9 * loop.burgers.norm();
  const auto corner = [&](const unsigned k) -> Vec3
  {
    const double angle = 2 * std::numbers::pi * (k % loop.corners) / loop.corners;
    return loop.centre + loop.radius * (std::cos(angle) * u + std::sin(angle) * v);
  };
  const double side = (corner(1) - corner(0)).norm();
  const unsigned pieces = std::max(1U, static_cast<unsigned>(std::ceil(side / max_segment - 1e-9)));
  const PlaneIndex own_plane = glide ? network.planes().find_or_insert(loop.plane, n, loop.centre) : PlaneIndex{};
  std::vector<Vec3> points;
  for (unsigned k = 0; k < loop.corners; ++k)
    for (unsigned m = 0; m < pieces; ++m)
    {
      const Vec3 x = corner(k) + double(m) / pieces * (corner(k + 1) - corner(k));
      points.push_back(glide ? network.planes().project(own_plane, x) : x);
    }
  const auto nodes = add_line(network, points, loop.burgers, own_plane, true, NodeConstraint::free);
  if (glide)
    return;
  for (std::size_t k = 0; k < nodes.size(); ++k)
  {
    const SegmentIndex s = *network.find(nodes[k], nodes[(k + 1) % nodes.size()]);
    Segment segment = network.get(s);
    segment.plane = prism_plane(network, orientation, network.direction(s), loop.burgers, network.position(nodes[k]));
    network.set(s, segment);
  }
}
} // namespace ddfem
