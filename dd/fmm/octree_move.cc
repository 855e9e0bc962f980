#include "dd/fmm/octree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ddfem::fmm
{
namespace
{
/// Numbers of things in each box.
std::vector<std::uint32_t> count(const std::span<const std::uint32_t> box_of, const std::size_t n_boxes)
{
  std::vector<std::uint32_t> n(n_boxes, 0);
  for (const std::uint32_t box : box_of)
    ++n[box];
  return n;
}

/// Order by the boxes' first positions, stable. @p next: these positions, and afterwards those behind the last.
std::vector<std::uint32_t> order_of(const std::span<const std::uint32_t> box_of, std::vector<std::uint32_t> next)
{
  std::vector<std::uint32_t> order(box_of.size());
  for (std::size_t i = 0; i < box_of.size(); ++i)
    order[next[box_of[i]]++] = static_cast<std::uint32_t>(i);
  return order;
}
} // namespace

void Octree::move(const std::span<const SourceExtent> sources, const std::span<const std::uint32_t> box_of_line,
                  const std::span<const std::uint32_t> leaf_of_point)
{
  const auto own_lines = count(box_of_line, all.size()), own_points = count(leaf_of_point, all.size());
  std::uint32_t next_line = 0, next_point = 0;
  for (std::size_t root = 0; root < level_begin[1]; ++root)
    number_contents(root, own_lines, own_points, next_line, next_point);
  std::vector<std::uint32_t> first_line, first_point;
  for (const Box &box : all)
  {
    first_line.push_back(box.lines_begin);
    first_point.push_back(box.points_begin);
  }
  line_at = order_of(box_of_line, std::move(first_line));
  point_at = order_of(leaf_of_point, std::move(first_point));
  place_spheres(sources);
  measure_overhang();
}

/// In the order of division: what a box holds itself, then its children.
void Octree::number_contents(const std::size_t index, const std::span<const std::uint32_t> own_lines,
                             const std::span<const std::uint32_t> own_points, std::uint32_t &next_line,
                             std::uint32_t &next_point)
{
  Box &box = all[index];
  box.lines_begin = next_line;
  box.own_lines_end = next_line += own_lines[index];
  box.points_begin = next_point;
  next_point += own_points[index];
  for (std::size_t i = box.first_child; i < box.first_child + box.n_children; ++i)
    number_contents(i, own_lines, own_points, next_line, next_point);
  box.lines_end = next_line;
  box.points_end = next_point;
}

std::vector<std::uint32_t> Octree::boxes_of_lines() const
{
  std::vector<std::uint32_t> box_of(line_at.size());
  for (std::uint32_t box = 0; box < all.size(); ++box)
    for (std::uint32_t k = all[box].lines_begin; k < all[box].own_lines_end; ++k)
      box_of[line_at[k]] = box;
  return box_of;
}

std::uint32_t Octree::leaf_at(const Vec3 &x) const
{
  const auto nearest = [&](const std::uint32_t begin, const std::uint32_t end)
  {
    std::uint32_t best = begin;
    double distance = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = begin; i < end; ++i)
      if (const double d = distance_outside(i, x); made_with[i].n_points > 0 && d < distance)
      {
        best = i;
        distance = d;
      }
    return best;
  };
  auto box = static_cast<std::uint32_t>(root_at(x));
  if (made_with[box].n_points == 0)
    box = nearest(0, level_begin[1]);
  while (!all[box].is_leaf())
  {
    const std::uint32_t begin = all[box].first_child, end = begin + all[box].n_children;
    // The octant as in divide(), so that a point that has not moved stays.
    std::array<std::int32_t, 3> place{};
    for (std::size_t c = 0; c < 3; ++c)
      place[c] = 2 * all[box].place[c] + (x[static_cast<int>(c)] >= centres[box][static_cast<int>(c)] ? 1 : 0);
    std::uint32_t child = begin;
    while (child < end && (all[child].place != place || made_with[child].n_points == 0))
      ++child;
    box = child < end ? child : nearest(begin, end);
  }
  return box;
}

std::optional<std::uint32_t> Octree::box_for_line(const Vec3 &middle, const double length) const
{
  std::optional<std::uint32_t> smallest;
  auto box = static_cast<std::uint32_t>(root_at(middle));
  while (distance_outside(box, middle) == 0 &&
         (all[box].level == 0 || length <= settings.longest_line * size(all[box])))
  {
    if (had_lines[box] != 0)
      smallest = box;
    const std::uint32_t begin = all[box].first_child, end = begin + all[box].n_children;
    std::uint32_t child = begin;
    while (child < end && distance_outside(child, middle) > 0)
      ++child;
    if (child == end)
      break;
    box = child;
  }
  return smallest;
}

double Octree::distance_outside(const std::size_t box, const Vec3 &x) const
{
  const Vec3 half = 0.5 * edges(all[box]);
  return ((x - centres[box]).cwiseAbs() - half).cwiseMax(0.0).norm();
}
} // namespace ddfem::fmm
