// Two opposite screws on parallel planes annihilate when one of them changes to the plane in which they see each other.
#include "dd/crystal/material.h"
#include "dd/microstructure/sources.h"
#include "dd/mobility/linear_glide.h"
#include "samples/dislocation_driver.h"
#include "tests/support/one_thread.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace ddfem
{
namespace
{
struct ScrewDipole
{
  const Material &copper = find_material("copper");
  SlipSystems systems{Lattice::fcc, copper.lattice_parameter};
  DislocationDriver driver;
  std::array<NodeIndex, 2> starts, ends;

  explicit ScrewDipole(const CrossSlipModel model) : driver(settings(copper, model), systems)
  {
    const SlipSystem &s = systems[systems.find("B5").value()];
    const Vec3 e = s.burgers.normalized(), across = s.normal.cross(e);
    constexpr double height = 8, half = 120;
    for (const int line : {0, 1})
    {
      // Side by side rather than one above the other: in their own planes they rest as a dipole.
      const Vec3 centre = (line == 0 ? 0.5 : -0.5) * (height * s.normal + 3 * across);
      const PlaneIndex plane = driver.network.planes().find_or_insert(s.plane_miller, s.normal, centre);
      std::vector<Vec3> points;
      for (int k = 0; k <= 12; ++k)
        points.push_back(driver.network.planes().project(plane, centre + half * (k / 6.0 - 1) * e));
      const auto nodes = add_line(driver.network, points, line == 0 ? s.burgers : Vec3(-s.burgers), plane, false,
                                  NodeConstraint::pinned);
      starts[static_cast<std::size_t>(line)] = nodes.front();
      ends[static_cast<std::size_t>(line)] = nodes.back();
    }
  }

  static DriverSettings settings(const Material &m, const CrossSlipModel model)
  {
    DriverSettings d{
        {m.mu, m.nu, m.burgers_magnitude}, m.burgers_magnitude, linear_glide(m.drag, m.drag), {}, {}, 1e-4};
    d.topology = {10, 30, 1, 1.5};
    d.integrator = {.error_tolerance = 0.2, .max_displacement = 3, .max_step = 0.05, .initial_step = 1e-4};
    d.cross_slip.model = model;
    d.cross_slip.screw_angle = 0.1;
    const double b3 = std::pow(m.burgers_magnitude, 3);
    d.cross_slip.law = {1e-9, 1000, 32 * 300 * b3, 300 * b3, 0, 0.01380649 * 300}; // Kubin et al. 1992
    return d;
  }

  /// Steps until the lines have been rejoined or @p duration (ns) has passed; whether they have.
  bool annihilates(const double duration)
  {
    while (driver.time < duration)
    {
      driver.step(duration - driver.time);
      driver.network.check_invariants(1e-5);
      if (driver.other_end_of_line(*driver.network.find_node(0)) != driver.network.id(ends[0]))
        return true;
    }
    return false;
  }
};

TEST(CollinearAnnihilation, OppositeScrewsOnParallelPlanesAnnihilateByCrossSlip)
{
  const OneThread guard;
  ScrewDipole dipole(CrossSlipModel::thermally_activated);
  EXPECT_TRUE(dipole.annihilates(0.05));
  EXPECT_GE(dipole.driver.counts.cross_slips, 1U);
  // What remains joins the pins of one side with each other.
  EXPECT_GE(dipole.driver.counts.collisions, 1U);
  EXPECT_EQ(dipole.driver.other_end_of_line(*dipole.driver.network.find_node(0)), 13U);
}

TEST(CollinearAnnihilation, WithoutCrossSlipTheyStayADipole)
{
  const OneThread guard;
  ScrewDipole dipole(CrossSlipModel::off);
  EXPECT_FALSE(dipole.annihilates(0.05));
}
} // namespace
} // namespace ddfem
