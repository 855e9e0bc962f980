// In which directions nodes of junctions can move.
#pragma once

#include "dd/network/network.h"

#include <array>
#include <span>

namespace ddfem
{
/// What one arm of a node forbids it. A glissile arm keeps the node in its glide plane; a sessile arm, which has
/// none, lets the node move along the arm only: there it makes the line longer or shorter without any climb, as at
/// the ends of a Lomer junction, which zips and unzips along the intersection of the glide planes of the two lines.
struct ArmConstraint
{
  Vec3 normal = Vec3::Zero(); ///< unit normal of the glide plane; zero for a sessile arm
  Vec3 line = Vec3::Zero();   ///< unit direction of the arm, either sense

  bool is_sessile() const { return normal.isZero(0); }
};

/// Two unit vectors that with the unit vector @p line make an orthonormal frame: what a sessile arm forbids.
std::array<Vec3, 2> directions_across(const Vec3 &line);

/// The constraint of arm @p s.
ArmConstraint arm_constraint(const Network &network, SegmentIndex s);

/// Orthogonal projector on the directions in which a node with these arms can move: the intersection of their glide
/// planes, and of the lines of sessile arms. Zero if nothing is left, and for a node with sessile arms only, inside a
/// sessile line.
Mat3 free_directions(std::span<const ArmConstraint> arms);

/// The same for a free node of the network.
Mat3 free_directions(const Network &network, NodeIndex i);

/// The line on which @p projector projects if there is just one, a unit vector; zero otherwise.
Vec3 only_direction(const Mat3 &projector);
} // namespace ddfem
