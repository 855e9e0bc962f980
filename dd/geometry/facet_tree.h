// Nearest triangle of a surface, by a tree of axis-parallel boxes.
#pragma once

#include "dd/common/types.h"

#include <array>
#include <cstdint>
#include <vector>

namespace ddfem
{
using TriangleCorners = std::array<Vec3, 3>;

/// Which part of a triangle is nearest to a point: its inside, the edge from corner k to corner k + 1, or corner k.
enum class TriangleFeature : std::uint8_t
{
  inside,
  edge_0,
  edge_1,
  edge_2,
  corner_0,
  corner_1,
  corner_2,
};

struct NearestPoint
{
  Vec3 point = Vec3::Zero(); ///< of the triangle, nm
  double squared_distance = 0;
  TriangleFeature feature = TriangleFeature::inside;
  std::uint32_t triangle = 0; ///< index
};

/// Point of the triangle nearest to @p x (Ericson, Real-Time Collision Detection, 2005, section 5.1.5); `triangle` is 0.
NearestPoint nearest_point_of_triangle(const Vec3 &x, const TriangleCorners &triangle);

/// Triangles in a binary tree of bounding boxes, split at the median of their centres along the longest axis. A query takes
/// of the order of log(number of triangles) distances.
class FacetTree
{
public:
  FacetTree() = default;
  explicit FacetTree(std::vector<TriangleCorners> triangles);

  /// The nearest triangle and its nearest point; of equally near ones always the same. There must be a triangle.
  NearestPoint nearest(const Vec3 &x) const;
  const std::vector<TriangleCorners> &triangles() const { return corners; }

private:
  struct Box
  {
    Vec3 lower, upper;
    std::uint32_t first = 0, count = 0; ///< of a leaf: its range of `order`
    std::uint32_t second_child = 0;     ///< of an inner box; the first child follows it
  };
  void build(std::uint32_t first, std::uint32_t count);

  std::vector<TriangleCorners> corners;
  std::vector<std::uint32_t> order; ///< triangles, leaf by leaf
  std::vector<Box> boxes;
};
} // namespace ddfem
