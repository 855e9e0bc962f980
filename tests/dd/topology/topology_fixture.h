// A network with everything a TopologyContext refers to.
#pragma once

#include "dd/microstructure/sources.h"
#include "dd/topology/topology_context.h"

#include <array>
#include <set>
#include <utility>

namespace ddfem
{
struct TopologyFixture
{
  Network network;
  TopologySettings settings{10, 30, 1, 1.25};
  SweptArea swept;
  TopologyCounts counts;
  const GrainShape *shape = nullptr;

  PlaneIndex horizontal(const double z = 0)
  {
    return network.planes().find_or_insert({0, 0, 1}, Vec3::UnitZ(), Vec3(0, 0, z));
  }

  /// All nodes get the displacement @p d.
  TopologyContext context(const Vec3 &d = Vec3::Zero())
  {
    return {network,
            settings,
            shape,
            RayDirection::normal,
            [](Network &, const Vec3 &, const Vec3 &, const Vec3 &, std::span<const Vec3>) { return PlaneIndex{}; },
            swept,
            counts,
            std::vector<Vec3>(network.node_capacity(), d)};
  }
};

/// Right-hand area vector swept inside the grain by lines of Burgers vector @p b (those of -b count negative).
inline Vec3 inside_area(const SweptArea &swept, const Vec3 &b)
{
  Vec3 a = Vec3::Zero();
  for (const SweptTriangle &t : swept.triangles())
    if (t.inside)
      a += 0.5 * t.burgers.dot(b) / b.squaredNorm() *
           (t.vertices[1].value - t.vertices[0].value).cross(t.vertices[2].value - t.vertices[0].value);
  return a;
}

/// What a network looks like without its numbering: the segments as sets of numbers.
using Picture = std::multiset<std::array<double, 9>>;

inline Picture picture_of(const Network &n)
{
  Picture picture;
  for (const SegmentIndex s : n.segments())
  {
    Vec3 x = n.position(n.start(s)), y = n.position(n.end(s)), b = n.burgers(s);
    const auto key = [](const Vec3 &v) { return std::array<double, 3>{v[0], v[1], v[2]}; };
    if (key(y) < key(x))
    {
      std::swap(x, y);
      b = -b;
    }
    picture.insert({x[0], x[1], x[2], y[0], y[1], y[2], b[0] + 0.0, b[1] + 0.0, b[2] + 0.0});
  }
  return picture;
}
} // namespace ddfem
