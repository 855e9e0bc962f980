// Which faces of the grain are flat, free and have the whole grain behind them: those that get analytic images.
#pragma once

#include "dd/forces/segment_points.h"
#include "dd/forces/surface_images.h"
#include "dd/geometry/grain_shape.h"

#include <set>
#include <vector>

namespace ddfem::coupling
{
/// Planes of the faces whose facets are coplanar and which have all vertices of the grain on one side (1e-6 of its diameter),
/// except the faces in @p held, whose displacements are prescribed, and faces in the plane of another one, ordered by id. A
/// platen is not free of tractions, and behind a re-entrant face a mirror image might lie in the grain.
std::vector<ImagePlane> image_planes(const std::vector<PolyhedronShape::Facet> &facets, const std::set<int> &held);

/// Longest edge of the facets of the given planes, nm: the element size at the surface.
double facet_size(const std::vector<PolyhedronShape::Facet> &facets, const std::vector<ImagePlane> &planes);

/// Length on which the images vary at a point: its depth under the nearest of @p planes (which must outlive the function) plus the core
/// radius @p a, at most @p depth plus @p a, nm.
SegmentPoints::SmoothLength smooth_length_under(const std::vector<ImagePlane> &planes, double depth, double a);
} // namespace ddfem::coupling
