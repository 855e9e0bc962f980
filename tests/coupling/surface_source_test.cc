// A Frank-Read source whose one pinning point lies on the free surface.
#include "coupling/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace ddfem::coupling
{
namespace
{
/// Edge source of 200 nm in an aluminium box of 400 x 400 x 900 nm under a constant stress (Pa) until the whole section has slipped by a
/// fifth of b, or until the final time (s); its line is along
/// -(0.6667, 0.7320, 0.1380), so that one pinning point is 100 nm x 0.6667 from the centre in x.
Simulation source(const std::string &centre, const std::string &stress, const std::string &final_time)
{
  InputDeck deck;
  for (const std::string &s :
       {std::string("Crystal/Direction along x=1 2 -1"), std::string("Crystal/Direction along z=-1 3 5"),
        std::string("Domain/Origin=-2e-7 -2e-7 0"), std::string("Domain/Size=4e-7 4e-7 9e-7"),
        std::string("Domain/Subdivisions=2 2 4"), std::string("Boundary conditions/Platen contact=frictionless"),
        "Microstructure/Frank-Read sources=1 1 1 / -1 0 1 / " + centre + " / 2e-7 / 90",
        std::string("Discretisation/Minimum segment=1.5e-8"), std::string("Discretisation/Maximum segment=4e-8"),
        std::string("Time stepping/Maximum steps=2000"), std::string("Time stepping/Initial step=1e-12"),
        std::string("Output/Frame interval=0"), std::string("Loading/Type=stages"),
        "Loading/Stages=constant stress " + stress + " until plastic strain -4.55e-5",
        "Time stepping/Final time=" + final_time})
    deck.set_from_command_line(s);
  return Simulation(interpret(deck), MPI_COMM_SELF);
}

const std::string at_surface = "-1.333333333333333333e-7 0 4.5e-7", in_the_middle = "0 0 4.5e-7";

/// Positions of the pinned nodes along x, nm.
std::vector<double> pinned(const Network &network)
{
  std::vector<double> x;
  for (const NodeIndex i : network.nodes())
    if (network.constraint(i) == NodeConstraint::pinned)
      x.push_back(network.position(i)[0]);
  std::sort(x.begin(), x.end());
  return x;
}

// Every step checks the flux of the Burgers vector in the network and the balance of the tractions.
TEST(SourceAtTheSurface, OperatesUnderAStressThatLeavesTheSameSourceInTheMiddleBowedOut)
{
  // The line soon meets the surface and becomes an arm with one end held: about half the critical stress, which is 81 MPa for the
  // source in the middle (example pillar_compression).
  RunOutput silent("", false);
  Simulation surface = source(at_surface, "-7e7", "8e-9"), middle = source(in_the_middle, "-7e7", "3e-9");
  surface.run(silent);
  middle.run(silent);
  // Axial strain of one slip: b along the axis over the height.
  const double one_slip = 0.286 * 6 / std::sqrt(70.0) / 900;
  EXPECT_GT(std::abs(surface.plastic_strain()[2]) / one_slip, 0.19);
  EXPECT_GT(std::abs(middle.plastic_strain()[2]) / one_slip, 0.01);
  EXPECT_LT(std::abs(middle.plastic_strain()[2]) / one_slip, 0.1);
  const std::vector<double> x = pinned(surface.network());
  ASSERT_EQ(x.size(), 2U);
  EXPECT_NEAR(x[0], -200.0, 1e-9);
  EXPECT_NEAR(x[1], -200.0 / 3, 1e-6);
}
} // namespace
} // namespace ddfem::coupling
