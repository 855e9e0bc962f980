// From the requested error to the order of the expansions.
#pragma once

#include "dd/common/types.h"

namespace ddfem::fmm
{
/// Order of the expansions for a requested error of the far stress, relative to its rms. @throws std::invalid_argument
/// unless 1e-8 <= @p tolerance <= 0.1.
int expansion_order(double tolerance);

/// Order that boxes at @p distance (between centres, in edges of cubes) need for the error that boxes at distance 2 have at
/// @p order.
int order_at_distance(int order, double distance);

/// Distance between boxes of given @p edges over the edge of a cube with the same diagonal: what the error depends on. Same unit of
/// @p shift and @p edges.
double distance_in_cubes(const Vec3 &shift, const Vec3 &edges);

/// Longest lines of a box, in box sizes. Half of a line may lie outside the box: towards a box at distance 2, the expansion of one
/// across a corner converges as 0.98^order with lines of half the box, as 0.87^order with a quarter, 0.82^order with an eighth.
double longest_line(double tolerance);

/// Smallest boxes (nm) whose expansions may leave out the core beyond its second order: of relative order (a/d)^4, at distances d of two
/// boxes and more.
double smallest_box(double core_radius, double tolerance);

/// Cost of a translation of given order in evaluations of a segment at a point: measured on one core with AVX-512.
/// A constant, so that the tree and all results are the same in every run.
double translation_cost(int order);

/// The same of a translation that integrates (half_line_translation.h), in evaluations of the image of a segment at a point.
double half_line_translation_cost(int source_order, int target_order);
} // namespace ddfem::fmm
