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

/// Adds the stress of rays: ray_stress() to rounding.
void add_ray_stress(const IsotropicMedium &medium, const LineTable &rays, const StressBatch &batch);
void add_ray_stress(const IsotropicMedium &medium, const LineTable &rays, std::span<const unsigned> which,
                    const StressBatch &batch);
} // namespace ddfem
