// A triangular dislocation loop, prepared for evaluation at many points.
#pragma once

#include "dd/elasticity/triangle_displacement.h"

#include <array>

namespace ddfem
{
/// What all points share. Vertices may lie at infinity; the first one does not (they are turned until it does not).
struct TriangularLoop
{
  /// Edge that adds to the field: between finite vertices, or a ray from a finite one; those at infinity add a constant,
  /// which is dropped, and those of length zero nothing.
  struct Edge
  {
    unsigned from = 0, to = 0; ///< numbers of the vertices; `from` is finite
    double sign = 0.0;         ///< -1: the way back along a ray; 0: nothing to add
    double length = 0.0;       ///< nm; 0: a ray
    Vec3 t = Vec3::Zero();     ///< unit direction away from `from`
    Vec3 b_cross_t = Vec3::Zero();
  };

  std::array<LoopVertex, 3> vertices;
  std::array<Edge, 3> edges;
  Vec3 normal; ///< product of the edges (or directions at infinity) that leave the first vertex
  Vec3 burgers;

  /// At least one vertex must be finite.
  TriangularLoop(const LoopVertex &v1, const LoopVertex &v2, const LoopVertex &v3, const Vec3 &b);

  /// Of a loop without vertices at infinity: centre and radius (nm) of a ball around it, for thin triangles the smallest one.
  Vec3 middle() const;
  double radius() const { return radius_about(middle()); }

private:
  double radius_about(const Vec3 &x) const;
};
} // namespace ddfem
