#pragma once

#include "fem/triangulation.h"

namespace ddfem::fem
{
/// Serial mesh of a circular cylinder with its axis along z, standing on z = 0: a square core with bulged sides
/// surrounded by rings, so that no cell has an angle above about 135 degrees. Boundary ids: side 0, bottom 1, top 2.
/// The side carries the cylindrical manifold with id 0. `n_across` cells across a diameter (at least 3, hit within
/// one), `n_along` along the axis.
void make_cylinder(SerialTriangulation &triangulation, double radius, double height, unsigned n_across,
                   unsigned n_along);
} // namespace ddfem::fem
