// Grain of any shape, convex or re-entrant, bounded by the facets of a mesh.
#pragma once

#include "dd/geometry/facet_tree.h"
#include "dd/geometry/grain_shape.h"

namespace ddfem
{
/// Body inside a closed surface of triangles. The signed distance is exact: that of the nearest triangle, with the sign of
/// the side of its nearest point that x is on, told by the angle-weighted normals of corners and the summed normals of
/// edges (Baerentzen & Aanaes, IEEE Trans. Vis. Comput. Graph. 11 (2005) 243). A query costs about a microsecond.
class SurfaceMeshShape final : public GrainShape
{
public:
  using Facet = PolyhedronShape::Facet;
  /// @p facets: polygons whose corners run in order around them, all counter-clockwise or all clockwise seen from
  /// outside; a polygon that is not plane is divided about its centre. Throws std::invalid_argument that names a point
  /// if the surface is not closed or its facets are not oriented alike.
  explicit SurfaceMeshShape(const std::vector<Facet> &facets);
  double signed_distance(const Vec3 &x) const override;
  /// Away from the surface, the direction along which the signed distance grows.
  Vec3 outward_normal(const Vec3 &x) const override;
  int face(const Vec3 &x) const override;
  double volume() const override { return enclosed_volume; }
  bool is_convex() const override { return convex; }
  Vec3 lower_corner() const override { return lower; }
  Vec3 upper_corner() const override { return upper; }

private:
  void add_triangles(const std::vector<Facet> &facets);
  void find_normals();
  Vec3 pseudonormal(const NearestPoint &p) const;

  FacetTree tree;
  std::vector<int> face_ids; ///< by triangle, as below
  std::vector<Vec3> normals;
  std::vector<std::array<Vec3, 3>> edge_normals;   ///< edge k runs from corner k to corner k + 1
  std::vector<std::array<Vec3, 3>> corner_normals; ///< not normalised
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();
  double enclosed_volume = 0;
  bool convex = true;
};
} // namespace ddfem
