// Networks that the benchmarks run on.
#pragma once

#include "dd/network/network.h"

#include <cstddef>
#include <vector>

namespace ddfem
{
/// Networks of Durocher's measurements (thesis, Bordeaux 2018), and how they move. @p t is the size, @p seed chooses among
/// equivalent networks.
struct MovingNetwork
{
  Network network;                ///< cleaned: in Morton order
  std::vector<Vec3> displacement; ///< per step, nm, by NodeIndex::value
  double width = 0;               ///< of the cube [0, width]^3, nm
};

/// Measurements of collisions, table III.6. Zirconium grain of size @p t: a cube of 2000 nm x cbrt(t) with 1e20 loops per
/// m^3 of 50 nm diameter on prismatic and basal planes (800 for t = 1; the table says per m^2), and 50 t pinned straight
/// lines of 150 to 1500 nm in basal planes. Segments of 3.3 nm, which the thesis does not state, give its 50 000 segments
/// per t. Its velocities come from a simulation and are not stated either: here loops and lines move as a whole by an
/// exponentially distributed distance of 0.1 nm per step in the mean, in their glide direction, and every node besides by
/// up to a tenth of that.
MovingNetwork irradiated_grain(double t, unsigned seed = 1);

/// Case 1 of the measurements of forces, table IV.3: 240 t Frank-Read sources of 500 to 1000 nm on all slip systems of
/// aluminium, with both signs of b, in a periodic cube of 2000 nm x cbrt(t). Segments of 6 nm (the thesis: 3 to 7.5) give
/// its 30 000 per t. Lines have any direction in their plane and bow out as parabolas, their middles by an exponentially
/// distributed distance of 0.1 nm per step in the mean.
MovingNetwork frank_read_sources(double t, unsigned seed = 1);

/// Case 2, table IV.4: 1e20 loops per m^3 of 10 nm diameter on prismatic planes of zirconium in a cube of 4000 nm x cbrt(t),
/// not periodic, and 10 t sources of 1000 nm in basal planes. Segments of 3 nm (the thesis: 2 to 5) give 67 000 per t (the
/// thesis: about 70 000). Loops move as a whole, sources bow out, as above.
MovingNetwork small_loops(double t, unsigned seed = 1);

/// About @p n_segments of 25 nm in loops of 16 at random in a cube, 4e13 per m^2 in the mean, in Morton order. @p clustered: nine tenths
/// of the loops in a tenth of the volume.
Network random_loops(std::size_t n_segments, bool clustered = false);
} // namespace ddfem
