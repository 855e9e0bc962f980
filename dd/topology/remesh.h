// Discretisation of the lines: segments between L_min and L_max.
#pragma once

#include "dd/topology/topology_context.h"

namespace ddfem
{
/// Brings the lengths of the segments between L_min and L_max where physical nodes allow it, in this order:
///  - lines shorter than L_min between two surface nodes leave (at the end once more);
///  - a segment longer than L_max is divided into equal parts; one longer than 3 L_min is halved if the triangle of one of its
///    nodes with the neighbours is larger than the maximum area: the line is sharply bent there;
///  - a discretisation node with an arm shorter than L_min is removed if the joined segment is not longer than 2 L_min, and
///    otherwise moved along its longer arm until both are equally long; an arm of no length (1e-3 L_min) always goes;
///  - a discretisation node whose triangle is smaller than the minimum area is removed if its arms make an obtuse angle, the
///    joined segment is not longer than 2/3 L_max, and no neighbour becomes sharply bent.
/// Nodes stay in their glide planes, physical nodes are not touched, and all area that a line sweeps is booked.
///
/// A second call changes nothing. A segment that has been joined is not divided in the next step, and one that has
/// been divided is not joined, as long as L_max >= 3 L_min and nodes move by less than L_min / 2 in a step: joined segments
/// are at least L_min shorter than what would divide them.
void remesh(TopologyContext &context);
} // namespace ddfem
