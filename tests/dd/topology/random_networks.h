// Networks of random loops and lines of an fcc crystal, moved at random: what topology has to survive.
#pragma once

#include "dd/crystal/slip_systems.h"
#include "dd/geometry/grain_shape.h"
#include "dd/microstructure/sources.h"
#include "dd/mobility/glide_constraints.h"
#include "dd/mobility/linear_glide.h"
#include "dd/topology/collisions/continuous_collisions.h"
#include "dd/topology/motion.h"
#include "dd/topology/node_splitting.h"
#include "dd/topology/product_plane_rule.h"
#include "dd/topology/remesh.h"
#include "tests/dd/topology/topology_fixture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
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

/// Throws std::runtime_error naming a node outside the grain or a surface node inside it.
inline void check_nodes_of_grain(const Network &network, const GrainShape &shape)
{
  for (const NodeIndex i : network.nodes())
  {
    const double outside = shape.signed_distance(network.position(i));
    const bool surface = network.constraint(i) == NodeConstraint::surface;
    if (outside > 1e-6 || (surface && outside < -1e-6))
      throw std::runtime_error(name_of(network.constraint(i)) + (" node " + std::to_string(network.id(i))) + " lies " +
                               std::to_string(outside) + " nm outside the grain");
  }
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

/// Forces of the order of the line tension of aluminium in random directions, MPa nm^2.
inline NodalForces random_forces(const Network &network, const std::uint64_t step)
{
  NodalForces forces;
  forces.total.assign(network.node_capacity(), Vec3::Zero());
  forces.segment_ends.resize(network.segment_capacity());
  const auto random_vector = [&](const std::uint64_t id, const std::uint64_t end)
  { return Vec3(2000 * Vec3(noise(id, step, 3 * end), noise(id, step, 3 * end + 1), noise(id, step, 3 * end + 2))); };
  for (const SegmentIndex s : network.segments())
  {
    SegmentForces &f = forces.segment_ends[s.value];
    f.start = random_vector(network.id(s), 0);
    f.end = random_vector(network.id(s), 1);
    forces.total[network.start(s).value] += f.start;
    forces.total[network.end(s).value] += f.end;
  }
  return forces;
}

enum class Body
{
  periodic,
  box,     ///< five free faces, one impenetrable
  cylinder ///< free
};

struct RandomNetwork : TopologyFixture
{
  SlipSystems systems{Lattice::fcc, 0.405};
  CandidateList candidates;
  Body body = Body::periodic;
  std::unique_ptr<GrainShape> grain;
  CollisionSettings collision_settings;
  CollisionReport report;               ///< of the last step
  bool splitting = true;                ///< with random forces, which depend on the persistent ids
  std::uint64_t splitting_interval = 1; ///< steps

  RandomNetwork(const std::size_t n_segments, const double density, const Body kind) : body(kind)
  {
    settings = {10, 30, 1, 1.25};
    settings.max_area = 180;
    const double segment = 18;
    const double width = std::cbrt(static_cast<double>(n_segments) * segment / density);
    if (body == Body::periodic)
      network.set_period(Vec3(width, width, width));
    else if (body == Body::box)
    {
      grain = std::make_unique<BoxShape>(Vec3(0, 0, 0), Vec3(width, width, width));
      grain->set_face_kind(4, FaceKind::impenetrable);
    }
    else
      grain = std::make_unique<CylinderShape>(Vec3(width / 2, width / 2, 0), width / 2, width);
    shape = grain.get();
    Random random(n_segments);
    add_random_lines(network, systems, random, width, segment, n_segments, shape);
  }

  RandomNetwork() = default;

  /// The same network with a candidate list of its own.
  RandomNetwork copy() const
  {
    RandomNetwork other;
    other.body = body;
    other.network = network;
    other.shape = shape;
    other.settings = settings;
    other.splitting = splitting;
    return other;
  }

  void step(const std::uint64_t k)
  {
    TopologyContext c = context();
    c.remaining = random_displacements(network, k, 0.5 * settings.min_segment, shape);
    c.product_plane = product_plane_rule(systems);
    bend_displacements_along_surface(c);
    report = collide_continuously(c, candidates, collision_settings);
    move_nodes(c, 1);
    const IsotropicMedium aluminium{26500, 0.345, 0.286};
    if (splitting && k % splitting_interval == 0)
      split_nodes(c, SplittingModel{aluminium, aluminium.a, linear_glide(0.01, 0.01)},
                  [k](const Network &n) { return random_forces(n, k); });
    remesh(c);
    swept.clear();
    if (network.node_capacity() > 2 * network.n_nodes() + 64)
      network.clean();
    check();
  }

  /// Throws std::runtime_error naming what is wrong.
  void check() const
  {
    network.check_invariants(1e-5);
    if (!shape)
      return;
    check_nodes_of_grain(network, *shape);
  }
};
} // namespace ddfem
