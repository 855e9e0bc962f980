// Stress of many straight lines at many points, with the vector instructions of the processor that the program runs on.
#pragma once

#include "dd/elasticity/isotropic.h"
#include "dd/elasticity/line_table.h"
#include "dd/elasticity/point_batch.h"

#include <span>

namespace ddfem
{
/// Adds the stress of all segments of a table at all points: segment_stress() to rounding. The sum at a point runs over the
/// segments in their order and does not depend on the other points.
void add_segment_stress(const IsotropicMedium &medium, const LineTable &segments, const StressBatch &batch);
/// The same of some of the segments, by their numbers.
void add_segment_stress(const IsotropicMedium &medium, const LineTable &segments, std::span<const unsigned> which,
                        const StressBatch &batch);

/// The same for points that are farther from the segments than half the length of each: fewer operations.
void add_distant_segment_stress(const IsotropicMedium &medium, const LineTable &segments,
                                std::span<const unsigned> which, const StressBatch &batch);
/// The same in single precision. With points and lines within a few @p unit (nm) of @p origin, the error relative to a segment's stress
/// is some 1e-6 times @p unit over its distance from the point. @p which: ascending.
void add_single_precision_stress(const IsotropicMedium &medium, const LineTable &segments,
                                 std::span<const unsigned> which, const Vec3 &origin, double unit,
                                 const StressBatch &batch);

/// Adds the stress of rays: ray_stress() to rounding.
void add_ray_stress(const IsotropicMedium &medium, const LineTable &rays, const StressBatch &batch);
void add_ray_stress(const IsotropicMedium &medium, const LineTable &rays, std::span<const unsigned> which,
                    const StressBatch &batch);
} // namespace ddfem
