// The shape of a line between two pins under stress.
#include "dd/crystal/material.h"
#include "dd/microstructure/sources.h"
#include "samples/dislocation_driver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ddfem
{
namespace
{
const Material &aluminium = find_material("aluminium");
const SlipSystems fcc(Lattice::fcc, aluminium.lattice_parameter);
constexpr double length = 200;
/// ln(a/r_c): so large that the core energy is all that counts; the elastic energy adds some ln(L/a)/log_core = 1 %.
constexpr double log_core = 600;

/// Line energy mu b^2/(4 pi) ln(a/r_c) (cos^2 + sin^2/(1-nu)) at the angle @p theta from b, and its derivative.
struct LineEnergy
{
  double value, slope;
};

LineEnergy line_energy(const double theta)
{
  const double b = aluminium.burgers_magnitude, c = aluminium.mu * b * b / (4 * std::numbers::pi) * log_core,
               excess = 1 / (1 - aluminium.nu) - 1;
  return {c * (1 + excess * std::pow(std::sin(theta), 2)), c * excess * std::sin(2 * theta)};
}

/// Sagitta of the arc between the pins of an edge (@p mean = pi/2) or screw (0) line under the force @p f per length: in equilibrium the tangent turns
/// from mean - phi to mean + phi along X = (E sin + E' cos)/f, Y = -(E cos - E' sin)/f of the angle (DeWit & Koehler, Phys. Rev. 116 (1959) 1113).
double sagitta(const double mean, const double f)
{
  const auto along = [&](const double phi)
  { return (line_energy(mean + phi).value * std::sin(phi) + line_energy(mean + phi).slope * std::cos(phi)) / f; };
  const auto across = [&](const double phi)
  { return -(line_energy(mean + phi).value * std::cos(phi) - line_energy(mean + phi).slope * std::sin(phi)) / f; };
  double low = 0, high = std::numbers::pi / 2;
  for (int k = 0; k < 100; ++k)
  {
    const double middle = 0.5 * (low + high);
    (along(middle) - along(-middle) < length ? low : high) = middle;
  }
  return std::abs(across(low) - across(0));
}

TEST(PinnedLine, BowsOutUnderStressToTheShapeOfItsLineTension)
{
  const SlipSystem &system = fcc[*fcc.find("B4")];
  const double b = system.burgers.norm();
  for (const double mean : {0.0, std::numbers::pi / 2})
    for (const VelocityMethod method : {VelocityMethod::local, VelocityMethod::consistent})
    {
      const IsotropicMedium medium{aluminium.mu, aluminium.nu, b};
      DriverSettings settings{
          medium, b * std::exp(-log_core), linear_glide(0.02, 0.02), {6, 16, 0.05, 0.5}, {0.05, 2, 1, 1e-5, 30}};
      settings.velocities.method = method;
      DislocationDriver driver(settings, fcc);
      driver.remeshing = false;
      const Vec3 along = system.burgers.normalized(),
                 t = std::cos(mean) * along + std::sin(mean) * system.normal.cross(along);
      const PlaneIndex plane =
          driver.network.planes().find_or_insert(system.plane_miller, system.normal, Vec3(Vec3::Zero()));
      std::vector<Vec3> points;
      for (int k = 0; k <= 20; ++k)
        points.push_back((k / 20.0 - 0.5) * length * t);
      add_line(driver.network, points, system.burgers, plane, false, NodeConstraint::pinned);
      const double f = 0.6 * line_energy(std::numbers::pi / 2 - mean).value / (0.5 * length);
      driver.applied = 2 * f / b * system.schmid_tensor();
      driver.relax(10, 0.02);
      double found = 0;
      for (const NodeIndex i : driver.network.nodes())
        found = std::max(found, std::abs(system.normal.cross(t).dot(driver.network.position(i))));
      EXPECT_NEAR(found, sagitta(mean, f), 0.02 * sagitta(mean, f)) << mean;
      EXPECT_GT(found, 0.1 * length);
    }
}
} // namespace
} // namespace ddfem
