// The time loop without finite elements: forces, motion, collisions, node splitting, remeshing.
#pragma once

#include "dd/crystal/slip_systems.h"
#include "dd/forces/nodal_forces.h"
#include "dd/integrators/stabilised_runge_kutta.h"
#include "dd/topology/motion.h"
#include "dd/topology/node_splitting.h"
#include "dd/topology/proximity_collisions.h"
#include "dd/topology/remesh.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace ddfem
{
struct DriverSettings
{
  IsotropicMedium medium;          ///< MPa, nm
  double core_cutoff_radius = 0.0; ///< nm
  LinearGlide mobility;
  TopologySettings topology;
  IntegratorSettings integrator;
  double pair_tolerance = 1e-5;
};

/// Moves and collides: the one place that knows the algorithm for collisions.
inline void move_and_collide(TopologyContext &context)
{
  const unsigned parts = motion_substeps(context);
  for (unsigned k = 0; k < parts; ++k)
  {
    collide(context);
    move_nodes(context, 1.0 / parts);
  }
}

/// The glide plane of a product line: the slip plane that holds its Burgers vector and its direction, if there is
/// one.
inline ProductPlane slip_plane_of_product(const SlipSystems &systems)
{
  return [systems](Network &network, const Vec3 &xi, const Vec3 &b, const Vec3 &point) -> PlaneIndex
  {
    for (const std::size_t k : systems.glissile_planes(b))
    {
      const SlipPlane &plane = systems.planes()[k];
      if (std::abs(plane.normal.dot(xi)) < 1e-4)
        return network.planes().find_or_insert(plane.miller, plane.normal, point);
    }
    return {};
  };
}

/// Takes the motion along the line off @p velocity of a discretisation node: it means nothing and shifts nodes for
/// ever.
inline Vec3 across_line(const Network &network, const NodeIndex i, const Vec3 &velocity)
{
  const auto arms = network.connected_segments(i);
  if (network.is_physical(i) || arms.size() != 2)
    return velocity;
  const Vec3 &x = network.position(i);
  const auto to_neighbour = [&](const SegmentIndex s)
  { return network.minimum_image(network.position(network.other_end(s, i)) - x); };
  const Vec3 chord = to_neighbour(arms[0]) - to_neighbour(arms[1]);
  return velocity - chord * (chord.dot(velocity) / chord.squaredNorm());
}

/// Local glide velocities; the nodes at the ends of sessile junctions move along them. @p slide: discretisation nodes
/// follow the force along the line too.
inline std::vector<Vec3> velocities_with_junctions(const Network &network, const std::vector<Vec3> &force,
                                                   const LinearGlide &law, const bool slide)
{
  std::vector<Vec3> velocity(network.node_capacity(), Vec3::Zero());
  network.for_each_node(
      [&](const NodeIndex i)
      {
        if (network.constraint(i) != NodeConstraint::pinned && network.degree(i) > 0)
        {
          const Vec3 v = free_directions(network, i) * force[i.value] / nodal_drag(network, i, law);
          velocity[i.value] = slide ? v : across_line(network, i, v);
        }
      });
  return velocity;
}

/// A network in an infinite body or, with @p cell, in a periodic one.
class DislocationDriver
{
public:
  DislocationDriver(DriverSettings driver_settings, const SlipSystems &systems, const PeriodicCell *periodic = nullptr)
      : settings(std::move(driver_settings)), cell(periodic), product_plane(slip_plane_of_product(systems)),
        integrator(settings.integrator)
  {
    if (cell)
    {
      images = std::make_unique<PeriodicImages>(cell->origin, cell->lengths);
      network.set_period(cell->lengths);
    }
  }

  /// One step of at most @p dt_limit ns.
  IntegratorStep step(const double dt_limit)
  {
    const auto velocity = [&](const Network &n)
    { return velocities_with_junctions(n, forces(n).total, settings.mobility, sliding); };
    std::vector<double> drag(network.node_capacity(), 0.0);
    for (const NodeIndex i : network.nodes())
      drag[i.value] = nodal_drag(network, i, settings.mobility);
    IntegratorStep taken =
        integrator.advance(network, velocity, line_tension_stiffness(network, line_tension(), drag), dt_limit);
    TopologyContext context = this->context(taken.displacement);
    move_and_collide(context);
    split_nodes(context, splitting(), [&](const Network &n) { return forces(n); });
    if (remeshing)
      remesh(context);
    swept.clear();
    if (network.node_capacity() > 2 * network.n_nodes() + 64)
      network.clean();
    time += taken.dt;
    return taken;
  }

  /// Steps until no node is faster than @p speed (nm/ns) or @p duration (ns) has passed; returns the largest speed.
  double relax(const double duration, const double speed)
  {
    const double end = time + duration;
    double fastest = 0;
    while (time < end * (1 - 1e-12))
    {
      fastest = step(end - time).max_speed;
      if (fastest < speed)
        break;
    }
    return fastest;
  }

  NodalForces forces(const Network &n)
  {
    ForceEnvironment e;
    e.applied = applied;
    e.cell = cell;
    e.images = images.get();
    return compute_nodal_forces(
        n, {settings.medium, settings.core_cutoff_radius, settings.pair_tolerance, RayDirection::normal}, e,
        MPI_COMM_SELF);
  }

  TopologyContext context(std::vector<Vec3> displacement)
  {
    return {network, settings.topology,      nullptr, RayDirection::normal, product_plane, swept,
            counts,  std::move(displacement)};
  }

  SplittingModel splitting() const
  {
    SplittingModel model{settings.medium, settings.core_cutoff_radius, settings.mobility};
    model.applied = applied;
    return model;
  }

  DriverSettings settings;
  Network network;
  SymTensor applied = SymTensor::Zero(); ///< MPa
  double time = 0;                       ///< ns
  TopologyCounts counts;
  bool remeshing = true;
  bool sliding = false; ///< motion of discretisation nodes along the line

private:
  double line_tension() const
  {
    double b2 = 0;
    for (const SegmentIndex s : network.segments())
      b2 = std::max(b2, network.burgers(s).squaredNorm());
    const IsotropicMedium &m = settings.medium;
    const double core = std::min(m.a, settings.core_cutoff_radius);
    return m.mu * b2 * (1 + m.nu) / (4 * std::numbers::pi * (1 - m.nu)) *
           std::max(1.0, std::log(2 * settings.topology.max_segment / core));
  }

  const PeriodicCell *cell;
  std::unique_ptr<PeriodicImages> images;
  ProductPlane product_plane;
  StabilisedRungeKutta integrator;
  SweptArea swept;
};
} // namespace ddfem
