// Random loops in random grains, moved until they have left.
#include "tests/dd/topology/surface_loops.h"

#include <gtest/gtest.h>

namespace ddfem
{
namespace
{
class RandomLoopsIn : public testing::TestWithParam<int>
{
};

TEST_P(RandomLoopsIn, ArriveSlideAndLeaveWithoutLosingFluxOrArea)
{
  std::size_t left = 0, exits = 0;
  for (std::uint64_t k = 0; k < 43; ++k)
  {
    const DrawResult r = run_draw(100000 * n_grain_kinds + k * n_grain_kinds + static_cast<std::uint64_t>(GetParam()),
                                  200, k % 2 == 0 ? Placement::anywhere : Placement::at_edges);
    EXPECT_EQ(r.failure, "");
    left += r.left ? 1 : 0;
    exits += r.counts.surface_exits;
  }
  EXPECT_GT(left, 10U);
  EXPECT_GT(exits, 300U);
}

// The plane of the line is nearly tangent to the fillet, and a node outside has neighbours that lie on the surface up to rounding.
TEST(LineAlongAnImpenetrableFillet, ComesBackBetweenItsNeighboursNotOntoOne)
{
  EXPECT_EQ(run_draw(5169, 60).failure, "");
}

// A collision makes a node on a chord across the fillet, and the glide plane does not meet the surface between its neighbours.
TEST(LineAlongAnImpenetrableFillet, LosesANodeThatHasNoWayBack)
{
  EXPECT_EQ(run_draw(1006564, 30).failure, "");
}

// A line is drawn into its own end, which is pinned on an edge of the grain.
TEST(LineThatIsPinnedAtTheSurface, KeepsALengthWhenItsOtherEndSlidesToThePin)
{
  EXPECT_EQ(run_draw(2002334, 40, Placement::at_edges).failure, "");
}

// Two ends meet on the side of a cylinder, where the planes of their lines intersect.
TEST(LinesOnTwoPlanes, JoinAtTheSurfaceWithoutLeavingEitherPlane)
{
  EXPECT_EQ(run_draw(3000229, 20).failure, "");
}

INSTANTIATE_TEST_SUITE_P(Grains, RandomLoopsIn, testing::Range(0, n_grain_kinds),
                         [](const testing::TestParamInfo<int> &parameter)
                         {
                           std::string name = name_of(static_cast<GrainKind>(parameter.param));
                           std::erase(name, ' ');
                           return name;
                         });
} // namespace
} // namespace ddfem
