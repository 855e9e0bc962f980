// A network with everything a TopologyContext refers to.
#pragma once

#include "dd/microstructure/sources.h"
#include "dd/topology/topology_context.h"

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
            [](Network &, const Vec3 &, const Vec3 &, const Vec3 &) { return PlaneIndex{}; },
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
} // namespace ddfem
