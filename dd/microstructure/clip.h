// Lines that reach out of the grain are cut at its surface.
#pragma once

#include "dd/geometry/grain_shape.h"
#include "dd/network/network.h"

namespace ddfem
{
/// Removes what lies outside @p shape. Where a line passes through the surface it ends in a surface node, on the glide
/// plane and on the surface to 1e-12 of the grain's diameter. Ways in and out nearer to each other than @p resolution (nm) may be
/// overlooked. Lines in the surface itself count as outside. Sweeps nothing: the state is an initial one.
void clip_to_grain(Network &network, const GrainShape &shape, double resolution);
} // namespace ddfem
