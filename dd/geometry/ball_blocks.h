// Which of many balls are near a point.
#pragma once

#include "dd/common/types.h"

#include <span>
#include <vector>

namespace ddfem
{
struct Ball
{
  Vec3 centre;
  double radius; ///< nm
};

/// Balls in blocks of consecutive numbers, which are passed over as a whole: consecutive segments of a network are close together.
class BallBlocks
{
public:
  BallBlocks() = default;
  explicit BallBlocks(std::span<const Ball> balls);

  /// Appends the numbers, ascending, of the balls that the ball of @p radius around @p x touches, nm.
  void append_touching(const Vec3 &x, double radius, std::vector<unsigned> &numbers) const;

private:
  std::vector<Ball> all, blocks;
};
} // namespace ddfem
