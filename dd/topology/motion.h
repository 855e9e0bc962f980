// Moving the nodes to their new positions; lines that reach the boundary of the grain.
#pragma once

#include "dd/topology/topology_context.h"

namespace ddfem
{
/// Moves every node by @p fraction of its remaining displacement. In a finite grain a node that reaches a free face
/// stops there and its line is cut: each arm ends in a surface node of its own and continues outside as a virtual ray. At an
/// impenetrable face a node slides along the face in its glide plane. Surface nodes slide in (face) x (glide plane).
void move_nodes(TopologyContext &context, double fraction);

/// Replaces the displacements of surface nodes, and of nodes that run into an impenetrable face, by the straight way to
/// where move_nodes() will take them: what collisions need to know beforehand.
void bend_displacements_along_surface(TopologyContext &context);
} // namespace ddfem
