// Displacement of many triangular loops at many points, with the vector instructions of the processor that the program
// runs on.
#pragma once

#include "dd/elasticity/triangular_loop.h"

#include <cstddef>
#include <span>
#include <vector>

namespace ddfem
{
/// Points and the displacements at them, component by component.
struct DisplacementBatch
{
  std::size_t n;      ///< number of points
  const double *x[3]; ///< coordinates, nm
  double *u[3];       ///< nm
};

/// The displacement (nm) of all loops at points, threaded; independent of the number of threads.
std::vector<Vec3> triangle_displacements(double nu, std::span<const TriangularLoop> loops,
                                         std::span<const Vec3> points);

/// Adds the displacement of all loops at all points: triangle_displacement() of each with @p reference_length (nm), to rounding.
/// The sum at a point runs over the loops in their order and does not depend on the other points.
void add_triangle_displacement(double nu, std::span<const TriangularLoop> loops, const DisplacementBatch &batch,
                               double reference_length = 1.0);
} // namespace ddfem
