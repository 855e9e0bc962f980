// Screw lines that change their glide plane.
#pragma once

#include "dd/topology/cross_slip_law.h"
#include "dd/topology/topology_context.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace ddfem
{
struct CrossSlipSettings
{
  CrossSlipModel model = CrossSlipModel::off;
  CrossSlipLaw law;
  double screw_angle = 0.0; ///< rad: segments within this angle of their Burgers vector count as screws
  /// What the resolved shear stress on the new plane over that on the present one must exceed: thermally activated, largest stress.
  double stress_ratio = 1.0, hysteresis = 1.1;
};

/// The step of the run in which lines may cross-slip.
struct CrossSlipStep
{
  double dt = 0; ///< ns
  std::uint64_t seed = 0;
  std::uint64_t number = 0;
};

/// Total stress (MPa) at points on lines.
using StressFunction = std::function<std::vector<SymTensor>(const std::vector<Vec3> &)>;

/// Lets straight runs of screw segments (screw_runs()) change to another plane of the crystal that holds their Burgers vector. The stress
/// that decides is the mean over the run, taken at the middles of its segments with the length of each as weight.
///
/// Thermally activated: with the probability 1 - exp(-rate dt) of the law for the length of the run, by one random number of its id and
/// the number of the step. Largest stress: at once, to the plane with the largest resolved shear stress, if that exceeds the present one by
/// the hysteresis. In both cases only if the resolved shear stress on the new plane is not zero, so that it moves the line there.
///
/// Where an opposite screw passes within a collision radius, the plane is the one that holds both lines: then they meet, and annihilate by
/// collision. Planes of exactly the same offset would not be found otherwise.
///
/// The nodes of the run first slide in their present plane onto one line along b, which sweeps area; then the segments belong to
/// the new plane, which sweeps nothing. The nodes at the ends stay on both planes and can move along b only. Lines whose Burgers vector
/// or plane is not one of the crystal's, and sessile lines, do not cross-slip.
void cross_slip(TopologyContext &context, const CrossSlipSettings &settings, const SlipSystems &systems,
                const CrossSlipStep &step, const StressFunction &stress);
} // namespace ddfem
