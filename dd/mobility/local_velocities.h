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

/// Velocity, nm/ns, of a node with these arms under the force @p force, MPa nm^2, in the directions left by the projector
/// @p directions: half of each arm moves with the node, sum (L/2) (f(v) + beta B xi (xi . v)) = force, f the resistance of the law, B
/// its drag(), and beta = @p sliding_drag the drag on the sliding of the node along its arms (Durocher, thesis, Bordeaux 2018, eqs. I.12
/// and I.18). With beta = 1 and a linear law it is directions . force / sum (L/2) B.
/// Throws std::runtime_error if there is no such velocity.
Vec3 local_velocity(const MobilityLaw &law, std::span<const NodalArm> arms, const Mat3 &directions, const Vec3 &force,
                    double sliding_drag = 1);

/// Directions in which node @p i may move, the projector on them, by the constraints of the law; see glide_projector().
Mat3 allowed_directions(const Network &network, NodeIndex i, const MobilityLaw &law, const GrainShape *shape);

/// The arms of node @p i.
std::vector<NodalArm> arms_of(const Network &network, NodeIndex i);
/// Drag of a node for the motion of all its arms, MPa ns nm: half of B L of each.
double nodal_drag(const Network &network, NodeIndex i, const MobilityLaw &law);

/// Directions in which the velocity of node @p i is sought: of those that are allowed to a discretisation node the ones across the chord
/// between its neighbours. Motion along it changes nothing but the spacing of the nodes, goes on for ever in equilibrium, and
/// keeps the remeshing busy. Other nodes keep all that are allowed.
Mat3 directions_of_motion(const Network &network, NodeIndex i, const MobilityLaw &law, const GrainShape *shape);

/// Local velocity, nm/ns, of one node under the force @p force, MPa nm^2: see glide_velocities().
Vec3 glide_velocity(const Network &network, NodeIndex i, const Vec3 &force, const MobilityLaw &law,
                    const GrainShape *shape, double sliding_drag = 1);

/// Local nodal velocities, nm/ns, by NodeIndex::value: as if the neighbours moved like the node itself (Durocher, thesis,
/// Bordeaux 2018, eqs. I.17 and I.18); of discretisation nodes across the line.
/// @p force: nodal forces, MPa nm^2; @p sliding_drag: as in local_velocity().
std::vector<Vec3> glide_velocities(const Network &network, const std::vector<Vec3> &force, const MobilityLaw &law,
                                   const GrainShape *shape, double sliding_drag = 1);
} // namespace ddfem
