// Numbers of Gauss points for the forces of many lines on a segment. Internal to dd/elasticity/vectorised.
#pragma once

#include "dd/elasticity/line_table.h"

#include <cstddef>

namespace ddfem::internal
{
/// The segment on which forces are wanted: ends, unit direction, Burgers vector, length (nm).
struct ForceTarget
{
  Vec3 x3, x4, t, b;
  double length;
};

/// n[i]: number of Gauss points of a single panel for line i of @p n_blocks blocks from @p first on; 0 if it needs a graded
/// partition. @p a: core radius, nm. To be called for segments or for rays.
void plan_for_segments(const LineTable &lines, std::size_t first, std::size_t n_blocks, const ForceTarget &target,
                       double a, double tolerance, double *n);
void plan_for_rays(const LineTable &lines, std::size_t first, std::size_t n_blocks, const ForceTarget &target, double a,
                   double tolerance, double *n);
} // namespace ddfem::internal
