// A Frank-Read source whose one pinning point lies on the free surface.
#include "coupling/simulation.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace ddfem::coupling
{
namespace
{
/// Edge source of 200 nm in an aluminium box of 400 x 400 x 900 nm under a constant stress (Pa); its line is along
/// -(0.6667, 0.7320, 0.1380), so that one pinning point is 100 nm x 0.6667 from the centre in x.
Simulation source(const std::string &centre, const std::string &stress, const std::string &duration)
{
  InputDeck deck;
  for (const std::string &s :
       {std::string("Crystal/Direction along x=1 2 -1"), std::string("Crystal/Direction along z=-1 3 5"),
        std::string("Domain/Origin=-2e-7 -2e-7 0"), std::string("Domain/Size=4e-7 4e-7 9e-7"),
        std::string("Domain/Subdivisions=3 3 6"), std::string("Boundary conditions/Platen contact=frictionless"),
        "Microstructure/Frank-Read sources=1 1 1 / -1 0 1 / " + centre + " / 2e-7 / 90",
        std::string("Discretisation/Minimum segment=1.5e-8"), std::string("Discretisation/Maximum segment=4e-8"),
        std::string("Time stepping/Maximum steps=2000"), std::string("Time stepping/Initial step=1e-12"),
        std::string("Output/Frame interval=0"), std::string("Loading/Type=stages"),
        "Loading/Stages=constant stress " + stress + " until duration " + duration})
    deck.set_from_command_line(s);
  return Simulation(interpret(deck), MPI_COMM_SELF);
}

const std::string at_surface = "-1.333333333333333333e-7 0 4.5e-7", in_the_middle = "0 0 4.5e-7";

/// Plastic strain along the axis over that of one slip of the whole section; every step checks the network and the balance of tractions.
double slips(const std::string &centre, const std::string &stress, const std::string &duration)
{
  Simulation simulation = source(centre, stress, duration);
  RunOutput silent("", false);
  simulation.run(silent);
  // b_z (section / height) / volume of the sample, with b . z = 6 / (sqrt(2) sqrt(35)) b.
  const double b = 0.286 * 6 / std::sqrt(70.0);
  return simulation.plastic_strain()[2] / (b / 900);
}

TEST(SourceAtTheSurface, HoldsItsPinningPoint)
{
  Simulation simulation = source(at_surface, "-3e7", "1e-9");
  RunOutput silent("", false);
  simulation.run(silent);
  std::size_t held = 0;
  for (const NodeIndex i : simulation.network().nodes())
    if (simulation.network().constraint(i) == NodeConstraint::pinned)
    {
      ++held;
      EXPECT_NEAR(std::abs(simulation.network().position(i)[0] + 400.0 / 3), 200.0 / 3, 1e-9);
    }
  EXPECT_EQ(held, 2U);
  EXPECT_GT(simulation.network().n_segments(), 2U);
}

TEST(SourceAtTheSurface, OperatesUnderAStressThatLeavesTheSameSourceInTheMiddleBowedOut)
{
  // The line that meets the surface is an arm with one end held: about half the critical stress.
  const double surface = slips(at_surface, "-6e7", "8e-9"), middle = slips(in_the_middle, "-6e7", "8e-9");
  std::printf("slips: %g at the surface, %g in the middle\n", surface, middle);
  EXPECT_GT(std::abs(surface), 1.0);
  EXPECT_LT(std::abs(middle), 0.3);
}
} // namespace
} // namespace ddfem::coupling
