// A node, its arms and what surrounds them, to try what would happen if the node were two.
#pragma once

#include "dd/elasticity/isotropic.h"
#include "dd/elasticity/segment_force.h"
#include "dd/forces/nodal_forces.h"
#include "dd/mobility/local_velocities.h"

#include <array>
#include <span>
#include <vector>

namespace ddfem
{
/// Physics that decides whether and how a node splits.
struct SplittingModel
{
  IsotropicMedium medium;
  double core_cutoff_radius = 0.0; ///< nm; as in ForceSettings
  MobilityPointer mobility;
  /// Uniform stress, MPa: acts on the new junction and follows the arms as they turn.
  SymTensor applied = SymTensor::Zero();
  double pair_tolerance = 1e-4; ///< of the forces between the segments near the node
  /// A node splits only if its parts dissipate more power than it does by this fraction.
  double margin = 0.05;
};

/// The node cut in two: where its parts are, and which arms each has.
struct TrialSplit
{
  std::array<std::vector<std::size_t>, 2> arms;          ///< numbers of the arms of each part
  std::array<Vec3, 2> shift{Vec3::Zero(), Vec3::Zero()}; ///< of each part from the node, nm
  Vec3 burgers = Vec3::Zero();                           ///< of the junction from part 0 to part 1; zero: none
  Vec3 junction_normal = Vec3::Zero();                   ///< of its glide plane; zero: sessile
};

/// What a part, or the whole node, does.
struct NodeMotion
{
  Vec3 force = Vec3::Zero(); ///< MPa nm^2
  Vec3 velocity = Vec3::Zero();
  double power() const { return force.dot(velocity); } ///< MPa nm^3/ns
};

/// The neighbourhood of a node, positions relative to it. The forces of the arms and of the segments at their far
/// ends on each arm are computed exactly for every trial; everything else (far segments, images, correction) is what
/// the whole node feels and stays with each arm.
class NodeNeighbourhood
{
public:
  struct Arm
  {
    Vec3 far_end, burgers; ///< burgers for the line sense that leaves the node
    Vec3 normal;           ///< of its glide plane; zero: sessile
    ArmConstraint constraint;
    Vec3 force = Vec3::Zero();      ///< total, at the unsplit node, MPa nm^2
    Vec3 background = Vec3::Zero(); ///< the part of it that no trial recomputes
  };

  /// @p forces: those of the present network.
  NodeNeighbourhood(const Network &network, NodeIndex node, const SplittingModel &model, const NodalForces &forces);

  const std::vector<Arm> &arms() const { return node_arms; }
  /// Total force, and glide of the unsplit node.
  const NodeMotion &whole() const { return unsplit; }

  /// Directions in which the unsplit node can move.
  Mat3 directions() const;
  /// Directions in which a part with these arms can move if nothing joins it to the other part.
  Mat3 directions(std::span<const std::size_t> which) const;
  /// The same for part @p side of @p split, its junction included.
  Mat3 directions(const TrialSplit &split, std::size_t side) const;

  /// Force and velocity at the node of a part with these arms before anything has moved.
  NodeMotion merged(std::span<const std::size_t> which) const;
  /// Force and velocity of the two parts in the trial configuration.
  std::array<NodeMotion, 2> motion(const TrialSplit &split) const;
  /// Smallest distance between arms of different parts in the trial configuration, nm.
  double clearance(const TrialSplit &split) const;

private:
  struct Line
  {
    Vec3 start, end, burgers, normal;
    NodalArm as_arm() const { return {{(end - start).normalized(), burgers, normal}, (end - start).norm()}; }
  };

  /// Force of everything near, and of the applied stress, on the ends of line @p target, which is lines[number].
  SegmentForces near_force(const std::vector<Line> &lines, std::size_t number) const;

  const SplittingModel &model;
  std::vector<Arm> node_arms;
  std::vector<Line> surroundings; ///< segments at the far ends of the arms
  NodeMotion unsplit;
};
} // namespace ddfem
