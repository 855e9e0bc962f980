// Frank-Read sources and polygonal loops.
#pragma once

#include "dd/crystal/slip_systems.h"
#include "dd/network/network.h"

#include <vector>

namespace ddfem
{
/// A straight segment pinned at both ends. Lengths in nm, sample frame.
struct FrankReadSource
{
  Miller plane{};              ///< three indices, on the axes of UnitCell
  Vec3 burgers = Vec3::Zero(); ///< nm
  Vec3 centre = Vec3::Zero();
  double length = 0.0;
  double character_angle = 90.0; ///< between line and Burgers vector, degrees: 0 screw, 90 edge
};

/// A closed polygon. A Burgers vector in its plane makes a glide loop, which glides in that plane. Otherwise the loop
/// is prismatic or mixed, and each side glides on the slip plane of the crystal that holds its direction and b. Sides
/// for which there is no such slip plane are sessile, and so are the corners at their ends. With b along the plane's
/// normal the loop is one of vacancies, with b opposite to it one of interstitials (FS/RH: the plastic strain of a
/// grown loop is -b (x) A / V).
struct PolygonLoop
{
  Miller plane{};              ///< three indices, on the axes of UnitCell; any plane
  Vec3 burgers = Vec3::Zero(); ///< nm
  Vec3 centre = Vec3::Zero();
  double radius = 0.0; ///< of the corners; of the inscribed circle if corners is 0
  /// At least three: regular polygon. 0, for prismatic and mixed loops: two sides along the trace of each glide plane
  /// of b, so that the whole loop can glide along b (octagon of basal, prismatic and pyramidal sides for hcp <a> on
  /// {11-20}).
  unsigned corners = 24;
};

/// Adds the source, divided into equal segments not longer than @p max_segment (two at least). Line direction in the
/// plane: cos(angle) b/|b| + sin(angle) n x b/|b|. Throws std::invalid_argument if b is not in the plane or a length is
/// not positive.
void add_frank_read_source(Network &network, const Orientation &orientation, const FrankReadSource &source,
                           double max_segment);

/// Adds the loop, counter-clockwise about the plane's normal. Throws std::invalid_argument for one or two corners, for
/// none if b lies in the plane or has less than two glide planes, and for a radius that is not positive.
void add_polygon_loop(Network &network, const SlipSystems &systems, const PolygonLoop &loop, double max_segment);

/// Adds the open or closed chain of @p points with one Burgers vector and plane; the ends of an open chain get
/// @p end_constraint. Returns the nodes.
std::vector<NodeIndex> add_line(Network &network, const std::vector<Vec3> &points, const Vec3 &burgers,
                                PlaneIndex plane, bool closed, NodeConstraint end_constraint);
} // namespace ddfem
