// Random loops in random grains, moved until they have left: what the topology of the surface has to survive.
#pragma once

#include "dd/elasticity/segment_stress.h"
#include "dd/forces/line_system.h"
#include "dd/geometry/surface_mesh_shape.h"
#include "dd/microstructure/clip.h"
#include "dd/mobility/linear_glide.h"
#include "dd/mobility/local_velocities.h"
#include "tests/dd/geometry/facetted_bodies.h"
#include "tests/dd/topology/random_networks.h"

#include <mpi.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace ddfem
{
enum class GrainKind
{
  box,
  cylinder,
  polyhedron, ///< convex
  pillar,     ///< tapered, on a base, with a fillet
  cantilever,
  voxels, ///< facetted, with re-entrant edges and corners
  facetted_pillar
};
inline constexpr int n_grain_kinds = 7;

inline const char *name_of(const GrainKind kind)
{
  constexpr std::array<const char *, n_grain_kinds> names{"box",        "cylinder", "polyhedron",     "pillar",
                                                          "cantilever", "voxels",   "facetted pillar"};
  return names[static_cast<std::size_t>(kind)];
}

enum class MotionKind
{
  expansion, ///< at the same speed everywhere, driven by a uniform stress
  flow,      ///< by a smooth random field of velocities
  agitation, ///< line tension, a stress that changes, noise of each node
  physics,   ///< forces between lines and rays, self force, a uniform stress; no correction
};
inline constexpr int n_motion_kinds = 4;

inline const char *name_of(const MotionKind kind)
{
  constexpr std::array<const char *, n_motion_kinds> names{"expansion", "flow", "agitation", "physics"};
  return names[static_cast<std::size_t>(kind)];
}

inline std::unique_ptr<GrainShape> random_frustum(Random &random)
{
  const double w = uniform(random, 100, 300), d = uniform(random, 100, 300), h = uniform(random, 100, 300),
               top = uniform(random, 0.4, 1), lean = uniform(random, -60, 60);
  FacetList facets = facetted_box(Vec3(0, 0, 0), Vec3(w, d, h));
  for (auto &f : facets)
    for (Vec3 &x : f.vertices)
      if (x[2] > 0)
        x = Vec3(lean, 0.5 * lean, h) + top * Vec3(x[0], x[1], 0);
  return std::make_unique<PolyhedronShape>(facets);
}

inline std::unique_ptr<GrainShape> random_voxels(Random &random)
{
  std::array<std::vector<double>, 3> x;
  for (auto &coordinates : x)
  {
    coordinates = {0};
    for (int k = 0; k < 3; ++k)
      coordinates.push_back(coordinates.back() + uniform(random, 50, 120));
  }
  // A block, less two arms of a cross cut into its upper half: an L, a T, or a step with a re-entrant corner.
  const std::uint64_t form = random() % 3;
  return std::make_unique<SurfaceMeshShape>(
      facetted_voxels(x,
                      [form](const int i, const int j, const int k) {
                        return form == 0 ? k == 0 || i == 0 : form == 1 ? k == 0 || i == 1 : k < 2 || i == 0 || j == 0;
                      }));
}

inline std::unique_ptr<GrainShape> random_grain(const GrainKind kind, Random &random)
{
  const auto length = [&](const double low, const double high) { return uniform(random, low, high); };
  const auto dimensions = [&]
  {
    PillarDimensions d{length(50, 120), length(100, 300), length(0, 0.15), 0, 0, length(50, 120)};
    d.fillet_radius = random() % 4 == 0 ? 0 : length(10, 50);
    d.base_width = 2.2 * d.fillet_centre()[0] + length(0, 150);
    return d;
  };
  switch (kind)
  {
    case GrainKind::box:
      return std::make_unique<BoxShape>(Vec3(0, 0, 0), Vec3(length(80, 300), length(80, 300), length(80, 300)));
    case GrainKind::cylinder: return std::make_unique<CylinderShape>(Vec3(5, 6, 7), length(50, 150), length(80, 300));
    case GrainKind::polyhedron: return random_frustum(random);
    case GrainKind::pillar: return std::make_unique<PillarShape>(Vec3(0, 0, 0), dimensions());
    case GrainKind::cantilever:
      return std::make_unique<CantileverShape>(Vec3(0, 0, 0), Vec3(length(100, 250), length(50, 90), length(50, 90)),
                                               Vec3(length(60, 120), length(100, 200), length(100, 200)));
    case GrainKind::voxels: return random_voxels(random);
    case GrainKind::facetted_pillar: break;
  }
  PillarDimensions d = dimensions();
  d.fillet_radius = std::max(d.fillet_radius, 10.0);
  d.base_width = 2.2 * d.fillet_centre()[0];
  return std::make_unique<SurfaceMeshShape>(facetted_pillar(Vec3(0, 0, 0), d, 32));
}

/// Where the lines of a draw begin.
enum class Placement
{
  anywhere,
  /// Where faces meet: centres on faces, edges and corners of the bounding box, some a little above or below; planes that contain or
  /// graze faces and edges; loops larger than the grain; sources pinned at one or both ends on the surface.
  at_edges
};

/// One draw: grain, loops, motion. Everything follows from seed and placement.
struct SurfaceLoops : TopologyFixture
{
  Placement placement;
  Random random;
  GrainKind grain_kind;
  MotionKind motion;
  std::unique_ptr<GrainShape> grain;
  bool impenetrable = false;
  std::optional<SlipSystems> systems;
  CandidateList candidates;
  Mat3 stress = Mat3::Zero(); ///< drives expansion and physics, in units of 1/nm
  Vec3 drift;
  std::array<Vec3, 6> waves;         ///< wave vectors and amplitudes of the flow
  static constexpr double speed = 3; ///< nm per step

  explicit SurfaceLoops(const std::uint64_t seed, const Placement where = Placement::anywhere)
      : placement(where), random(seed)
  {
    settings = {8, 24, 0.64, 1};
    settings.max_area = 115;
    for (int k = 0; k < 4; ++k)
      random();
    grain_kind = static_cast<GrainKind>(seed % n_grain_kinds);
    motion = static_cast<MotionKind>(random() % n_motion_kinds);
    grain = random_grain(grain_kind, random);
    shape = grain.get();
    if (random() % 4 == 0)
    {
      impenetrable = true;
      grain->set_face_kind(static_cast<int>(random() % 5), FaceKind::impenetrable);
    }
    const auto any = [&](const double size)
    { return Vec3(uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)); };
    const bool along_axes = random() % 2 == 0;
    const Mat3 turn =
        Eigen::Quaterniond(1 + any(1)[0], any(1)[0], any(1)[1], any(1)[2]).normalized().toRotationMatrix();
    systems.emplace(Lattice::fcc, 0.405, along_axes ? Orientation() : Orientation::from_rotation(turn));
    for (std::uint64_t n = 1 + random() % 3; n > 0; --n)
      add_lines();
    clip_to_grain(network, *shape, 1.0);
    const double half_length = 0.1;
    for (const SegmentIndex s : std::vector<SegmentIndex>(network.segments().begin(), network.segments().end()))
      if (network.length(s) < half_length && network.constraint(network.start(s)) == NodeConstraint::surface &&
          network.constraint(network.end(s)) == NodeConstraint::surface)
        remove_clipped(s);
    drift = any(0.7 * speed);
    for (std::size_t k = 0; k < waves.size(); ++k)
      waves[k] = any(k < 3 ? 0.05 : speed);
  }

  /// A loop or a source on a random slip system, or on a plane along the axes.
  void add_lines()
  {
    const Vec3 low = shape->lower_corner(), size = shape->upper_corner() - low;
    Vec3 centre;
    for (int d = 0; d < 3; ++d)
      centre[d] = low[d] + uniform(random, -0.1, 1.1) * size[d];
    if (random() % 6 == 0) // on a face of the bounding box, in it or across it
      centre[static_cast<int>(random() % 3)] = low[static_cast<int>(random() % 3)];
    const SlipSystem &system = (*systems)[random() % systems->size()];
    double radius = uniform(random, 15, 90);
    const std::uint64_t form = random() % 8;
    if (placement == Placement::at_edges)
    {
      move_to_edge(centre);
      if (random() % 4 == 0)
        radius = uniform(random, 90, 250);
    }
    if (form == 0)
    {
      PolygonLoop loop{{1, 1, 0}, system.burgers, centre, radius, 0};
      if (std::abs(systems->orientation().plane_normal(loop.plane).dot(loop.burgers)) < 0.01)
        loop.plane = {1, -1, 0};
      add_polygon_loop(network, *systems, loop, settings.max_segment);
      return;
    }
    const bool at_edges = placement == Placement::at_edges;
    const bool axial = form == 1 || (at_edges && form > 4);
    const auto axis = static_cast<Eigen::Index>(at_edges ? random() % 3 : 2);
    const Vec3 n = axial ? Vec3(Vec3::Unit(axis)) : system.normal;
    const Vec3 b = axial ? Vec3(0.286 * Vec3::Unit((axis + 1) % 3)) : system.burgers;
    Miller miller = system.plane_miller;
    if (axial)
    {
      miller = {0, 0, 0};
      if (systems->orientation().rotation().isIdentity(0))
        miller[static_cast<std::size_t>(axis)] = 1;
    }
    const PlaneIndex plane = network.planes().find_or_insert(miller, n, centre);
    stress -= (b * n.transpose() + n * b.transpose()) / b.squaredNorm();
    const bool source = form == 2;
    const Vec3 e1 = b.normalized(), e2 = n.cross(e1);
    const double turn = uniform(random, 0, 2 * std::numbers::pi);
    std::vector<Vec3> points;
    const int corners = source ? 6 : std::max(4, static_cast<int>(2 * std::numbers::pi * radius / 16));
    for (int k = 0; k < corners; ++k)
    {
      const double angle = source ? turn : turn + 2 * std::numbers::pi * k / corners;
      const double r = source ? radius * (k - 2.5) / 2.5 : radius;
      points.push_back(network.planes().project(plane, centre + r * (std::cos(angle) * e1 + std::sin(angle) * e2)));
    }
    if (source) // its first end lies on the surface, if there is one on the way
    {
      pin_at_surface(points);
      if (points.empty())
        return;
    }
    add_line(network, points, b, plane, !source, NodeConstraint::pinned);
  }

  /// Moves a point to the nearest face, edge or corner of the bounding box, or a little off it.
  void move_to_edge(Vec3 &x)
  {
    const Vec3 low = shape->lower_corner(), high = shape->upper_corner();
    const std::uint64_t axes = 1 + random() % 7;
    constexpr std::array<double, 5> offsets{0, 0, 1e-9, 0.3, -0.3}; // nm
    for (int d = 0; d < 3; ++d)
      if ((axes >> d & 1U) != 0)
        x[d] = (random() % 2 == 0 ? low[d] : high[d]) + offsets[random() % offsets.size()];
  }

  /// Cuts a straight source to what is inside; its ends are pinned there, one or both on the surface. Empty if nothing is left.
  void pin_at_surface(std::vector<Vec3> &points) const
  {
    const Vec3 middle = 0.5 * (points.front() + points.back());
    const auto inside = [&](const Vec3 &x) { return shape->signed_distance(x) < 0; };
    Vec3 p = points.front(), q = points.back();
    points.clear();
    if (inside(p) == inside(q) && (placement == Placement::anywhere || !inside(middle)))
      return;
    const Vec3 from = inside(p) ? p : inside(q) ? q : middle;
    p = inside(p) ? p : surface_crossing(*shape, from, p);
    q = inside(q) ? q : surface_crossing(*shape, from, q);
    if ((q - p).norm() >= settings.min_segment)
      points = {p, 0.5 * (p + q), q};
  }

  /// A line of almost no length that clipping has left in a corner.
  void remove_clipped(const SegmentIndex s)
  {
    const NodeIndex i = network.start(s), j = network.end(s);
    network.erase(s);
    network.erase(i);
    network.erase(j);
  }

  std::vector<Vec3> displacements(const std::uint64_t step)
  {
    if (motion == MotionKind::agitation)
      return random_displacements(network, step, speed, shape);
    std::vector<Vec3> wanted(network.node_capacity(), Vec3::Zero());
    if (motion == MotionKind::physics)
      wanted = physical_velocities();
    else
      for (const NodeIndex i : network.nodes())
        wanted[i.value] = motion == MotionKind::flow ? flow_at(network.position(i)) : expansion_of(i);
    double largest = 0;
    for (const NodeIndex i : network.nodes())
    {
      Vec3 &u = wanted[i.value];
      u = glide_projector(network, i, shape) * u;
      if (motion != MotionKind::physics && u.norm() > speed)
        u *= speed / u.norm();
      largest = std::max(largest, u.norm());
    }
    constexpr double rounding = 1e-9;                        // nm/ns: of a prismatic loop that nothing drives
    if (motion == MotionKind::physics && largest > rounding) // as the control of the step does
      for (Vec3 &u : wanted)
        u *= speed / largest;
    return wanted;
  }

  Vec3 flow_at(const Vec3 &x) const
  {
    Vec3 v = drift;
    for (std::size_t k = 0; k < 3; ++k)
      v += std::sin(waves[k].dot(x)) * waves[k + 3];
    return v;
  }

  Vec3 expansion_of(const NodeIndex i) const
  {
    Vec3 sum = Vec3::Zero();
    for (const SegmentIndex s : network.connected_segments(i))
      sum += (stress * network.burgers(s)).cross(network.direction(s).normalized()).normalized();
    return sum.norm() > 1e-6 ? Vec3(speed * sum.normalized()) : Vec3(Vec3::Zero());
  }

  std::vector<Vec3> physical_velocities() const
  {
    const IsotropicMedium aluminium{26500, 0.345, 0.286};
    ForceEnvironment environment;
    environment.shape = shape;
    environment.applied = 60 * symmetric_part(stress); // MPa nm times 1/nm
    const auto forces = compute_nodal_forces(network, {aluminium, aluminium.a, 1e-3}, environment, MPI_COMM_SELF);
    return glide_velocities(network, forces.total, *linear_glide(0.01, 0.01), shape);
  }

  void step(const std::uint64_t k)
  {
    const LineSystem before(medium(), network, shape, RayDirection::normal, nullptr, nullptr);
    TopologyContext c = context();
    c.remaining = displacements(k);
    c.product_plane = product_plane_rule(*systems);
    bend_displacements_along_surface(c);
    collide_continuously(c, candidates);
    move_nodes(c, 1);
    remesh(c);
    check(before);
    swept.clear();
    if (network.node_capacity() > 2 * network.n_nodes() + 64)
      network.clean();
  }

  /// With a core so wide that the stress at a point near a line is no larger than far away.
  static IsotropicMedium medium() { return {1, 0.3, 20}; }

  /// Throws std::runtime_error naming what is wrong.
  void check(const LineSystem &before) const
  {
    network.check_invariants(1e-5);
    check_nodes_of_grain(network, *shape);
    check_swept(before);
  }

  /// The boundary of what has been swept is the change of the lines with their rays: the stress of both is the same. And all of
  /// it lies near the grain.
  void check_swept(const LineSystem &before) const
  {
    const Vec3 low = shape->lower_corner(), high = shape->upper_corner();
    const Vec3 probe = 0.5 * (low + high) + Vec3(3, -2, 5);
    SymTensor of_triangles = SymTensor::Zero();
    for (const SweptTriangle &t : swept.triangles())
      for (std::size_t k = 0; k < 3; ++k)
      {
        const LoopVertex &v = t.vertices[k], &w = t.vertices[(k + 1) % 3];
        const double margin = 2 * settings.max_segment;
        if (!v.value.allFinite() || (!v.at_infinity && ((v.value.array() < low.array() - margin).any() ||
                                                        (v.value.array() > high.array() + margin).any())))
          throw std::runtime_error("area has been swept far from the grain or without bound");
        if (!v.at_infinity && !w.at_infinity)
          of_triangles += segment_stress(medium(), probe, v.value, w.value, t.burgers);
        else if (!v.at_infinity)
          of_triangles += ray_stress(medium(), probe, v.value, w.value, t.burgers);
        else if (!w.at_infinity)
          of_triangles -= ray_stress(medium(), probe, w.value, v.value, t.burgers);
      }
    const LineSystem after(medium(), network, shape, RayDirection::normal, nullptr, nullptr);
    const SymTensor change = after.stress(probe) - before.stress(probe);
    const double scale = 0.3 / 20; // b/a: of one line at its centre
    if (!((change - of_triangles).norm() < 1e-6 * scale))
      throw std::runtime_error(
          "what has been swept is not bounded by the old and the new lines: the stresses differ by " +
          std::to_string((change - of_triangles).norm() / scale) + " of that of a line");
  }

  std::string description() const
  {
    return std::string(name_of(grain_kind)) + ", " + name_of(motion) + (impenetrable ? ", impenetrable face" : "");
  }
};

/// What happened in one draw.
struct DrawResult
{
  std::string failure; ///< empty if nothing is wrong
  std::string description;
  std::uint64_t steps = 0;
  bool left = false;
  TopologyCounts counts;
};

/// Moves the loops of a seed until all have left or @p n_steps have passed.
inline DrawResult run_draw(const std::uint64_t seed, const std::uint64_t n_steps,
                           const Placement placement = Placement::anywhere)
{
  DrawResult result;
  try
  {
    SurfaceLoops draw(seed, placement);
    result.description = draw.description();
    for (; result.steps < n_steps && draw.network.n_segments() > 0; ++result.steps)
      draw.step(result.steps);
    result.left = draw.network.n_segments() == 0;
    result.counts = draw.counts;
  }
  catch (const std::exception &e)
  {
    result.failure = "seed " + std::to_string(seed) + " (" + result.description + "), step " +
                     std::to_string(result.steps) + ": " + e.what();
  }
  return result;
}
} // namespace ddfem
