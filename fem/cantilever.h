#pragma once

#include "fem/triangulation.h"

#include <array>

namespace ddfem::fem
{
/// Serial mesh of a beam along x (edge lengths @p beam, nm, @p n cells) that grows from the middle of the face x+ of a root block
/// (edge lengths @p block), whose lowest corner is the origin; the block's cells are about as large as those of the beam. Boundary
/// ids: free end of the beam 0, face x- of the block 1, sides of the beam y-, y+, z-, z+ 2..5, the rest of the block 6.
void make_cantilever(SerialTriangulation &triangulation, const std::array<double, 3> &beam,
                     const std::array<double, 3> &block, const std::array<unsigned, 3> &n);
} // namespace ddfem::fem
