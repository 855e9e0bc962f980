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

/// Drag of a whole segment, MPa ns nm: B L for motion across it, and what limits the sliding of nodes along it.
struct LineDrag
{
  double across = 0.0, along = 0.0;
};
using SegmentDrag = std::function<LineDrag(SegmentIndex)>;

/// The matrix that relates nodal velocities to nodal forces. A segment of direction xi adds to it, with
/// C = across (1 - xi xi) + along xi xi,
enum class DragMatrix
{
  lumped,     ///< C [1/2 0; 0 1/2]: velocities node by node
  consistent, ///< C [1/3 1/6; 1/6 1/3]: velocities of all nodes at once
};

/// Random nodal forces R (MPa nm^2, by NodeIndex::value) that stay constant for @p dt ns: the Langevin force per length of a line
/// with drag B, <r_i(s,t) r_j(s',t')> = 2 kT B delta_ij delta(s-s') delta(t-t'), weighted with the shape functions of the nodes
/// and averaged over dt. With the drag matrix A of the network
///
///   <R R^T> = 2 kT A / dt,
///
/// so that fluctuation and dissipation balance in every direction in which nodes can move (Ermak & McCammon, J. Chem. Phys. 69 (1978)
/// 1352, eqs. 3-5). Each segment adds two independent forces of covariance 2 kT (C/2)/dt: at its ends for the lumped matrix, at the two Gauss
/// points (1 -+ 1/sqrt(3))/2 for the consistent one, which gives its blocks exactly. A segment cut in two feels the same force in all: remeshing
/// changes no statistics of what is longer than a segment. The numbers depend on seed, step and the persistent ids of the segments only.
std::vector<Vec3> thermal_forces(const Network &network, const SegmentDrag &drag, DragMatrix matrix,
                                 const HeatBath &bath, double dt);
} // namespace ddfem
