// The random forces by which the heat bath moves lines.
#pragma once

#include "dd/network/network.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace ddfem
{
/// Boltzmann constant, MPa nm^3/K: 1.380649e-23 J/K (exact, SI brochure, 9th ed. 2019).
inline constexpr double boltzmann_constant = 0.01380649;

/// What belongs to one step of a thermal run.
struct HeatBath
{
  double kT = 0.0; ///< MPa nm^3
  std::uint64_t seed = 0;
  std::uint64_t step = 0; ///< number of the step: no two steps of a run may share it
};

/// Drag that segment @p s adds to each of its ends, MPa ns nm: half of B(theta) L.
using EndDrag = std::function<double(SegmentIndex)>;

/// Random nodal forces (MPa nm^2, by NodeIndex::value) that stay constant for @p dt ns: the Langevin force per length of a line
/// with drag B, <r_i(s,t) r_j(s',t')> = 2 kT B delta_ij delta(s-s') delta(t-t'), weighted with the shape functions of the nodes
/// and lumped like their drag. Each segment adds to each of its ends an independent isotropic force of variance
/// 2 kT (B L/2)/dt per component, so that
///
///   <R_i R_j> = 2 kT D_i delta_ij / dt   with the drag D_i = sum over arms of B L/2:
///
/// fluctuation and dissipation balance for every direction in which the node can move (Ermak & McCammon, J. Chem. Phys. 69 (1978)
/// 1352, eqs. 3-5). A segment cut in two feels the same force in all: remeshing changes no statistics of what is longer
/// than a segment. The numbers depend on seed, step and the persistent ids of the segments only.
std::vector<Vec3> thermal_forces(const Network &network, const EndDrag &end_drag, const HeatBath &bath, double dt);
} // namespace ddfem
