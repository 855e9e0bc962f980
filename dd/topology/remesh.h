// Discretisation of the lines: segments between L_min and L_max.
#pragma once

#include "dd/topology/topology_context.h"

namespace ddfem
{
/// Removes discretisation nodes with an arm shorter than L_min, or whose triangle with the neighbours is smaller than the
/// minimum area, if the joined segment is not longer than L_max; lets lines shorter than L_min between two surface nodes
/// leave; then halves segments longer than L_max. Nodes stay in their glide planes; physical nodes are not touched.
void remesh(TopologyContext &context);
} // namespace ddfem
