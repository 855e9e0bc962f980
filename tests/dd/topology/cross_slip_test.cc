#include "dd/mobility/glide_constraints.h"
#include "dd/topology/cross_slip.h"
#include "dd/topology/product_plane_rule.h"
#include "tests/dd/topology/topology_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

namespace ddfem
{
namespace
{
constexpr double kT = 0.01380649 * 300, a = 0.36146;

/// A crystal whose axes are those of the sample, with lines in it.
struct Crystal : TopologyFixture
{
  SlipSystems systems;
  CrossSlipSettings rule;
  CrossSlipStep step{1, 7, 0};
  SymTensor stress = SymTensor::Zero();
  std::size_t n_points = 0; ///< asked for by cross_slip()

  explicit Crystal(const Lattice lattice = Lattice::fcc) : systems(lattice, a)
  {
    settings = {10, 30, 1, 2};
    rule.screw_angle = 0.1;
    rule.model = lattice == Lattice::fcc ? CrossSlipModel::thermally_activated : CrossSlipModel::largest_stress;
    rule.law = {1e9, 1000, 0, 0, 0, kT}; // as good as certain
    rule.stress_ratio = 0;
  }

  const SlipSystem &system(const std::string &name) const { return systems[systems.find(name).value()]; }

  std::vector<NodeIndex> add(const std::string &name, const std::vector<Vec3> &points)
  {
    const SlipSystem &s = system(name);
    const PlaneIndex plane = network.planes().find_or_insert(s.plane_miller, s.normal, points[0]);
    return add_line(network, points, s.burgers, plane, false, NodeConstraint::pinned);
  }

  /// Line of @p n segments of 15 nm between pins, along the direction that makes @p angle with b in the plane.
  std::vector<NodeIndex> add_straight(const std::string &name, const int n, const double angle = 0,
                                      const Vec3 &start = Vec3::Zero())
  {
    const SlipSystem &s = system(name);
    const Vec3 e = s.burgers.normalized(), t = std::cos(angle) * e + std::sin(angle) * s.normal.cross(e);
    std::vector<Vec3> points;
    for (int k = 0; k <= n; ++k)
      points.emplace_back(start + 15.0 * k * t);
    return add(name, points);
  }

  std::size_t events()
  {
    TopologyContext c = context();
    cross_slip(c, rule, systems, step,
               [&](const std::vector<Vec3> &points)
               {
                 n_points += points.size();
                 return std::vector<SymTensor>(points.size(), stress);
               });
    return counts.cross_slips;
  }

  /// Names of the planes on which there are segments.
  std::set<Miller> planes_in_use() const
  {
    std::set<Miller> used;
    for (const SegmentIndex s : network.segments())
      used.insert(network.planes()[network.plane(s)].miller);
    return used;
  }
};

/// Stress whose resolved shear stress on the system is @p tau.
SymTensor shear_on(const SlipSystem &s, const double tau)
{
  const Vec3 e = s.burgers.normalized();
  return 2 * tau * symmetric_part(e * s.normal.transpose());
}

TEST(CrossSlipLaw, IsThatOfKubinForCopper)
{
  // Kubin et al. 1992 for copper: tau_III = 32 MPa, V = 300 b^3, L_0 = 1 um, t_0 = 1 s. In SI units.
  const double b = 2.5559e-10, volume = 300 * b * b * b, boltzmann = 1.380649e-23;
  const double per_nm3 = 1e27;
  const CrossSlipLaw law{1e-9, 1000, 32 * volume * per_nm3, volume * per_nm3, 0, kT};
  EXPECT_NEAR(law.rate(1000, {0, 0}, {32, 0}), 1e-9, 1e-21); // one per second
  for (const double tau : {0.0, 20.0, 45.0})
    EXPECT_NEAR(law.rate(250, {99, 0}, {tau, 0}) * 1e9 /
                    (0.25 * std::exp((tau - 32) * 1e6 * volume / (boltzmann * 300))),
                1, 1e-9);
  EXPECT_NEAR(32e6 * volume / 1.602176634e-19, 1.0,
              0.01); // eV; measured 1.15 +- 0.37 (Bonneville, Escaig & Martin 1988)
}

TEST(CrossSlipLaw, EscaigStressesActByTheirDifferenceAndSchmidStressByItsOwnVolume)
{
  const CrossSlipLaw law{1, 1, 10, 0.02, 0.03, 4};
  EXPECT_DOUBLE_EQ(law.rate(1, {50, 20}, {40, 70}), std::exp(-(10 - 0.02 * 40 - 0.03 * (70 - 20)) / 4));
}

TEST(CrossSlipLaw, PartialsAreNarrowedByTensionAlongACubeAxisAndWidenedByCompression)
{
  // Schmid factors of leading and trailing partials: 0.236 and 0.471 in tension along [001], in compression the other way round;
  // in tension along [011] and [111] the leading one is larger, which is why these orientations twin.
  const SlipSystems systems(Lattice::fcc, a);
  const auto escaig = [&](const SlipSystem &s, const Vec3 &axis)
  {
    const Vec3 t = axis.normalized();
    return screw_stress(systems, symmetric_part(t * t.transpose()), s.burgers, s.normal);
  };
  for (const SlipSystem &s : systems)
  {
    const double factor = s.schmid_factor(Vec3::UnitZ());
    const ScrewStress tension = escaig(s, Vec3::UnitZ());
    EXPECT_NEAR(tension.schmid, std::abs(factor), 1e-12);
    // A partial has b/sqrt(3), half of b along b and b/(2 sqrt(3)) across: sigma_E is the difference of the two Schmid stresses.
    if (std::abs(factor) > 0.1)
    {
      EXPECT_NEAR(tension.escaig, 0.2357 - 0.4714, 2e-4);
    }
    for (const double f : {s.schmid_factor(Vec3(0, 1, 1)), s.schmid_factor(Vec3(1, 1, 1))})
      if (std::abs(f) > 0.25)
      {
        EXPECT_GT(escaig(s, f == s.schmid_factor(Vec3(0, 1, 1)) ? Vec3(0, 1, 1) : Vec3(1, 1, 1)).escaig, 0.1);
      }
    const SymTensor any = (SymTensor() << 3, -7, 5, 11, -2, 4).finished();
    const double value = screw_stress(systems, any, s.burgers, s.normal).escaig;
    EXPECT_NEAR(screw_stress(systems, any, -s.burgers, s.normal).escaig, value, 1e-9);
    EXPECT_NEAR(screw_stress(systems, any, s.burgers, -s.normal).escaig, value, 1e-9);
  }
}

TEST(CrossSlip, HappensAtTheRateOfTheLaw)
{
  // The same line in many steps, each with its own random number.
  Crystal c;
  c.add_straight("B5", 6);
  c.stress = shear_on(c.system("B4"), 30);
  double schmid = 0;
  for (const SlipSystem &s : c.systems)
    if (s.name != c.system("B5").name && (s.burgers - c.system("B5").burgers).norm() < 1e-9)
      schmid = screw_stress(c.systems, c.stress, s.burgers, s.normal).schmid;
  ASSERT_GT(schmid, 1);
  c.rule.law = {1e-3, 50, 20, 0.7, 0, kT};
  const double rate = 1e-3 * 90 / 50 * std::exp(-(20 - 0.7 * schmid) / kT);
  for (const double probability : {0.08, 0.5})
  {
    c.step.dt = -std::log(1 - probability) / rate;
    constexpr int trials = 4000;
    int events = 0;
    for (int k = 0; k < trials; ++k)
    {
      Crystal trial = c;
      trial.step.number = static_cast<std::uint64_t>(k);
      events += static_cast<int>(trial.events());
    }
    EXPECT_NEAR(events / double(trials), probability, 4 * std::sqrt(probability * (1 - probability) / trials));
  }
}

TEST(CrossSlip, MovesTheRunToTheOtherPlaneAndKeepsItsEndsOnBoth)
{
  Crystal c;
  // Half a loop: a bow whose top is a screw; pinned far below.
  const SlipSystem &s = c.system("B5");
  const Vec3 e = s.burgers.normalized(), across = s.normal.cross(e);
  std::vector<Vec3> points;
  for (int k = 0; k <= 40; ++k)
  {
    const double angle = -M_PI / 2 + M_PI * k / 40;
    points.emplace_back(250 * (std::sin(angle) * e + std::cos(angle) * across));
  }
  c.add("B5", points);
  c.stress = shear_on(c.system("B5"), 3) + shear_on(c.system("B4"), 5);
  EXPECT_EQ(c.events(), 1U);
  EXPECT_EQ(c.planes_in_use().size(), 2U);
  c.network.check_invariants(1e-6);
  std::vector<NodeIndex> ends;
  double area = 0;
  for (const NodeIndex i : c.network.nodes())
    if (c.network.is_physical(i) && c.network.constraint(i) == NodeConstraint::free)
      ends.push_back(i);
  ASSERT_EQ(ends.size(), 2U);
  for (const NodeIndex i : ends)
    EXPECT_NEAR(std::abs(only_direction(free_directions(c.network, i)).dot(e)), 1, 1e-9);
  // The area between the old line and the new one is booked, all of it in the old plane.
  for (const SweptTriangle &t : c.swept.triangles())
  {
    EXPECT_EQ(c.network.planes()[t.plane].miller, c.network.planes()[c.network.plane(c.network.segments()[0])].miller);
    const Vec3 v = (t.vertices[1].value - t.vertices[0].value).cross(t.vertices[2].value - t.vertices[0].value);
    EXPECT_NEAR(v.cross(s.normal).norm(), 0, 1e-6);
  }
  double old_area = 0;
  for (std::size_t k = 0; k + 1 < points.size(); ++k)
    old_area += 0.5 * points[k].cross(points[k + 1]).dot(s.normal);
  for (const SegmentIndex g : c.network.segments())
    area += 0.5 * c.network.position(c.network.start(g)).cross(c.network.position(c.network.end(g))).dot(s.normal);
  EXPECT_GT(std::abs(area - old_area), 0.01);
  EXPECT_NEAR(inside_area(c.swept, s.burgers).dot(s.normal), area - old_area, 1e-9 * std::abs(old_area));
}

TEST(CrossSlip, ShortRunsEdgesAndSessileLinesStay)
{
  for (const double angle : {0.3, M_PI / 2})
  {
    Crystal c;
    c.add_straight("B5", 6, angle);
    c.stress = shear_on(c.system("B4"), 100);
    EXPECT_EQ(c.events(), 0U);
    EXPECT_EQ(c.n_points, 0U);
  }
  Crystal brief;
  brief.add_straight("B5", 1);
  brief.stress = shear_on(brief.system("B4"), 100);
  EXPECT_EQ(brief.events(), 0U);
  Crystal sessile;
  sessile.add_straight("B5", 6);
  for (const SegmentIndex s : sessile.network.segments())
  {
    Segment without_plane = sessile.network.get(s);
    without_plane.plane = {};
    sessile.network.set(s, without_plane);
  }
  sessile.stress = shear_on(sessile.system("B4"), 100);
  EXPECT_EQ(sessile.events(), 0U);
  Crystal off;
  off.add_straight("B5", 6);
  off.stress = shear_on(off.system("B4"), 100);
  off.rule.model = CrossSlipModel::off;
  EXPECT_EQ(off.events(), 0U);
  off.rule.model = CrossSlipModel::thermally_activated;
  EXPECT_EQ(off.events(), 1U);
}

TEST(CrossSlip, NothingHappensWithoutShearOnTheOtherPlaneAndInACrystalWithoutThisBurgersVector)
{
  Crystal unloaded;
  unloaded.add_straight("B5", 6);
  EXPECT_EQ(unloaded.events(), 0U);
  Crystal foreign(Lattice::bcc); // the lines of an fcc crystal
  const Crystal fcc;
  const SlipSystem &s = fcc.system("B5");
  const PlaneIndex plane = foreign.network.planes().find_or_insert(s.plane_miller, s.normal, Vec3(Vec3::Zero()));
  const Vec3 e = s.burgers.normalized();
  add_line(foreign.network, {Vec3::Zero(), 15 * e, 30 * e, 45 * e}, s.burgers, plane, false, NodeConstraint::pinned);
  foreign.stress = shear_on(fcc.system("B4"), 100);
  EXPECT_EQ(foreign.events(), 0U);
}

TEST(CrossSlip, GoesOnlyWhereTheStressOnTheNewPlaneIsLargeEnough)
{
  Crystal c;
  c.add_straight("B5", 6);
  c.stress = shear_on(c.system("B4"), 50);
  std::vector<double> schmid; // on the present plane and on the other
  for (const SlipSystem &s : c.systems)
    if ((s.burgers - c.system("B5").burgers).norm() < 1e-9)
      schmid.push_back(screw_stress(c.systems, c.stress, s.burgers, s.normal).schmid);
  ASSERT_EQ(schmid.size(), 2U);
  c.rule.stress_ratio = 1.01 * std::min(schmid[0], schmid[1]) / std::max(schmid[0], schmid[1]);
  EXPECT_EQ(c.events(), 0U);
  c.rule.stress_ratio *= 0.98;
  EXPECT_EQ(c.events(), 1U);
}

TEST(CrossSlip, OppositeScrewWithinACollisionRadiusIsFoundOnTheNewPlane)
{
  // Two opposite screws on parallel planes 1.2 nm apart, beside each other by 0.9 nm; only the upper one may move.
  Crystal c;
  const SlipSystem &s = c.system("B5");
  const Vec3 across = s.normal.cross(s.burgers).normalized();
  c.add_straight("B5", 8);
  const Vec3 beside = 1.2 * s.normal + 0.9 * across;
  std::vector<Vec3> points;
  for (int k = 8; k >= 0; --k)
    points.emplace_back(beside + 15.0 * k * s.burgers.normalized());
  const auto lower = c.add("B5", points);
  c.stress = shear_on(c.system("B4"), 50);
  EXPECT_EQ(c.events(), 2U);
  c.network.check_invariants(1e-6);
  // The first run has been put where its new plane holds the other line, and so has the second.
  std::set<std::uint32_t> planes;
  for (const SegmentIndex g : c.network.segments())
    if (!c.network.planes().parallel(c.network.plane(g), c.network.plane(c.network.connected_segments(lower[0])[0])))
      planes.insert(c.network.plane(g).value);
  EXPECT_EQ(planes.size(), 1U);
}

TEST(CrossSlip, BccScrewGoesToThePlaneOfLargestStressBeyondTheHysteresis)
{
  Crystal c(Lattice::bcc);
  const SlipSystem &present = c.systems[0];
  c.add_straight(present.name, 4);
  const Vec3 e = present.burgers.normalized();
  // Shear along b on a plane at 20 degrees from the present one: of the planes every 30 degrees of the zone the one at 30 degrees
  // is nearest, with the ratio cos(10)/cos(20) = 1.048.
  const double angle = M_PI / 9;
  const Vec3 n = std::cos(angle) * present.normal + std::sin(angle) * e.cross(present.normal);
  c.stress = 40 * 2 * symmetric_part(e * n.transpose());
  c.rule.hysteresis = 1.06;
  EXPECT_EQ(c.events(), 0U);
  c.rule.hysteresis = 1.04;
  EXPECT_EQ(c.events(), 1U);
  const Vec3 normal = c.network.normal(c.network.segments()[0]);
  EXPECT_NEAR(std::abs(normal.dot(n)), std::cos(M_PI / 18), 1e-6);
  EXPECT_EQ(c.planes_in_use().size(), 1U);
  c.network.check_invariants(1e-6);
  EXPECT_EQ(c.events(), 1U); // and stays there
}

TEST(CrossSlip, ScrewThroughAPeriodicCellChangesItsPlaneAsAWhole)
{
  Crystal c;
  const SlipSystem &s = c.system("B5");
  const Vec3 e = s.burgers.normalized();
  ASSERT_EQ((e.array().abs() > 0.1).count(), 2); // along a face diagonal of the cell
  const double edge = 60;
  c.network.set_period(Vec3::Constant(edge));
  const PlaneIndex plane = c.network.planes().find_or_insert(s.plane_miller, s.normal, Vec3(Vec3::Zero()));
  const Vec3 across = s.normal.cross(e);
  std::vector<Vec3> points;
  for (int k = 0; k < 6; ++k)
    points.emplace_back(edge * std::sqrt(2.0) * k / 6 * e + 0.3 * (k % 2) * across);
  add_line(c.network, points, s.burgers, plane, true, NodeConstraint::free);
  c.stress = shear_on(c.system("B4"), 50);
  EXPECT_EQ(c.events(), 1U);
  EXPECT_EQ(c.planes_in_use().size(), 1U);
  EXPECT_NE(*c.planes_in_use().begin(), c.network.planes()[plane].miller);
  for (const NodeIndex i : c.network.nodes())
    EXPECT_FALSE(c.network.is_physical(i));
  c.network.check_invariants(1e-6);
}

TEST(CrossSlip, EventsDoNotDependOnTheOrderInMemory)
{
  Crystal c;
  for (int k = 0; k < 40; ++k)
    c.add_straight("B5", 3 + k % 4, 0, Vec3(0, 0, 50.0 * ((k * 17) % 40)));
  c.stress = shear_on(c.system("B4"), 50);
  c.rule.law = {0.6, 100, 0, 0, 0, kT};
  Crystal sorted = c;
  sorted.network.clean();
  c.events();
  sorted.events();
  EXPECT_GT(c.counts.cross_slips, 8U);
  EXPECT_LT(c.counts.cross_slips, 36U);
  for (const SegmentIndex s : c.network.segments())
    EXPECT_EQ(c.network.normal(s), sorted.network.normal(*sorted.network.find_segment(c.network.id(s))));
}
} // namespace
} // namespace ddfem
