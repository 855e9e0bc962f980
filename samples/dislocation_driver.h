// The time loop without finite elements: forces, motion, collisions, node splitting, remeshing.
#pragma once

#include "dd/common/stopwatch.h"
#include "dd/crystal/slip_systems.h"
#include "dd/forces/far_field_cache.h"
#include "dd/forces/nodal_forces.h"
#include "dd/integrators/make_integrator.h"
#include "dd/integrators/split_forces.h"
#include "dd/mobility/linear_glide.h"
#include "dd/mobility/velocity_solver.h"
#include "dd/topology/collisions/moving_lines.h"
#include "dd/topology/cross_slip.h"
#include "dd/topology/node_splitting.h"
#include "dd/topology/product_plane_rule.h"
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
  MobilityPointer mobility;
  TopologySettings topology;
  IntegratorSettings integrator;
  double pair_tolerance = 1e-5;
  SummationSettings summation = {};
  VelocitySettings velocities = {};
  IntegratorKind method = IntegratorKind::stabilised;
  double near_distance = 0.0; ///< of subcycling, nm
  CrossSlipSettings cross_slip = {};
};

/// A network in an infinite body or, with @p cell, in a periodic one.
class DislocationDriver
{
public:
  DislocationDriver(DriverSettings driver_settings, const SlipSystems &systems, const PeriodicCell *periodic = nullptr)
      : settings(std::move(driver_settings)), integrator(make_integrator(settings.method, integrator_settings())),
        cell(periodic), crystal(systems), product_plane(product_plane_rule(systems)),
        solver(settings.mobility, settings.velocities)
  {
    if (cell)
    {
      images = std::make_unique<PeriodicImages>(cell->origin, cell->lengths);
      network.set_period(cell->lengths);
    }
  }

  /// Those of the driver, with paths that collisions see.
  IntegratorSettings integrator_settings() const
  {
    IntegratorSettings s = settings.integrator;
    s.max_deviation = settings.topology.collision_radius;
    return s;
  }

  /// The motion of one step of at most @p dt_limit ns, with the network left in place.
  IntegratorStep integrate(const double dt_limit)
  {
    if (far_field)
      far_field->begin_step();
    const SplitForces parts{{settings.medium, settings.core_cutoff_radius, near_pair_tolerance, settings.near_distance},
                            applied,
                            solver.drag_of_nodes(network),
                            &last_forces.segment_ends,
                            [&](const Network &n, const NodeIndex i, const Vec3 &force)
                            { return solver.velocity_of_node(n, i, force, nullptr); }};
    const EquationOfMotion motion{[&](const Network &n)
                                  {
                                    last_forces = forces(n);
                                    return solver.velocities(n, last_forces.total, nullptr);
                                  },
                                  solver.stiffness(network, line_tension(), nullptr), &parts};
    return integrator->advance(network, motion, dt_limit);
  }

  /// One step of at most @p dt_limit ns.
  IntegratorStep step(const double dt_limit)
  {
    IntegratorStep taken = integrate(dt_limit);
    const Stopwatch watch(topology_seconds);
    TopologyContext context = this->context(taken.displacement);
    move_lines(context, candidates, taken.parts);
    split_nodes(context, splitting(), [&](const Network &n) { return forces(n); });
    ddfem::cross_slip(context, settings.cross_slip, crystal, {taken.dt, 1, n_steps++},
                      [&](const std::vector<Vec3> &points) { return stress(points); });
    if (remeshing)
      remesh(context);
    strain_volume += plastic_strain_volume(swept);
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

  /// Of the present network, nm/ns, by NodeIndex::value.
  std::vector<Vec3> velocities() { return solver.velocities(network, forces(network).total, nullptr); }

  NodalForces forces(const Network &n)
  {
    ForceEnvironment e;
    e.applied = applied;
    e.cell = cell;
    e.images = images.get();
    e.far_field = far_field;
    return compute_nodal_forces(n,
                                {settings.medium, settings.core_cutoff_radius, settings.pair_tolerance,
                                 RayDirection::normal, settings.summation},
                                e, MPI_COMM_SELF);
  }

  /// Total stress at points, MPa.
  std::vector<SymTensor> stress(const std::vector<Vec3> &points)
  {
    std::vector<SymTensor> sum =
        LineSystem(settings.medium, network, nullptr, RayDirection::normal, cell, images.get()).stress(points);
    for (SymTensor &s : sum)
      s += applied;
    return sum;
  }

  TopologyContext context(std::vector<Vec3> displacement)
  {
    return {network, settings.topology,      nullptr, RayDirection::normal, product_plane, swept,
            counts,  std::move(displacement)};
  }

  std::size_t nodes_with_degree(const std::size_t degree) const
  {
    std::size_t n = 0;
    for (const NodeIndex i : network.nodes())
      n += network.degree(i) == degree ? 1 : 0;
    return n;
  }

  /// Persistent id of the node at the end of the line without branches that starts at pinned node @p i.
  ObjectId other_end_of_line(const NodeIndex i) const
  {
    SegmentIndex s = network.connected_segments(i)[0];
    NodeIndex k = network.other_end(s, i);
    while (network.degree(k) == 2 && network.constraint(k) != NodeConstraint::pinned)
    {
      const auto arms = network.connected_segments(k);
      s = arms[0] == s ? arms[1] : arms[0];
      k = network.other_end(s, k);
    }
    return network.id(k);
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
  SymTensor strain_volume = SymTensor::Zero(); ///< plastic strain times volume so far, nm^3
  double topology_seconds = 0;                 ///< processor time of collisions, splitting and remeshing
  bool remeshing = true;
  FarFieldCache *far_field = nullptr;
  std::unique_ptr<Integrator> integrator;

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
  SlipSystems crystal;
  std::uint64_t n_steps = 0;
  std::unique_ptr<PeriodicImages> images;
  ProductPlane product_plane;
  VelocitySolver solver;
  NodalForces last_forces;
  CandidateList candidates;
  SweptArea swept;
};
} // namespace ddfem
