// The network at t = 0.
#pragma once

#include "coupling/parameters.h"
#include "dd/geometry/grain_shape.h"
#include "dd/network/network.h"
#include "dd/topology/topology_context.h"

#include <string>
#include <vector>

namespace ddfem::coupling
{
/// Builds the network of the input: sources, loops, network file. Throws InputError for Burgers vectors of gliding
/// lines that the crystal does not have, for a file whose cell is not that of the input, and for violated invariants.
Network build_network(const Parameters &parameters);

/// Throws InputError naming the first nodes that lie outside the grain, or inside but marked as surface nodes. Surface
/// nodes within 1e-3 of the grain's diameter of the surface are put onto it.
void fit_into_grain(Network &network, const GrainShape &shape, double min_segment);
} // namespace ddfem::coupling
