#include "dd/forces/lines_in_boxes.h"

#include <algorithm>
#include <limits>

namespace ddfem
{
namespace
{
/// How far the middle of a line may lie outside its box, in box sizes.
constexpr double farthest_of_box = 0.25;
} // namespace

void LinesInBoxes::drop_corrections()
{
  lines.resize(n_of_system);
  box.resize(n_of_system);
  corrections.clear();
  ray_corrections.clear();
}

bool LinesInBoxes::stays(const Vec3 &middle, const std::uint32_t in_box, const fmm::Octree &tree)
{
  const double outside = tree.distance_outside(in_box, middle) / tree.size(tree.boxes()[in_box]);
  farthest = std::max(farthest, outside);
  return outside <= farthest_of_box;
}

std::uint32_t LinesInBoxes::box_of_new(const fmm::LineSource &line, const fmm::Octree &tree)
{
  const auto found = tree.box_for_line(0.5 * (line.start + line.end), (line.end - line.start).norm());
  // Without a box of its own a line is distant for all points in the root, whose moments cannot hold it, though.
  if (!found)
    farthest = std::numeric_limits<double>::infinity();
  corrections.push_back({line, found.value_or(0)});
  return found.value_or(0);
}
} // namespace ddfem
