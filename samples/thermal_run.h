// Lines in a heat bath, without changes of topology.
#pragma once

#include "dd/forces/surface_images.h"
#include "dd/integrators/brownian_chebyshev.h"
#include "dd/mobility/local_velocities.h"
#include "dd/mobility/thermal_force.h"
#include "dd/network/network.h"

#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace ddfem::samples
{
/// A network that is moved by forces, given as a function of it, and by a heat bath.
class ThermalRun
{
public:
  /// Nodal forces, MPa nm^2, by NodeIndex::value.
  using Force = std::function<std::vector<Vec3>(const Network &)>;

  ThermalRun(Network moved_network, Force nodal_force, MobilityPointer glide_law, const HeatBath &heat_bath)
      : network(std::move(moved_network)), force(std::move(nodal_force)), law(std::move(glide_law)), bath(heat_bath)
  {
  }

  /// One step, as long as @p stiffness (1/ns) allows but not longer than @p dt_limit (ns).
  IntegratorStep step(double stiffness, double dt_limit = 1e9);

  std::vector<Vec3> velocity(const Network &n) const { return glide_velocities(n, force(n), *law, nullptr); }

  Network network;
  Force force;
  MobilityPointer law;
  HeatBath bath;
  /// False: the mobility in the random displacement is that of the start of the step, as if it were constant.
  bool with_drift = true;
};

/// Elastic and core forces between the segments of a network in an infinite body.
ThermalRun::Force elastic_forces(const IsotropicMedium &medium, double core_cutoff_radius,
                                 double pair_tolerance = 1e-5);
/// The same in the half-space below the free surface @p surface.
ThermalRun::Force elastic_forces_under_surface(const IsotropicMedium &medium, double core_cutoff_radius,
                                               const ImagePlane &surface);
/// Forces of the core energy alone, which is a line tension: it does not depend on how a straight line is divided.
ThermalRun::Force core_forces(const IsotropicMedium &medium, double core_cutoff_radius);

/// Largest rate, 1/ns, at which disturbances of the network decay: the largest eigenvalue of -d(velocity)/d(position), by finite
/// differences.
double largest_rate(const ThermalRun &run);

/// Stiffness matrix of the free nodes of a line, in the order of nodes(), for motion along the unit vector @p direction, MPa nm.
Eigen::MatrixXd stiffness_of_line(const Network &network, const ThermalRun::Force &force, const Vec3 &direction);

/// Interstitial loop a/2<111> of bcc iron with one segment on each {110} and {112} side, normal of the loop and b along z.
Network prismatic_loop(double inscribed_radius, double depth);
} // namespace ddfem::samples
