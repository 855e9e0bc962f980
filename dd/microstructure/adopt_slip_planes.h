// Names of the glide planes of a network that was read from a file.
#pragma once

#include "dd/crystal/slip_systems.h"
#include "dd/network/network.h"

namespace ddfem
{
/// Gives every glide plane without Miller indices whose normal is that of a slip plane of the crystal, to 1e-4 rad, the
/// indices and the exact normal of that slip plane, so that it is the same kind of plane as those of sources and
/// products. Nodes are moved onto the new planes: by 1e-4 of the extent of the line at most. Planes that match none are
/// left alone. Lines that wind around a periodic cell have planes that are images of each other: their normals must be
/// exact to start with.
void adopt_slip_planes(Network &network, const SlipSystems &systems);
} // namespace ddfem
