#include "dd/crystal/material.h"
#include "dd/mobility/climb.h"
#include "dd/mobility/family_glide.h"
#include "dd/mobility/friction_glide.h"
#include "dd/mobility/kink_pair_glide.h"
#include "dd/mobility/local_velocities.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace ddfem
{
namespace
{
const SlipSystems fcc(Lattice::fcc, 0.4), bcc(Lattice::bcc, 0.31652),
    hcp(Lattice::hcp, 0.32, Orientation(UnitCell::hexagonal(1.6)));

/// A line at @p theta from the Burgers vector of @p system, in its plane.
LineState line_of(const SlipSystem &system, const double theta)
{
  const Vec3 along = system.burgers.normalized();
  return {std::cos(theta) * along + std::sin(theta) * system.normal.cross(along), system.burgers, system.normal};
}

/// Speed of a straight line with a resolved shear stress of @p tau, in its plane, by the local solver.
double glide_speed(const MobilityLaw &law, const LineState &line, const double tau)
{
  constexpr double length = 10;
  const Vec3 across = line.normal.cross(line.direction);
  const NodalArm arm{line, length};
  const Vec3 force = tau * line.burgers.norm() * length * across;
  const Mat3 directions = free_directions(std::vector{law.constraint(line)});
  const Vec3 v = local_velocity(law, std::vector{arm, arm}, directions, force, 0.1);
  EXPECT_NEAR((v - v.dot(across) * across).norm(), 0, 1e-9 * v.norm());
  return v.dot(across);
}

TEST(MobilityLaws, StraightLinesGlideAtStressTimesBurgersOverDragOfTheirFamilyAndCharacter)
{
  const FamilyGlide law(hcp, {{SlipFamily::basal, {0.02, 0.05}}, {SlipFamily::prismatic, {0.1, 0.3}}});
  for (const SlipSystem &s : hcp)
    for (const double theta : {0.0, 0.7, std::numbers::pi / 2})
    {
      const LineState line = line_of(s, theta);
      if (s.family != SlipFamily::basal && s.family != SlipFamily::prismatic)
      {
        EXPECT_TRUE(law.constraint(line).is_sessile());
        continue;
      }
      const bool basal = s.family == SlipFamily::basal;
      const double edge = basal ? 0.02 : 0.1, screw = basal ? 0.05 : 0.3,
                   drag = edge * std::pow(std::sin(theta), 2) + screw * std::pow(std::cos(theta), 2);
      EXPECT_NEAR(glide_speed(law, line, 30), 30 * line.burgers.norm() / drag, 1e-6 * 30 * line.burgers.norm() / drag);
    }
}

TEST(MobilityLaws, LinesThatTheCrystalDoesNotLetGlideKeepTheirNodesOnThemselves)
{
  const FamilyGlide law(fcc, {{SlipFamily::fcc_111, {0.02, 0.02}}});
  const Vec3 b(0.2, 0.2, 0); // a/2[110]
  const Vec3 lomer = Vec3(1, -1, 0).normalized();
  EXPECT_FALSE(law.constraint({lomer, b.cross(Vec3::UnitZ()), Vec3(1, 1, 1).normalized()}).is_sessile());
  // The Lomer lock lies in (001): no slip plane of fcc, even if a file says that it glides there.
  EXPECT_TRUE(law.constraint({lomer, b, Vec3::UnitZ()}).is_sessile());
  EXPECT_TRUE(law.constraint({lomer, b, Vec3::Zero()}).is_sessile());
  EXPECT_TRUE(law.constraint({Vec3::UnitX(), Vec3(0.4, 0, 0), Vec3(0, 1, 1).normalized()}).is_sessile()); // Hirth
}

TEST(MobilityLaws, FrictionHoldsALineBelowItsStressAndTakesItOffAbove)
{
  const MobilityPointer linear = linear_glide(0.02, 0.02);
  const FrictionGlide law(linear, {.stress = 20, .largest_speed = 0});
  for (const double theta : {0.0, 1.0})
  {
    const LineState line = line_of(fcc[0], theta);
    const double b = line.burgers.norm();
    EXPECT_LT(glide_speed(law, line, 19), 3 * FrictionGlide::creep_speed * 19 / std::sqrt(20 * 20 - 19 * 19.0));
    EXPECT_NEAR(glide_speed(law, line, 30), 10 * b / 0.02, 1e-6 * 10 * b / 0.02);
    EXPECT_NEAR(glide_speed(law, line, -30), -10 * b / 0.02, 1e-6 * 10 * b / 0.02);
  }
}

TEST(MobilityLaws, NoLineIsFasterThanTheLimitAndSlowOnesDoNotFeelIt)
{
  const double c = 3000;
  const FrictionGlide law(linear_glide(0.02, 0.02), {.stress = 0, .largest_speed = c});
  const LineState line = line_of(fcc[0], 0.3);
  const double b = line.burgers.norm();
  EXPECT_NEAR(glide_speed(law, line, 0.01), 0.01 * b / 0.02, 1e-6 * 0.01 * b / 0.02);
  for (const double tau : {50.0, 1000.0, 5000.0})
  {
    // tau b = B v/(1 - (v/c)^2), a quadratic equation.
    const double free = tau * b / 0.02, expected = c * c / (2 * free) * (std::sqrt(1 + 4 * free * free / (c * c)) - 1);
    EXPECT_NEAR(glide_speed(law, line, tau), expected, 1e-6 * expected);
    EXPECT_LT(expected, c);
  }
}

TEST(MobilityLaws, ScrewsOfTungstenNeedKinkPairsAndEdgesDoNot)
{
  // Evaluated separately, Po et al. 2016, tau = 1 GPa at 300 K: x = (1/2.03)^0.86 = 0.543943, (1-x)^1.69 = 0.265303, less
  // 300/2956 = 0.101488: g = 0.163815; dH g/(2 k T) = 5.164354; B_k w/2h = 1.100435e-3 Pa s, s = 0.0931056,
  // B = 1.0892218e-3 Pa s.
  const KinkPairGlide law(bcc, tungsten_kink_pairs(300));
  const SlipSystem &system = bcc[0];
  const double b = system.burgers.norm();
  const double screw = 1000 * b / 1.0892218 * std::exp(-5.164354);
  EXPECT_NEAR(glide_speed(law, line_of(system, 0), 1000), screw, 2e-6 * screw);
  const double edge = 1000 * b / (4.26e-1 + 0.87e-3 * 300);
  EXPECT_NEAR(glide_speed(law, line_of(system, std::numbers::pi / 2), 1000), edge, 1e-6 * edge);
  // Without a barrier screws are viscous: above the athermal temperature, but for the smooth transition in B.
  const KinkPairGlide hot(bcc, tungsten_kink_pairs(3000));
  const double s = 1 / (1 + std::exp(-1.0)), drag = 0.98 * s + 1.100435 * (1 - s);
  EXPECT_NEAR(glide_speed(hot, line_of(system, 0), 100), 100 * b / drag, 1e-4 * 100 * b / drag);
  EXPECT_GT(glide_speed(KinkPairGlide(bcc, tungsten_kink_pairs(400)), line_of(system, 0), 1000), 2 * screw);
}

TEST(MobilityLaws, KinkPairParametersWithoutMeaningAreRefused)
{
  EXPECT_THROW(KinkPairGlide(fcc, tungsten_kink_pairs(300)), std::invalid_argument);
  KinkPairParameters k = tungsten_kink_pairs(300);
  k.q = 3;
  EXPECT_THROW(KinkPairGlide(bcc, k), std::invalid_argument);
  k = tungsten_kink_pairs(2000);
  k.screw_drag = 1e3 * k.kink_drag * KinkPairParameters::width; // slower without a barrier than with it
  EXPECT_THROW(KinkPairGlide(bcc, k), std::invalid_argument);
}

TEST(MobilityLaws, LinesWithoutAPlaneClimbAndLinesWithOneStayOnIt)
{
  const Climb law(
      std::make_shared<FamilyGlide>(fcc, std::map<SlipFamily, CharacterDrag>{{SlipFamily::fcc_111, {0.02, 0.02}}}),
      5.0);
  LineState line = line_of(fcc[0], 1.0);
  EXPECT_NEAR(glide_speed(law, line, 30), 30 * line.burgers.norm() / 0.02, 1e-6);
  const Mat3 plane = Mat3::Identity() - line.normal * line.normal.transpose();
  EXPECT_LT((free_directions(std::vector{law.constraint(line), law.constraint(line)}) - plane).norm(), 1e-15);
  line.normal.setZero();
  const Vec3 force = 7 * line.direction.unitOrthogonal();
  const NodalArm arm{line, 10};
  const Mat3 directions = free_directions(std::vector{law.constraint(line), law.constraint(line)});
  EXPECT_LT((local_velocity(law, std::vector{arm, arm}, directions, force) - force / 50).norm(), 1e-12);
}

TEST(MobilityLaws, SlopeIsTheSymmetricDerivativeOfTheResistanceAndAboveTheDrag)
{
  const std::vector<std::pair<std::string, MobilityPointer>> laws{
      {"linear", linear_glide(0.02, 0.05)},
      {"friction", std::make_shared<FrictionGlide>(linear_glide(0.02, 0.05), FrictionSettings{15, 2000})},
      {"kink pair", std::make_shared<KinkPairGlide>(bcc, tungsten_kink_pairs(600))}};
  for (const auto &[name, law] : laws)
    for (const double theta : {0.0, 0.4, 1.5})
      for (const double speed : {0.05, 20.0, 1500.0})
      {
        const LineState line = line_of(bcc[3], theta);
        const Vec3 v = speed * Vec3(0.3, -0.8, 0.5).normalized();
        const Resistance r = law->resistance(line, v);
        EXPECT_NEAR(r.force.dot(line.direction), 0, 1e-9 * r.force.norm()) << name;
        EXPECT_LT((r.slope - r.slope.transpose()).norm(), 1e-12 * r.slope.norm()) << name;
        Mat3 difference;
        const double h = 1e-4 * speed;
        for (int c = 0; c < 3; ++c)
          difference.col(c) = (law->resistance(line, v + h * Vec3::Unit(c)).force -
                               law->resistance(line, v - h * Vec3::Unit(c)).force) /
                              (2 * h);
        EXPECT_LT((difference - r.slope).norm(), 1e-3 * r.slope.norm()) << name << ' ' << theta << ' ' << speed;
        const Vec3 across = line.normal.cross(line.direction);
        EXPECT_GE(across.dot(r.slope * across), law->drag(line) * (1 - 1e-6)) << name;
      }
}
} // namespace
} // namespace ddfem
