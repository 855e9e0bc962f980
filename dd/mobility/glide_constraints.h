// In which directions nodes of junctions can move.
#pragma once

#include "dd/geometry/grain_shape.h"
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
  bool climbs = false;        ///< forbids nothing: a line without a plane that a mobility law lets climb

  bool is_sessile() const { return !climbs && normal.isZero(0); }
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

/// What is left of @p directions, a projector, to a node that slides on the face of outward normal @p outward.
Mat3 directions_on_face(const Mat3 &directions, const Vec3 &outward);

/// Directions in which a node may move: the orthogonal projector on them. Zero for pinned nodes and where the glide
/// planes of the arms (and the surface, for surface nodes) leave none. An arm without a glide plane is sessile and leaves
/// only its own line.
Mat3 glide_projector(const Network &network, NodeIndex i, const GrainShape *shape);

/// The same for a free node with these arms only.
Mat3 glide_projector(const Network &network, std::span<const SegmentIndex> arms);

/// The line on which @p projector projects if there is just one, a unit vector; zero otherwise.
Vec3 only_direction(const Mat3 &projector);
} // namespace ddfem
