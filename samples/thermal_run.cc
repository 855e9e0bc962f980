#include "samples/thermal_run.h"

#include "dd/crystal/slip_systems.h"
#include "dd/elasticity/self_force.h"
#include "dd/forces/nodal_forces.h"
#include "dd/microstructure/sources.h"

#include <array>
#include <cmath>

namespace ddfem::samples
{
namespace
{
constexpr double difference = 1e-3; ///< nm

std::vector<NodeIndex> free_nodes(const Network &network)
{
  std::vector<NodeIndex> nodes;
  for (const NodeIndex i : network.nodes())
    if (network.constraint(i) == NodeConstraint::free)
      nodes.push_back(i);
  return nodes;
}
} // namespace

IntegratorStep ThermalRun::step(const double stiffness, const double dt_limit)
{
  BrownianMotion motion;
  motion.velocity = [this](const Network &n) { return velocity(n); };
  motion.mobility = [this, start = with_drift ? Network() : network](const Network &n, const std::vector<Vec3> &random)
  { return glide_velocities(with_drift ? n : start, random, *law, nullptr); };
  const SegmentDrag drag = [this](const SegmentIndex s)
  {
    const double of_segment = network.length(s) * law->drag(line_state(network, s));
    return LineDrag{of_segment, of_segment};
  };
  motion.thermal_force = [&](const Network &n, const double dt)
  { return thermal_forces(n, drag, DragMatrix::lumped, bath, dt); };
  const IntegratorSettings no_limits{1, 1e6, 1e9, 1, 1};
  IntegratorStep taken = BrownianChebyshev(no_limits).advance(network, motion, stiffness, dt_limit);
  for (const NodeIndex i : network.nodes())
    network.set_position(i, network.position(i) + taken.displacement[i.value]);
  ++bath.step;
  return taken;
}

ThermalRun::Force elastic_forces(const IsotropicMedium &medium, const double core_cutoff_radius,
                                 const double pair_tolerance)
{
  return [settings = ForceSettings{medium, core_cutoff_radius, pair_tolerance}](const Network &n)
  { return compute_nodal_forces(n, settings, {}, MPI_COMM_SELF).total; };
}

ThermalRun::Force elastic_forces_under_surface(const IsotropicMedium &medium, const double core_cutoff_radius,
                                               const ImagePlane &surface)
{
  return [settings = ForceSettings{medium, core_cutoff_radius, 1e-5}, surface](const Network &n)
  {
    const LineSystem lines(settings.medium, n, nullptr, RayDirection::normal, nullptr, nullptr);
    const SurfaceImages images(lines, std::array{surface}, {1e6, 1e-6});
    SegmentField field{SegmentPoints(n), {}, {}};
    field.stress = images.stress(field.points.positions());
    ForceEnvironment environment;
    environment.correction = &field;
    return compute_nodal_forces(n, settings, environment, MPI_COMM_SELF).total;
  };
}

ThermalRun::Force core_forces(const IsotropicMedium &medium, const double core_cutoff_radius)
{
  return [medium, core = CoreEnergy{core_cutoff_radius}](const Network &n)
  {
    std::vector<Vec3> force(n.node_capacity(), Vec3::Zero());
    for (const SegmentIndex s : n.segments())
    {
      const SegmentForces f = core_force(medium, core, n.position(n.start(s)), n.position(n.end(s)), n.burgers(s));
      force[n.start(s).value] += f.start;
      force[n.end(s).value] += f.end;
    }
    return force;
  };
}

double largest_rate(const ThermalRun &run)
{
  Network moved = run.network;
  const std::vector<NodeIndex> nodes = free_nodes(moved);
  const auto n = static_cast<Eigen::Index>(3 * nodes.size());
  Eigen::MatrixXd rate(n, n);
  const auto velocity_with = [&](const NodeIndex i, const Vec3 &d)
  {
    const Vec3 x = moved.position(i);
    moved.set_position(i, x + d);
    std::vector<Vec3> v = run.velocity(moved);
    moved.set_position(i, x);
    return v;
  };
  for (Eigen::Index k = 0; k < n; ++k)
  {
    const NodeIndex i = nodes[static_cast<std::size_t>(k / 3)];
    const Vec3 d = difference * Vec3::Unit(k % 3);
    const std::vector<Vec3> plus = velocity_with(i, d), minus = velocity_with(i, -d);
    for (std::size_t m = 0; m < nodes.size(); ++m)
      rate.block<3, 1>(static_cast<Eigen::Index>(3 * m), k) =
          (minus[nodes[m].value] - plus[nodes[m].value]) / (2 * difference);
  }
  return rate.eigenvalues().cwiseAbs().maxCoeff();
}

Eigen::MatrixXd stiffness_of_line(const Network &network, const ThermalRun::Force &force, const Vec3 &direction)
{
  Network moved = network;
  const std::vector<NodeIndex> nodes = free_nodes(network);
  const auto n = static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd stiffness(n, n);
  for (Eigen::Index k = 0; k < n; ++k)
  {
    const NodeIndex i = nodes[static_cast<std::size_t>(k)];
    const Vec3 x = network.position(i);
    moved.set_position(i, x + difference * direction);
    const std::vector<Vec3> plus = force(moved);
    moved.set_position(i, x - difference * direction);
    const std::vector<Vec3> minus = force(moved);
    moved.set_position(i, x);
    for (Eigen::Index m = 0; m < n; ++m)
    {
      const auto node = nodes[static_cast<std::size_t>(m)].value;
      stiffness(m, k) = (minus[node] - plus[node]).dot(direction) / (2 * difference);
    }
  }
  return stiffness;
}

Network prismatic_loop(const double inscribed_radius, const double depth)
{
  const Orientation orientation = Orientation::from_axes(SampleAxis::z, {1, 1, 1}, SampleAxis::x, {1, -1, 0});
  const SlipSystems systems(Lattice::bcc, 0.2866, orientation);
  Network network;
  PolygonLoop loop;
  loop.plane = {1, 1, 1};
  loop.burgers = shortest_translation(Lattice::bcc, 0.2866, orientation, {-1, -1, -1});
  loop.centre = Vec3(0, 0, depth);
  loop.radius = inscribed_radius;
  loop.corners = 0;
  add_polygon_loop(network, systems, loop, 4 * inscribed_radius);
  return network;
}
} // namespace ddfem::samples
