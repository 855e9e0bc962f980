// What a mobility law says about a straight piece of line.
#pragma once

#include "dd/common/types.h"
#include "dd/mobility/glide_constraints.h"
#include "dd/network/network.h"

#include <memory>
#include <string>

namespace ddfem
{
/// A straight piece of line; all vectors in the sample frame.
struct LineState
{
  Vec3 direction = Vec3::UnitX(); ///< unit vector xi along the line, either sense
  Vec3 burgers = Vec3::Zero();    ///< nm, for that sense
  Vec3 normal = Vec3::Zero();     ///< unit normal of the glide plane; zero for a line without one

  /// cos^2 of the angle between line and Burgers vector: 1 for a screw, 0 for an edge.
  double squared_cosine() const
  {
    const double along = direction.dot(burgers);
    return along * along / burgers.squaredNorm();
  }
};

/// Segment @p s of a network as the mobility laws see it.
LineState line_state(const Network &network, SegmentIndex s);

/// What keeps a line at a velocity against its friction.
struct Resistance
{
  Vec3 force = Vec3::Zero(); ///< per length, MPa nm; along the velocity as far as there is only one direction of motion
  Mat3 slope = Mat3::Zero(); ///< its derivative with respect to the velocity, MPa ns; symmetric, not negative
};

/// A mobility law, in the form that serves linear and nonlinear ones: the force per length that moves a straight line at
/// a given velocity. Only the part of the velocity across the line counts, because motion along a straight line moves
/// nothing; what limits the sliding of nodes along their lines belongs to the solvers (VelocitySolver).
///
/// The force must grow with the velocity (slope positive across the line in the directions that constraint() leaves) and be
/// the gradient of a dissipation potential (slope symmetric): then the velocities exist and are unique. Laws are immutable
/// functions of numbers: they know the crystal, but no network, and are called by many threads at once.
class MobilityLaw
{
public:
  MobilityLaw() = default;
  MobilityLaw(const MobilityLaw &) = delete;
  MobilityLaw &operator=(const MobilityLaw &) = delete;
  virtual ~MobilityLaw() = default;

  /// In which directions the line keeps its nodes. A line on a glide plane keeps them in it, to the last bit of the normal; a
  /// line without one keeps them on itself (it is sessile); a law that lets lines climb forbids nothing.
  virtual ArmConstraint constraint(const LineState &line) const { return {line.normal, line.direction}; }

  /// @p velocity of the line, nm/ns, any: its part along the line has no influence.
  virtual Resistance resistance(const LineState &line, const Vec3 &velocity) const = 0;

  /// Smallest slope of the resistance, at any velocity, in a direction across the line in which it can move, MPa ns: what bounds
  /// how fast a disturbance dies away. Of a sessile line what it would be with a glide plane: it limits the sliding of nodes along it.
  virtual double drag(const LineState &line) const = 0;

  /// Whether the resistance is drag() times the velocity in every direction across the line: no iterations are needed then.
  virtual bool is_linear() const { return false; }
};

using MobilityPointer = std::shared_ptr<const MobilityLaw>;
} // namespace ddfem
