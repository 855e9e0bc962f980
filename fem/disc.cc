#include "fem/disc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ddfem::fem
{
namespace
{
/// Side of the core that faces +x; t in [-1, 1]. Between a square and a circle in shape.
dealii::Point<2> core_side(double t)
{
  const double angle = t * std::numbers::pi / 4;
  const double radius = 0.52 + 0.10 * t * t;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Core, by transfinite interpolation between its four sides; s, t in [-1, 1].
dealii::Point<2> core_point(double s, double t)
{
  const auto right = core_side(t), top = core_side(s), corner = core_side(1.);
  // x: +-right[0] at s = +-1 and top[1] at t = +-1 are both met once their common part s * corner[0] is taken off; y
  // likewise.
  return {s * right[0] + top[1] - s * corner[0], t * top[0] + right[1] - t * corner[1]};
}
} // namespace

Disc make_disc(unsigned n_across)
{
  const unsigned m = std::max(1u, (n_across + 2) / 4);
  const unsigned n = std::max(1u, n_across > 2 * m ? n_across - 2 * m : 1u);
  Disc disc;
  const auto coordinate = [n](unsigned i) { return -1. + 2. * i / n; };
  for (unsigned j = 0; j <= n; ++j)
  {
    for (unsigned i = 0; i <= n; ++i)
    {
      disc.points.push_back(core_point(coordinate(i), coordinate(j)));
    }
  }
  const auto core = [n](unsigned i, unsigned j) { return j * (n + 1) + i; };
  for (unsigned j = 0; j < n; ++j)
  {
    for (unsigned i = 0; i < n; ++i)
    {
      disc.quads.push_back({core(i, j), core(i + 1, j), core(i, j + 1), core(i + 1, j + 1)});
    }
  }
  // Rim of the core, counter-clockwise from its lower right corner: position k is at the angle -45 deg + k 90 deg / n.
  std::vector<unsigned> rim;
  for (unsigned side = 0; side < 4; ++side)
  {
    for (unsigned k = 0; k < n; ++k)
    {
      const std::array<unsigned, 4> along = {n, n - k, 0, k}, up = {k, n, n - k, 0};
      rim.push_back(core(along[side], up[side]));
    }
  }
  std::vector<unsigned> inner = rim;
  for (unsigned layer = 1; layer <= m; ++layer)
  {
    std::vector<unsigned> outer;
    for (unsigned k = 0; k < 4 * n; ++k)
    {
      const double angle = std::numbers::pi / 4 * (2. * k / n - 1.);
      const dealii::Point<2> end(std::cos(angle), std::sin(angle));
      const double w = static_cast<double>(layer) / m;
      outer.push_back(static_cast<unsigned>(disc.points.size()));
      disc.points.push_back(dealii::Point<2>((1. - w) * disc.points[rim[k]] + w * end));
    }
    for (unsigned k = 0; k < 4 * n; ++k)
    {
      const unsigned next = (k + 1) % (4 * n);
      disc.quads.push_back({inner[k], outer[k], inner[next], outer[next]});
    }
    inner = outer;
  }
  disc.rim = inner;
  return disc;
}
} // namespace ddfem::fem
