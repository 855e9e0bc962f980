#include "dd/crystal/orientation.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace ddfem
{
namespace
{
int index_of(SampleAxis axis)
{
  return static_cast<int>(axis);
}

void require_direction(const Miller &m)
{
  if (is_zero(m))
    throw std::invalid_argument("The crystal direction of a sample axis is [000]; at least one index must not be "
                                "zero.");
}

/// Orthogonal direction of smallest indices; see Orientation::from_loading_axis for ties.
Miller smallest_orthogonal(const Miller &axis)
{
  const Miller direction = reduced(axis);
  std::optional<Miller> best;
  // (k, -h, 0) and its permutations are orthogonal, so indices up to the largest of the axis are enough.
  const int n = std::max({std::abs(direction[0]), std::abs(direction[1]), std::abs(direction[2]), 1});
  for (int h = n; h >= -n; --h)
    for (int k = n; k >= -n; --k)
    {
      // Solve for the third index, to keep the search two-dimensional.
      const long rest = long{direction[0]} * h + long{direction[1]} * k;
      if (direction[2] != 0 && rest % direction[2] != 0)
        continue;
      if (direction[2] == 0 && rest != 0)
        continue;
      const long l = direction[2] != 0 ? -rest / direction[2] : (h == 0 && k == 0 ? 1 : 0);
      if (std::labs(l) > n)
        continue;
      const Miller candidate = {h, k, static_cast<int>(l)};
      if (!is_zero(candidate) && (!best || dot(candidate, candidate) < dot(*best, *best)))
        best = candidate;
    }
  return *best;
}
} // namespace

Orientation Orientation::from_axes(SampleAxis axis_a, const Miller &a, SampleAxis axis_b, const Miller &b,
                                   const UnitCell &cell)
{
  require_direction(a);
  require_direction(b);
  if (axis_a == axis_b)
    throw std::invalid_argument("Two crystal directions are given for the same sample axis; name two different axes.");
  const Vec3 unit_a = cell.direction(a).normalized(), unit_b = cell.direction(b).normalized();
  if (!cell.orthogonal(a, b))
  {
    const double angle = std::acos(unit_a.dot(unit_b)) * 180 / std::numbers::pi;
    throw std::invalid_argument("The crystal directions " + cell.direction_name(a) + " and " + cell.direction_name(b) +
                                " of two sample axes enclose " + std::to_string(angle) +
                                " degrees; they must be orthogonal.");
  }
  const int ia = index_of(axis_a), ib = index_of(axis_b), ic = 3 - ia - ib;
  Mat3 rotation;
  rotation.row(ia) = unit_a;
  rotation.row(ib) = unit_b;
  const Vec3 third = rotation.row(ia).cross(rotation.row(ib));
  rotation.row(ic) = (ib == (ia + 1) % 3 ? third : Vec3(-third)).normalized();
  return {rotation, cell};
}

Orientation Orientation::from_loading_axis(const Miller &direction, SampleAxis axis)
{
  require_direction(direction);
  const auto next = static_cast<SampleAxis>((index_of(axis) + 1) % 3);
  return from_axes(axis, direction, next, smallest_orthogonal(direction));
}

Orientation Orientation::from_rotation(const Mat3 &rotation, const UnitCell &cell)
{
  constexpr double tolerance = 1e-9;
  if (!((rotation * rotation.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < tolerance) ||
      rotation.determinant() < 0)
    throw std::invalid_argument("The matrix given as crystal orientation is not a proper rotation: its rows must be "
                                "orthonormal and its determinant +1.");
  return {rotation, cell};
}
} // namespace ddfem
