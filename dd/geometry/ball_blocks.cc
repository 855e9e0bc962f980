#include "dd/geometry/ball_blocks.h"

#include <algorithm>

namespace ddfem
{
namespace
{
constexpr std::size_t block_size = 32;

bool touches(const Ball &s, const Vec3 &x, const double radius)
{
  const double reach = s.radius + radius;
  return (x - s.centre).squaredNorm() <= reach * reach;
}
} // namespace

BallBlocks::BallBlocks(const std::span<const Ball> balls) : all(balls.begin(), balls.end())
{
  for (std::size_t first = 0; first < all.size(); first += block_size)
  {
    const auto members = std::span(all).subspan(first, std::min(block_size, all.size() - first));
    Eigen::AlignedBox3d box;
    for (const Ball &s : members)
      box.extend(s.centre);
    double radius = 0;
    for (const Ball &s : members)
      radius = std::max(radius, (s.centre - box.center()).norm() + s.radius);
    blocks.push_back({box.center(), radius});
  }
}

void BallBlocks::append_touching(const Vec3 &x, const double radius, std::vector<unsigned> &numbers) const
{
  for (std::size_t block = 0; block < blocks.size(); ++block)
  {
    if (!touches(blocks[block], x, radius))
      continue;
    const std::size_t end = std::min(all.size(), (block + 1) * block_size);
    for (std::size_t k = block * block_size; k < end; ++k)
      if (touches(all[k], x, radius))
        numbers.push_back(static_cast<unsigned>(k));
  }
}
} // namespace ddfem
