// A loop that grows until the grain holds nothing of it any more.
#pragma once

#include "dd/microstructure/sources.h"
#include "dd/topology/growth.h"
#include "dd/topology/motion.h"
#include "dd/topology/remesh.h"

namespace ddfem::test
{
/// Area swept by a loop of Burgers vector @p b that grows from nothing at @p centre on the plane of normal @p n, right-handed about
/// it, until it has left. @p network (empty) holds the loop meanwhile.
inline SweptArea loop_that_has_left(Network &network, const GrainShape &shape, const Vec3 &n, const Vec3 &b,
                                    const Vec3 &centre)
{
  const PlaneIndex plane = network.planes().find_or_insert({0, 0, 0}, n, centre);
  const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
  std::vector<Vec3> points;
  for (int k = 0; k < 12; ++k)
    points.push_back(centre + 20 * (std::cos(M_PI * k / 6) * u + std::sin(M_PI * k / 6) * v));
  add_line(network, points, b, plane, true, NodeConstraint::free);
  SweptArea swept = grown_area(network, &shape, RayDirection::normal);
  TopologyCounts counts;
  const TopologySettings settings{6, 15, 0.3, 0.7};
  for (int step = 0; step < 400 && network.n_segments() > 0; ++step)
  {
    TopologyContext c{network,
                      settings,
                      &shape,
                      RayDirection::normal,
                      [](Network &, const Vec3 &, const Vec3 &, const Vec3 &, std::span<const Vec3>)
                      { return PlaneIndex{}; },
                      swept,
                      counts,
                      std::vector<Vec3>(network.node_capacity(), Vec3::Zero())};
    for (const NodeIndex i : network.nodes())
      c.remaining[i.value] = 2 * (network.position(i) - centre).normalized();
    move_nodes(c, 1.0);
    remesh(c);
  }
  return swept;
}

/// The same in the middle of the grain.
inline SweptArea loop_that_has_left(Network &network, const GrainShape &shape, const Vec3 &n, const Vec3 &b)
{
  return loop_that_has_left(network, shape, n, b, 0.5 * (shape.lower_corner() + shape.upper_corner()));
}
} // namespace ddfem::test
