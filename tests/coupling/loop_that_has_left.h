// A loop that grows until the grain holds nothing of it any more.
#pragma once

#include "dd/microstructure/sources.h"
#include "dd/topology/growth.h"
#include "dd/topology/motion.h"
#include "dd/topology/remesh.h"

namespace ddfem::test
{
/// Adds a loop of radius 20 nm and Burgers vector @p b on the plane of normal @p n, right-handed about it.
inline void add_ring(Network &network, const Vec3 &n, const Vec3 &b, const Vec3 &centre)
{
  const PlaneIndex plane = network.planes().find_or_insert({0, 0, 0}, n, centre);
  const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
  std::vector<Vec3> points;
  for (int k = 0; k < 12; ++k)
    points.push_back(centre + 20 * (std::cos(M_PI * k / 6) * u + std::sin(M_PI * k / 6) * v));
  add_line(network, points, b, plane, true, NodeConstraint::free);
}

/// Moves the nodes of the network once, each by @p displacement of its position, and remeshes.
template <class Displacement>
void move_and_remesh(Network &network, const GrainShape &shape, SweptArea &swept, const Displacement &displacement)
{
  TopologyCounts counts;
  const TopologySettings settings{6, 15, 0.3, 0.7};
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
    c.remaining[i.value] = displacement(network.position(i));
  move_nodes(c, 1.0);
  remesh(c);
}

/// Area swept by a loop as add_ring() makes it that grows from nothing until it has left. @p network (empty) holds the loop
/// meanwhile.
inline SweptArea loop_that_has_left(Network &network, const GrainShape &shape, const Vec3 &n, const Vec3 &b,
                                    const Vec3 &centre)
{
  add_ring(network, n, b, centre);
  SweptArea swept = grown_area(network, &shape, RayDirection::normal);
  for (int step = 0; step < 400 && network.n_segments() > 0; ++step)
    move_and_remesh(network, shape, swept, [&](const Vec3 &x) { return Vec3(2 * (x - centre).normalized()); });
  return swept;
}

/// The same in the middle of the grain.
inline SweptArea loop_that_has_left(Network &network, const GrainShape &shape, const Vec3 &n, const Vec3 &b)
{
  return loop_that_has_left(network, shape, n, b, 0.5 * (shape.lower_corner() + shape.upper_corner()));
}
} // namespace ddfem::test
