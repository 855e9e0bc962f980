// How the load follows the lines within a step.
#pragma once

#include "coupling/loading.h"
#include "dd/forces/nodal_forces.h"
#include "dd/forces/segment_points.h"
#include "dd/mobility/velocity_solver.h"
#include "dd/network/network.h"

#include <vector>

namespace ddfem::coupling
{
/// A field of stress that a unit of nominal stress makes in the body, and what slip in it does to the nominal stress.
struct UnitLoad
{
  SegmentPoints points;          ///< of the segments at the start of the step
  std::vector<SymTensor> stress; ///< at them, MPa per MPa of nominal stress
  /// Fall of the nominal stress at rest (MPa) per work of the unit field on what the lines sweep (nm^3). Periodic cell: Young's
  /// modulus over the volume, as that work is the volume times the axial plastic strain; finite grain: by Betti's theorem, see
  /// FiniteGrain::unit_load().
  double fall_per_work = 0.0;
};

/// Nominal stress as a function of the positions of the lines during a step. What they sweep lowers the stress at rest, and the loading
/// answers at once as it does between steps (Loading::state_at): the stress that the lines feel is that of their own positions. With the stress
/// of the start of the step instead, a step longer than twice the time in which slip relaxes the stress, B/(E rho b^2 m^2) with the
/// density rho of mobile lines and their Schmid factor m, makes it oscillate.
class LoadWithinStep
{
public:
  /// The stress stays what it is.
  LoadWithinStep() = default;
  /// @p loading: state at the start of the step, to which @p response belongs.
  LoadWithinStep(const Network &network, UnitLoad unit_load, Loading loading_at_start, const BodyResponse &response);

  /// Change of the nominal stress (MPa) since the start, @p time (ns) after it and with the lines at @p moved: the network of the start
  /// with other positions.
  double stress_change(const Network &moved, double time) const;
  /// Adds to the forces on ends of segments and on nodes those of a change of the nominal stress (MPa).
  void add_to(NodalForces &forces, const Network &moved, double change) const;
  /// The part of the work on the lines (MPa nm^3) during @p displacement (nm, by NodeIndex::value) in a step of @p dt (ns) that the
  /// change of the stress adds, by the trapezoidal rule.
  double work_of_change(const Network &network, const std::vector<Vec3> &displacement, double dt) const;
  /// Bound of what this adds to the spectral radius of d(velocity)/d(position), 1/ns.
  double stiffness(const Network &network, const VelocitySolver &velocities, const GrainShape *shape) const;

private:
  double stress_change(double work, double time) const;
  std::vector<Vec3> displacement_to(const Network &moved) const;

  UnitLoad unit;
  Loading loading;
  BodyResponse response;
  std::vector<Vec3> start; ///< positions, nm, by NodeIndex::value
};
} // namespace ddfem::coupling
