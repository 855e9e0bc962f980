#include "dd/topology/collisions/cell_map.h"

#include <bit>

namespace ddfem
{
CellMap::CellMap(const Vec3 &lower, const Vec3 &upper, const Vec3 &period, double width)
{
  constexpr double most = 1U << morton_bits;
  for (int d = 0; d < 3; ++d)
  {
    periodic_[d] = period[d] > 0;
    const double extent = periodic_[d] ? period[d] : std::max(upper[d] - lower[d], 0.0);
    double n = std::clamp(std::floor(extent / width), 1.0, most);
    double size = extent / n;
    if (periodic_[d])
      period_[d] = period[d];
    else
    {
      size = std::max(width, size);
      n = std::clamp(std::floor(extent / size) + 1, 1.0, most);
      origin_[d] = lower[d];
    }
    n_[d] = static_cast<std::uint32_t>(n);
    per_width_[d] = 1 / size;
  }
}

CellMap::Range CellMap::around(const Vec3 &x, double reach) const
{
  Range range;
  for (int d = 0; d < 3; ++d)
  {
    // A little more than asked for: the rounding of the image and of the division must not cost a cell.
    const double n = n_[d], slack = 1e-9;
    double low = std::floor((x[d] - reach - origin_[d]) * per_width_[d] - slack);
    double high = std::floor((x[d] + reach - origin_[d]) * per_width_[d] + slack);
    if (!periodic_[d])
    {
      low = std::clamp(low, 0.0, n - 1);
      high = std::clamp(high, 0.0, n - 1);
    }
    else if (high - low >= n - 1)
    {
      low = 0;
      high = n - 1;
    }
    range.first[d] = static_cast<std::uint32_t>(low - n * std::floor(low / n));
    range.count[d] = static_cast<std::uint32_t>(high - low + 1);
  }
  return range;
}

unsigned CellMap::key_bits() const
{
  return 3U * static_cast<unsigned>(std::bit_width(n_.maxCoeff() - 1U));
}
} // namespace ddfem
