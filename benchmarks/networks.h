// Networks that the benchmarks run on.
#pragma once

#include "dd/network/network.h"

#include <cstddef>
#include <vector>

namespace ddfem
{
/// Network of Durocher's measurements of collisions (thesis, Bordeaux 2018, table III.6), and its motion.
struct IrradiatedGrain
{
  Network network;                ///< cleaned: in Morton order
  std::vector<Vec3> displacement; ///< per step, nm, by NodeIndex::value
};

/// Zirconium grain of size @p t: a cube of 2000 nm x cbrt(t) with 1e20 loops per m^3 of 50 nm diameter on prismatic and
/// basal planes (800 for t = 1; the table says per m^2), and 50 t pinned straight lines of 150 to 1500 nm in basal
/// planes. Segments of 3.3 nm, which the thesis does not state, give its 50 000 segments per t. Its velocities come
/// from a simulation and are not stated either: here loops and lines move as a whole by an exponentially distributed
/// distance of 0.1 nm per step in the mean, in their glide direction, and every node besides by up to a tenth of that.
/// @p seed chooses among equivalent networks.
IrradiatedGrain irradiated_grain(double t, unsigned seed = 1);
} // namespace ddfem
