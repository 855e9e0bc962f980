// Velocities node by node.
#pragma once

#include "dd/geometry/grain_shape.h"
#include "dd/mobility/mobility_law.h"

#include <span>
#include <vector>

namespace ddfem
{
/// What a node knows of one of its arms.
struct NodalArm
{
  LineState line;
  double length = 0; ///< nm
};

/// Sum of the drag coefficients of half the arms, MPa ns nm.
double drag_of_arms(const MobilityLaw &law, std::span<const NodalArm> arms);

/// Velocity, nm/ns, of a node with these arms under the force @p force, MPa nm^2, in the directions left by the projector
/// @p directions: half of each arm moves with the node, sum (L/2) (f(v) + B xi (xi . v)) = force, f the resistance of the law and B
/// its drag(), which limits the sliding of the node along its arms. For a linear law this is directions . force / sum (L/2) B.
Vec3 local_velocity(const MobilityLaw &law, std::span<const NodalArm> arms, const Mat3 &directions, const Vec3 &force);

/// Directions in which node @p i may move, the projector on them, by the constraints of the law; see glide_projector().
Mat3 allowed_directions(const Network &network, NodeIndex i, const MobilityLaw &law, const GrainShape *shape);

/// Drag of a node for the motion of all its arms, MPa ns nm: half of B L of each.
double nodal_drag(const Network &network, NodeIndex i, const MobilityLaw &law);

/// Takes off @p velocity (any unit) of a discretisation node what is parallel to the chord between its neighbours: such a motion
/// changes nothing but the spacing of the nodes, goes on for ever in equilibrium, and keeps the remeshing busy. Other nodes
/// keep theirs.
Vec3 across_line(const Network &network, NodeIndex i, const Vec3 &velocity);

/// Chord between the neighbours of a discretisation node, nm; zero for other nodes.
Vec3 chord_at(const Network &network, NodeIndex i);

/// Local nodal velocities, nm/ns, by NodeIndex::value: as if the neighbours moved like the node itself (Durocher, thesis,
/// Bordeaux 2018, eqs. I.17 and I.18); of discretisation nodes the part across the line.
/// @p force: nodal forces, MPa nm^2.
std::vector<Vec3> glide_velocities(const Network &network, const std::vector<Vec3> &force, const MobilityLaw &law,
                                   const GrainShape *shape);
} // namespace ddfem
