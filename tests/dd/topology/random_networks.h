// Networks of random loops and lines of an fcc crystal, moved at random: what topology has to survive.
#pragma once

#include "dd/crystal/slip_systems.h"
#include "dd/geometry/grain_shape.h"
#include "dd/microstructure/sources.h"
#include "dd/mobility/linear_glide.h"
#include "dd/topology/topology_context.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

namespace ddfem
{
using Random = std::mt19937_64;

inline double uniform(Random &random, const double low, const double high)
{
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

/// Adds, on random slip systems and centred in a cube [0, width]^3, glide loops of @p n_corners segments of
/// length @p segment and as many lines pinned at both ends of the same length, until there are @p n_segments; with a @p shape only such as lie inside.
inline void add_random_lines(Network &network, const SlipSystems &systems, Random &random, const double width,
                             const double segment, const std::size_t n_segments, const GrainShape *shape)
{
  constexpr int n_corners = 30;
  const double radius = segment / (2 * std::sin(std::numbers::pi / n_corners));
  for (bool loop = true; network.n_segments() < n_segments; loop = !loop)
  {
    const SlipSystem &system = systems[random() % systems.size()];
    const Vec3 centre(uniform(random, 0, width), uniform(random, 0, width), uniform(random, 0, width));
    const PlaneIndex plane = network.planes().find_or_insert(system.plane_miller, system.normal, centre);
    const Vec3 e1 = system.burgers.normalized(), e2 = system.normal.cross(e1);
    const double turn = uniform(random, 0, 2 * std::numbers::pi);
    std::vector<Vec3> points;
    for (int k = 0; k < (loop ? n_corners : 11); ++k)
    {
      const double angle = loop ? turn + 2 * std::numbers::pi * k / n_corners : turn;
      const double r = loop ? radius : segment * (k - 5);
      points.push_back(network.planes().project(plane, centre + r * (std::cos(angle) * e1 + std::sin(angle) * e2)));
    }
    if (!shape || std::ranges::all_of(points, [&](const Vec3 &x) { return shape->signed_distance(x) < -1; }))
      add_line(network, points, system.burgers, plane, loop, NodeConstraint::pinned);
  }
}

/// A random number in [-1, 1) that belongs to an object and a time.
inline double noise(const std::uint64_t id, const std::uint64_t time, const std::uint64_t component)
{
  std::uint64_t h = id * 0x9e3779b97f4a7c15U + time * 0xbf58476d1ce4e5b9U + component * 0x94d049bb133111ebU;
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9U;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebU;
  return static_cast<double>((h ^ (h >> 31)) >> 11) * 0x1p-52 - 1;
}

/// Random displacements, in the glide planes, of size up to @p size: the Peach-Koehler force of a stress that changes at
/// random every twenty steps, noise of each node, and a line tension that keeps the lines from crumpling.
inline std::vector<Vec3> random_displacements(const Network &network, const std::uint64_t step, const double size,
                                              const GrainShape *shape)
{
  Mat3 stress;
  for (Eigen::Index k = 0; k < 9; ++k)
    stress(k / 3, k % 3) = noise(12345, step / 20, static_cast<std::uint64_t>(k));
  stress = (stress + stress.transpose()).eval();
  std::vector<Vec3> displacement(network.node_capacity(), Vec3::Zero());
  for (const NodeIndex i : network.nodes())
  {
    const auto arms = network.connected_segments(i);
    if (arms.empty())
      continue;
    Vec3 force = Vec3::Zero(), flutter;
    for (const SegmentIndex s : arms)
    {
      const Vec3 xi = network.direction(s).normalized();
      force += 3 * size * (stress * network.burgers(s)).cross(xi) + 0.1 * (network.start(s) == i ? 10.0 : -10.0) * xi;
    }
    for (std::uint64_t d = 0; d < 3; ++d)
      flutter[static_cast<Eigen::Index>(d)] = noise(network.id(i), step, d);
    Vec3 u = glide_projector(network, i, shape) * (force / static_cast<double>(arms.size()) + 0.3 * size * flutter);
    if (u.norm() > size)
      u *= size / u.norm();
    displacement[i.value] = u;
  }
  return displacement;
}
} // namespace ddfem
