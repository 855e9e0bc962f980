// Nodal forces of many lines on a segment, with the vector instructions of the processor that the program runs on.
#pragma once

#include "dd/elasticity/isotropic.h"
#include "dd/elasticity/line_table.h"
#include "dd/elasticity/segment_force.h"

#include <cstddef>
#include <limits>

namespace ddfem
{
/// No line is left out.
inline constexpr std::size_t no_line = std::numeric_limits<std::size_t>::max();

/// Sum of the forces (MPa nm^2) of all segments of a table, but not of number @p without, on the nodes of segment @p x3 ->
/// @p x4 (nm) with Burgers vector @p b34 (nm): segment_force() of each, with the same Gauss points, to rounding.
///
/// Sources in neighbouring lanes share the loop over the points of a single panel; those near enough to need a graded partition
/// are taken one by one, with their points in the lanes. Parallel pairs need no treatment of their own. The order of the sum
/// depends on the table, the segment and the instruction set only.
SegmentForces force_of_segments(const IsotropicMedium &medium, const LineTable &segments, const Vec3 &x3,
                                const Vec3 &x4, const Vec3 &b34, double tolerance, std::size_t without = no_line);
/// The same by a Gauss rule of @p n_gauss points for every pair, near ones included: what the stress at these points gives.
SegmentForces force_of_segments_by_rule(const IsotropicMedium &medium, const LineTable &segments, const Vec3 &x3,
                                        const Vec3 &x4, const Vec3 &b34, int n_gauss);

/// The same for rays: segment_force_from_ray() of each.
SegmentForces force_of_rays(const IsotropicMedium &medium, const LineTable &rays, const Vec3 &x3, const Vec3 &x4,
                            const Vec3 &b34, double tolerance);
} // namespace ddfem
