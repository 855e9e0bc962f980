#include "dd/geometry/facet_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace ddfem
{
namespace
{
constexpr std::uint32_t leaf_size = 4;

double squared_distance_to_box(const Vec3 &x, const Vec3 &lower, const Vec3 &upper)
{
  return (x - x.cwiseMax(lower).cwiseMin(upper)).squaredNorm();
}

NearestPoint at(const Vec3 &x, const Vec3 &point, const TriangleFeature feature)
{
  return {point, (x - point).squaredNorm(), feature, 0};
}
} // namespace

NearestPoint nearest_point_of_triangle(const Vec3 &x, const TriangleCorners &triangle)
{
  const Vec3 &a = triangle[0], &b = triangle[1], &c = triangle[2];
  const Vec3 ab = b - a, ac = c - a;
  const double d1 = ab.dot(x - a), d2 = ac.dot(x - a);
  if (d1 <= 0 && d2 <= 0)
    return at(x, a, TriangleFeature::corner_0);
  const double d3 = ab.dot(x - b), d4 = ac.dot(x - b);
  if (d3 >= 0 && d4 <= d3)
    return at(x, b, TriangleFeature::corner_1);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0)
    return at(x, a + d1 / (d1 - d3) * ab, TriangleFeature::edge_0);
  const double d5 = ab.dot(x - c), d6 = ac.dot(x - c);
  if (d6 >= 0 && d5 <= d6)
    return at(x, c, TriangleFeature::corner_2);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0)
    return at(x, a + d2 / (d2 - d6) * ac, TriangleFeature::edge_2);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return at(x, b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), TriangleFeature::edge_1);
  const double sum = va + vb + vc;
  return at(x, a + vb / sum * ab + vc / sum * ac, TriangleFeature::inside);
}

FacetTree::FacetTree(std::vector<TriangleCorners> triangles) : corners(std::move(triangles)), order(corners.size())
{
  std::iota(order.begin(), order.end(), 0U);
  boxes.reserve(corners.size());
  build(0, static_cast<std::uint32_t>(corners.size()));
}

void FacetTree::build(const std::uint32_t first, const std::uint32_t count)
{
  Box box{Vec3::Constant(std::numeric_limits<double>::infinity()),
          Vec3::Constant(-std::numeric_limits<double>::infinity()), first, count, 0};
  for (std::uint32_t k = first; k < first + count; ++k)
    for (const Vec3 &x : corners[order[k]])
    {
      box.lower = box.lower.cwiseMin(x);
      box.upper = box.upper.cwiseMax(x);
    }
  const auto index = static_cast<std::uint32_t>(boxes.size());
  boxes.push_back(box);
  if (count <= leaf_size)
    return;
  Eigen::Index axis = 0;
  (box.upper - box.lower).maxCoeff(&axis);
  const auto centre = [&](const std::uint32_t t)
  { return corners[t][0][axis] + corners[t][1][axis] + corners[t][2][axis]; };
  const auto begin = order.begin() + first;
  const std::uint32_t half = count / 2;
  std::nth_element(begin, begin + half, begin + count,
                   [&](const std::uint32_t s, const std::uint32_t t)
                   { return std::pair(centre(s), s) < std::pair(centre(t), t); });
  boxes[index].count = 0;
  build(first, half);
  boxes[index].second_child = static_cast<std::uint32_t>(boxes.size());
  build(first + half, count - half);
}

NearestPoint FacetTree::nearest(const Vec3 &x) const
{
  NearestPoint best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  struct Task
  {
    std::uint32_t box;
    double squared_distance;
  };
  std::array<Task, 64> stack; // twice the depth of a balanced tree of 2^32 triangles
  std::size_t n = 0;
  stack[n++] = {0, 0};
  while (n > 0)
  {
    const Task task = stack[--n];
    if (task.squared_distance > best.squared_distance)
      continue;
    const Box &box = boxes[task.box];
    for (std::uint32_t k = box.first; k < box.first + box.count; ++k)
    {
      NearestPoint candidate = nearest_point_of_triangle(x, corners[order[k]]);
      candidate.triangle = order[k];
      if (std::pair(candidate.squared_distance, candidate.triangle) < std::pair(best.squared_distance, best.triangle))
        best = candidate;
    }
    if (box.count > 0)
      continue;
    Task near{task.box + 1, 0}, far{box.second_child, 0};
    for (Task *t : {&near, &far})
      t->squared_distance = squared_distance_to_box(x, boxes[t->box].lower, boxes[t->box].upper);
    if (far.squared_distance < near.squared_distance)
      std::swap(near, far);
    stack[n++] = far;
    stack[n++] = near;
  }
  return best;
}
} // namespace ddfem
