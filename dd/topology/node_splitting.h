// Dissociation of nodes with many arms.
#pragma once

#include "dd/forces/nodal_forces.h"
#include "dd/topology/split_trial.h"
#include "dd/topology/topology_context.h"

#include <functional>

namespace ddfem
{
/// Nodal forces for the present network, computed only when some node can split.
using ForceFunction = std::function<NodalForces(const Network &)>;

/// Splits free nodes with four to eight arms into two nodes of two arms at least, so that the power F.V is the
/// largest (Bulatov & Cai, Computer Simulations of Dislocations, 2006, section 10.4). All partitions of the arms are
/// tried, each in the configuration that the split would make: the parts one and a half collision radii apart (less
/// at short arms) in directions that the glide planes of their arms allow, joined by a segment that carries the
/// Burgers vector the arms leave over, if any, with the forces of this configuration. The node splits into the parts
/// of largest power if that exceeds its own by the margin of @p model, and if in the trial configuration the parts
/// move apart by their own velocities.
///
/// @p forces is called once if some node can split. A node with an arm to one that has just been split waits for the next
/// call.
void split_nodes(TopologyContext &context, const SplittingModel &model, const ForceFunction &forces);
} // namespace ddfem
