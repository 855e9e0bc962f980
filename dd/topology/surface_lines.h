// Lines that end at the surface of the grain, lie in it, or pass through it.
#pragma once

#include "dd/topology/topology_context.h"

#include <optional>

namespace ddfem
{
/// The common glide plane of all arms of node @p i; invalid if they differ or have none.
PlaneIndex common_plane(const Network &network, NodeIndex i);
/// Its unit normal, or zero.
Vec3 common_normal(const Network &network, NodeIndex i);

/// Whether lines stop at the face nearest to @p x.
bool is_impenetrable(const GrainShape &shape, const Vec3 &x);

/// Where the way along the surface from @p p to @p q in the glide plane of unit normal @p normal turns from one face to another;
/// empty on one face and where the faces do not meet near the two points.
std::optional<Vec3> edge_between(const GrainShape &shape, const Vec3 &p, const Vec3 &q, const Vec3 &normal);

/// Cuts the line at node @p i, which has just reached a free face: each arm ends in a surface node of its own.
void exit_through_surface(TopologyContext &context, NodeIndex i);

/// Brings the lines in order that touch the surface: those that pass through an edge of a re-entrant grain are cut there (at an
/// impenetrable face they bend around it), nodes outside come back to the surface, and pieces of line that lie in the
/// surface leave.
void settle_at_surface(TopologyContext &context);

/// Removes the pieces of line that lie in the surface (both ends are surface nodes and the middle is nearer to the surface
/// than a tenth of the length): the line has left there.
void remove_surface_segments(TopologyContext &context);

/// Removes segment @p s, whose ends are surface nodes, by letting it leave through the surface between them.
void leave_through_surface(TopologyContext &context, SegmentIndex s);
} // namespace ddfem
