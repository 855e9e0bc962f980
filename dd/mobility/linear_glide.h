// Linear viscous glide.
#pragma once

#include "dd/geometry/grain_shape.h"
#include "dd/network/network.h"

#include <span>
#include <vector>

namespace ddfem
{
/// Phonon drag per length of line, MPa ns (1e-3 Pa s = 1 MPa ns). Between the characters
/// B(theta) = B_screw cos^2 theta + B_edge sin^2 theta, theta the angle between line and Burgers vector.
struct LinearGlide
{
  double drag_edge = 0.0;
  double drag_screw = 0.0;
};

/// Directions in which a node may move: the orthogonal projector on them. Zero for pinned nodes and where the glide
/// planes of the arms (and the surface, for surface nodes) leave none. An arm without a glide plane is sessile and leaves
/// only its own line.
Mat3 glide_projector(const Network &network, NodeIndex i, const GrainShape *shape);

/// The same for a free node with these arms only.
Mat3 glide_projector(const Network &network, std::span<const SegmentIndex> arms);

/// Drag of a free node with these arms, MPa ns nm: half of B(theta) L of each.
double drag_of_arms(const Network &network, std::span<const SegmentIndex> arms, const LinearGlide &law);

/// Drag of a node, MPa ns nm.
double nodal_drag(const Network &network, NodeIndex i, const LinearGlide &law);

/// Takes off @p velocity (any unit) of a discretisation node what is parallel to the chord between its neighbours: such a motion
/// changes nothing but the spacing of the nodes, goes on for ever in equilibrium, and keeps the remeshing busy. Other nodes
/// keep theirs.
Vec3 across_line(const Network &network, NodeIndex i, const Vec3 &velocity);

/// Local velocity v = P f / (sum over arms of B(theta) L / 2) of a node that feels @p force (MPa nm^2), nm/ns; of a discretisation
/// node the part across the line.
Vec3 glide_velocity(const Network &network, NodeIndex i, const Vec3 &force, const LinearGlide &law,
                    const GrainShape *shape);

/// Local nodal velocities v = P f / (sum over arms of B(theta) L / 2), nm/ns, indexed by NodeIndex::value; of discretisation
/// nodes the part across the line.
/// @p force: nodal forces, MPa nm^2.
std::vector<Vec3> glide_velocities(const Network &network, const std::vector<Vec3> &force, const LinearGlide &law,
                                   const GrainShape *shape);
} // namespace ddfem
