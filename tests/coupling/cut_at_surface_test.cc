// Initial lines that reach out of the grain.
#include "coupling/input_error.h"
#include "coupling/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ddfem::coupling
{
namespace
{
const Vec3 low(-200, -200, 0), high(200, 200, 900);

/// A box of 400 x 400 x 900 nm whose (111) planes lie across it at 47 degrees, or the infinite body.
Simulation grain(const std::vector<std::string> &more, const std::string &mode = "finite")
{
  InputDeck deck;
  for (const char *const s :
       {"Crystal/Direction along x=1 2 -1", "Crystal/Direction along z=-1 3 5", "Domain/Origin=-2e-7 -2e-7 0",
        "Domain/Size=4e-7 4e-7 9e-7", "Domain/Subdivisions=2 2 4", "Loading/Type=none",
        "Discretisation/Minimum segment=1.5e-8", "Discretisation/Maximum segment=4e-8", "Output/Frame interval=0",
        "Time stepping/Maximum steps=5"})
    deck.set_from_command_line(s);
  deck.set_from_command_line("Mode=" + mode);
  for (const std::string &s : more)
    deck.set_from_command_line(s);
  return {interpret(deck), MPI_COMM_SELF};
}

const std::string cut = "Microstructure/Cut at surface=true";
std::string loop(const std::string &radius)
{
  return "Microstructure/Loops=1 1 1 / -1 0 1 / 3e-8 -2e-8 4.3e-7 / " + radius + " / 24";
}

double line_length(const Network &network)
{
  double sum = 0;
  for (const SegmentIndex s : network.segments())
    sum += network.length(s);
  return sum;
}

/// The part of the segment from @p p to @p p + @p d inside the box, from the intervals between its pairs of faces: line coordinates of
/// its ends, from 0 to 1; the first not less than the last if there is none.
std::array<double, 2> part_in_box(const Vec3 &p, const Vec3 &d)
{
  double first = 0, last = 1;
  for (int k = 0; k < 3; ++k)
  {
    const double a = (low[k] - p[k]) / d[k], b = (high[k] - p[k]) / d[k];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return {first, last};
}

class LoopBiggerThanTheGrain : public testing::Test
{
protected:
  LoopBiggerThanTheGrain()
  {
    for (const SegmentIndex s : uncut.network().segments())
    {
      const Vec3 p = uncut.network().position(uncut.network().start(s)), d = uncut.network().direction(s);
      const auto [first, last] = part_in_box(p, d);
      if (first < last)
      {
        length_inside += (last - first) * d.norm();
        passages += (first > 0 ? 1 : 0) + (last < 1 ? 1 : 0);
      }
    }
  }

  Simulation simulation = grain({loop("3e-7"), cut}), uncut = grain({loop("3e-7")}, "infinite");
  double length_inside = 0; ///< of the whole loop, nm
  int passages = 0;         ///< of the whole loop through the surface
};

TEST_F(LoopBiggerThanTheGrain, KeepsWhatIsInsideAndNothingElse)
{
  EXPECT_LT(length_inside, 0.6 * line_length(uncut.network()));
  EXPECT_NEAR(line_length(simulation.network()) / length_inside, 1, 1e-9);
}

TEST_F(LoopBiggerThanTheGrain, EndsInSurfaceNodesOnTheSidesInItsGlidePlane)
{
  const Network &network = simulation.network();
  const Vec3 n = network.normal(*network.segments().begin()), centre(30, -20, 430);
  int ends = 0;
  for (const NodeIndex i : network.nodes())
  {
    const Vec3 x = network.position(i);
    const double depth = std::min((x - low).minCoeff(), (high - x).minCoeff());
    const bool surface = network.constraint(i) == NodeConstraint::surface;
    EXPECT_NEAR(n.dot(x - centre), 0, 1e-6);
    EXPECT_EQ(network.degree(i), surface ? 1U : 2U);
    EXPECT_GT(depth, surface ? -1e-9 : 1e-9) << x.transpose();
    if (surface)
    {
      ++ends;
      EXPECT_NEAR(depth, 0, 1e-9) << x.transpose();
      EXPECT_NEAR(std::min(200 - std::abs(x[0]), 200 - std::abs(x[1])), 0, 1e-9) << x.transpose();
    }
  }
  EXPECT_GE(passages, 4);
  EXPECT_EQ(ends, passages);
}

TEST_F(LoopBiggerThanTheGrain, LosesNoBurgersFlux)
{
  // With their rays the pieces are closed: their tractions balance, at the start and while they move.
  const auto expect_balance = [&]
  {
    EXPECT_TRUE(simulation.network().violations().empty());
    EXPECT_LT(simulation.grain_solution().force_imbalance, 1e-6);
    EXPECT_LT(simulation.grain_solution().moment_imbalance, 1e-6);
  };
  simulation.start();
  expect_balance();
  RunOutput silent("", false);
  simulation.run(silent);
  expect_balance();
  for (const SegmentIndex s : simulation.network().segments())
    EXPECT_NEAR(std::abs(simulation.network().burgers(s).norm() - 0.28635), 0, 1e-5);
}

TEST(CutAtSurface, IsAskedForOtherwiseNodesOutsideAreAnError)
{
  EXPECT_THROW(grain({loop("3e-7")}), InputError);
}

TEST(CutAtSurface, ALoopAroundTheWholeSectionLeavesNothingAndOneInsideIsLeftAlone)
{
  EXPECT_EQ(grain({loop("5e-7"), cut}).network().n_nodes(), 0U);
  EXPECT_EQ(grain({loop("1e-7"), cut}).network().checksum(), grain({loop("1e-7")}).network().checksum());
}

TEST(CutAtSurface, ASourceThatReachesOutKeepsOnePinAndEndsAtTheSurface)
{
  // Its line runs along -(0.6667, 0.7320, 0.1380) through the side at x = -200.
  const Simulation simulation =
      grain({"Microstructure/Frank-Read sources=1 1 1 / -1 0 1 / -1.7e-7 0 4.5e-7 / 2e-7 / 90", cut});
  const Network &network = simulation.network();
  int pinned = 0, surface = 0;
  for (const NodeIndex i : network.nodes())
  {
    pinned += network.constraint(i) == NodeConstraint::pinned ? 1 : 0;
    if (network.constraint(i) == NodeConstraint::surface)
    {
      ++surface;
      EXPECT_NEAR(network.position(i)[0], -200, 1e-9);
    }
  }
  EXPECT_EQ(pinned, 1);
  EXPECT_EQ(surface, 1);
  EXPECT_NEAR(line_length(network), 100 + 30 / 0.6667, 0.01);
}
} // namespace
} // namespace ddfem::coupling
