// The cells of a uniform grid in free space or a periodic cell.
#pragma once

#include "dd/common/morton.h"
#include "dd/common/types.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace ddfem
{
/// Which cell of a uniform grid a point lies in. Along a periodic axis the cells divide the period and are counted from
/// the origin of the sample frame; along a free axis they start at the lowest point, and points outside the grid count
/// as in its outermost cell (such a projection never takes two points farther apart: neighbours stay neighbours).
class CellMap
{
public:
  using Cell = Eigen::Array<std::uint32_t, 3, 1>;

  CellMap() = default;
  /// Cells at least @p width (nm) wide around points in the box [lower, upper]; wider where the Morton index could not
  /// number them, narrower where the period is less. @p period is zero along free axes.
  CellMap(const Vec3 &lower, const Vec3 &upper, const Vec3 &period, double width);

  /// The image of @p x in the cell [0, period].
  Vec3 wrapped(const Vec3 &x) const
  {
    Vec3 y = x;
    for (int d = 0; d < 3; ++d)
      if (periodic_[d] && !(y[d] >= 0 && y[d] <= period_[d]))
        y[d] -= period_[d] * std::floor(y[d] / period_[d]);
    return y;
  }

  /// Cell of a wrapped point.
  Cell cell(const Vec3 &x) const
  {
    Cell c;
    for (int d = 0; d < 3; ++d)
      c[d] = static_cast<std::uint32_t>(std::clamp((x[d] - origin_[d]) * per_width_[d], 0.0, n_[d] - 1.0));
    return c;
  }

  std::uint64_t key(const Vec3 &x) const
  {
    const Cell c = cell(x);
    return morton_index(c[0], c[1], c[2]);
  }

  /// Squared distance of the nearest images of two wrapped points, nm^2.
  double squared_distance(double dx, double dy, double dz) const
  {
    const double x = nearest(dx, 0), y = nearest(dy, 1), z = nearest(dz, 2);
    return x * x + y * y + z * z;
  }

  /// f(key) for half of the cells that have a corner in common with @p c: of every two such cells, one visits the
  /// other.
  template <class F> void for_each_later_neighbour(const Cell &c, F &&f) const
  {
    const std::array<Steps, 3> steps{steps_along(0, c[0]), steps_along(1, c[1]), steps_along(2, c[2])};
    for (const auto &[i, j, k] : later_steps)
      if (steps[0].exists[i] && steps[1].exists[j] && steps[2].exists[k])
        f(steps[0].bits[i] | steps[1].bits[j] | steps[2].bits[k]);
  }

  /// Cells that a cube about a point touches: along each axis `count` from `first` on, the last of a periodic one
  /// followed by its first.
  struct Range
  {
    Cell first, count;
    double n_cells() const { return 1.0 * count[0] * count[1] * count[2]; }
  };
  /// Those of the cube of half width @p reach (nm) about the wrapped point @p x.
  Range around(const Vec3 &x, double reach) const;

  template <class F> void for_each_key(const Range &range, F &&f) const
  {
    const auto next = [this](int axis, std::uint32_t c) { return c + 1 < n_[axis] ? c + 1 : 0; };
    std::uint32_t x = range.first[0];
    for (std::uint32_t i = 0; i < range.count[0]; ++i, x = next(0, x))
    {
      const std::uint64_t bits_x = spread_bits(x);
      std::uint32_t y = range.first[1];
      for (std::uint32_t j = 0; j < range.count[1]; ++j, y = next(1, y))
      {
        const std::uint64_t bits_xy = bits_x | spread_bits(y) << 1;
        std::uint32_t z = range.first[2];
        for (std::uint32_t k = 0; k < range.count[2]; ++k, z = next(2, z))
          f(bits_xy | spread_bits(z) << 2);
      }
    }
  }

  /// One more than the highest bit that a Morton index of these cells can have.
  unsigned key_bits() const;

private:
  /// Of the 27 steps in a cube (0 back, 1 none, 2 on), those that come after the one that goes nowhere.
  static constexpr std::array<std::array<std::uint8_t, 3>, 13> later_steps{{{1, 1, 2},
                                                                            {1, 2, 0},
                                                                            {1, 2, 1},
                                                                            {1, 2, 2},
                                                                            {2, 0, 0},
                                                                            {2, 0, 1},
                                                                            {2, 0, 2},
                                                                            {2, 1, 0},
                                                                            {2, 1, 1},
                                                                            {2, 1, 2},
                                                                            {2, 2, 0},
                                                                            {2, 2, 1},
                                                                            {2, 2, 2}}};

  /// One cell back, none, and one on along an axis: what the coordinate contributes to the Morton index.
  struct Steps
  {
    std::array<std::uint64_t, 3> bits;
    std::array<bool, 3> exists;
  };
  Steps steps_along(int axis, std::uint32_t c) const
  {
    const std::uint32_t last = n_[axis] - 1;
    const bool closed = periodic_[axis] && last > 1; // two cells have only one step between them
    const auto bits = [axis](std::uint32_t k) { return spread_bits(k) << axis; };
    return {{bits(c > 0 ? c - 1 : last), bits(c), bits(c < last ? c + 1 : 0)},
            {c > 0 || closed, true, c < last || closed}};
  }

  /// Distance along an axis of two wrapped coordinates that differ by @p d; the period is infinite along free axes.
  double nearest(double d, int axis) const
  {
    const double a = std::abs(d);
    return std::min(a, period_[axis] - a);
  }

  Vec3 origin_ = Vec3::Zero(), period_ = Vec3::Constant(INFINITY), per_width_ = Vec3::Zero();
  Eigen::Array<bool, 3, 1> periodic_ = Eigen::Array<bool, 3, 1>::Constant(false);
  Cell n_ = Cell::Ones();
};
} // namespace ddfem
