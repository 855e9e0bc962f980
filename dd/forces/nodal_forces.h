// Nodal forces of the network, contribution by contribution.
#pragma once

#include "dd/elasticity/segment_force.h"
#include "dd/forces/line_system.h"
#include "dd/forces/multipole_field.h"
#include "dd/forces/segment_points.h"

#include <mpi.h>

#include <array>
#include <memory>
#include <vector>

namespace ddfem
{
class FarFieldCache;

/// Who adds to the nodal force.
enum class ForceContribution : std::uint8_t
{
  applied,    ///< uniform applied stress
  self,       ///< elastic self force of each segment
  core,       ///< core energy (line tension)
  pairs,      ///< other segments of the network
  rays,       ///< virtual rays outside a finite grain
  images,     ///< periodic images
  correction, ///< FEM correction field
};
inline constexpr std::size_t n_force_contributions = 7;
const char *name_of(ForceContribution c);

struct ForceSettings
{
  IsotropicMedium medium;
  /// Radius at which the core energy makes the total line energy end, nm: E_core = mu/(4 pi) ln(a / r_c) (b_s^2 + b_e^2/(1-nu)).
  double core_cutoff_radius = 0.0;
  /// Error of a pair's nodal forces relative to their largest component.
  double pair_tolerance = 1e-5;
  RayDirection ray_direction = RayDirection::normal;
  SummationSettings summation = {};
};

/// External fields and surroundings of the network.
struct ForceEnvironment
{
  SymTensor applied = SymTensor::Zero(); ///< uniform, MPa
  const GrainShape *shape = nullptr;     ///< finite grain
  const PeriodicCell *cell = nullptr;
  PeriodicImages *images = nullptr;
  const SegmentField *correction = nullptr; ///< null or without points: none
  FarFieldCache *far_field = nullptr;       ///< null: it is computed at every call
  /// By which the work of multipoles is divided among ranks, measured at every call; null: as assumed.
  std::shared_ptr<fmm::WorkCosts> costs = nullptr;
};

/// Nodal forces, MPa nm^2 (= 1e-12 N), sample frame, indexed by NodeIndex::value.
struct NodalForces
{
  std::vector<Vec3> total;
  std::array<std::vector<Vec3>, n_force_contributions> by_contribution; ///< filled on request
  /// Total force on the two ends of each segment, indexed by SegmentIndex::value.
  std::vector<SegmentForces> segment_ends;
};

/// Zero on all nodes and segments, without contributions.
NodalForces no_forces(const Network &network);

/// Computes the nodal forces, by direct summation over all pairs or, with many segments, by fast multipoles; in the second
/// case the forces of rays and images are part of ForceContribution::pairs. The work is divided among the ranks of @p comm and
/// the threads; every force is a sum in fixed order, so the result is bitwise the same on any number of either.
NodalForces compute_nodal_forces(const Network &network, const ForceSettings &settings,
                                 const ForceEnvironment &environment, MPI_Comm comm, bool with_contributions = false);
} // namespace ddfem
