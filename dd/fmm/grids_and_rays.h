// The root of the tree, and semi-infinite lines as its sources.
#pragma once

#include "dd/fmm/octree.h"

#include <span>
#include <vector>

namespace ddfem::fmm
{
/// Level of the boxes that get the field of distant rays as one local expansion: all points lie in eight of them, at the centre
/// of a root that is four times as wide as the body (see cut_rays()).
inline constexpr int level_of_distant_rays = 3;

/// Where @p ray is cut into segments, as ways from its origin, nm: from 0 to where it leaves @p grid. Pieces have at least the
/// length @p shortest (nm) and at most a quarter of the way from the origin: far pieces have no near points.
std::vector<double> cuts_of(const RaySource &ray, const RootGrid &grid, double shortest);

/// Appends the segments of a ray between @p cuts to @p lines; returns what is left beyond the last one.
RaySource cut_ray(const RaySource &ray, std::span<const double> cuts, std::vector<LineSource> &lines);

/// Root grid of a periodic cell from @p origin with edges @p lengths (nm): boxes that are nearly cubes, and that halved have about
/// @p lines_per_leaf of the sources (0: of any number), see fit_to_leaves().
RootGrid periodic_grid(const Vec3 &origin, const Vec3 &lengths, std::span<const SourceExtent> sources = {},
                       double lines_per_leaf = 0);

/// Root cube around the middles of sources, rays' origins and points; four times as wide if there are rays. @p lines_per_leaf: as above.
RootGrid enclosing_grid(std::span<const SourceExtent> sources, std::span<const RaySource> rays,
                        std::span<const Vec3> points, double lines_per_leaf = 0);
} // namespace ddfem::fmm
