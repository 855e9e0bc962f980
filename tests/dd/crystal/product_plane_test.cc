// Products of all pairs of slip systems against the tables of junctions in the literature.
#include "dd/crystal/product_plane.h"
#include "tests/dd/crystal/point_group.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

namespace
{
using namespace ddfem;

constexpr double a0 = 0.3;

SlipSystems hcp(const double c_over_a = 1.5929)
{
  return {Lattice::hcp, a0, Orientation(UnitCell::hexagonal(c_over_a))};
}

/// The junction of lines of two systems on planes that intersect.
struct Junction
{
  Vec3 xi;                          ///< along the intersection of the planes
  Vec3 burgers;                     ///< the shorter of b1 + b2 and b1 - b2, nm
  double energy_change = 0;         ///< of Frank's criterion: b^2 - b1^2 - b2^2, nm^2; negative: the lines attract
  std::optional<std::size_t> plane; ///< where it glides
  std::optional<BurgersType> type;
};

Junction junction_of(const SlipSystems &systems, const SlipSystem &s, const SlipSystem &t)
{
  Junction j;
  j.xi = s.normal.cross(t.normal).normalized();
  const Vec3 sum = s.burgers + t.burgers, difference = s.burgers - t.burgers;
  j.burgers = sum.norm() < difference.norm() ? sum : difference;
  j.energy_change = j.burgers.squaredNorm() - s.burgers.squaredNorm() - t.burgers.squaredNorm();
  const std::array<std::size_t, 2> parents = {s.plane, t.plane};
  j.plane = product_plane(systems, j.xi, j.burgers, parents);
  j.type = systems.burgers_type(j.burgers);
  return j;
}

bool same_burgers(const SlipSystem &s, const SlipSystem &t)
{
  return std::min((s.burgers - t.burgers).norm(), (s.burgers + t.burgers).norm()) < 1e-12;
}

using Table = std::map<std::string, int>;

/// Name of the interaction of two systems; junctions by the Burgers vector and the family of their product.
std::string interaction(const SlipSystems &systems, const SlipSystem &s, const SlipSystem &t)
{
  if (s.plane == t.plane)
    return same_burgers(s, t) ? "self" : "coplanar";
  if (same_burgers(s, t))
    return "collinear";
  const Junction j = junction_of(systems, s, t);
  if (j.energy_change > 1e-12)
    return "repulsive";
  const std::string type = j.type ? name_of(*j.type) : "no translation";
  return type + (j.plane ? std::string(" on ") + name_of(*systems.family(j.burgers, *j.plane)) : " sessile");
}

/// How often each interaction occurs between @p s and the systems of family @p with.
Table interactions(const SlipSystems &systems, const SlipSystem &s, const SlipFamily with)
{
  Table table;
  for (const SlipSystem &t : systems)
    if (t.family == with)
      ++table[interaction(systems, s, t)];
  return table;
}

void expect_table(const SlipSystems &systems, const SlipFamily of, const SlipFamily with, const Table &expected)
{
  for (const SlipSystem &s : systems)
  {
    if (s.family == of)
    {
      EXPECT_EQ(interactions(systems, s, with), expected) << s.name << " with " << name_of(with);
    }
  }
}

TEST(ProductPlane, FccPairsAreThoseOfFranciosiBerveillerAndZaoui)
{
  // Acta Metall. 28 (1980) 273; Madec & Kubin, Acta Mater. 126 (2017) 166: per system one self, two coplanar, one
  // collinear, two Hirth (a<100>), four glissile, two Lomer.
  expect_table({Lattice::fcc, a0, Orientation::from_loading_axis({1, 2, 3})}, SlipFamily::fcc_111, SlipFamily::fcc_111,
               {{"self", 1},
                {"coplanar", 2},
                {"collinear", 1},
                {"a<100> sessile", 2},
                {"a/2<110> on {111}<110>", 4},
                {"a/2<110> sessile", 2}});
}

TEST(ProductPlane, FccHirthLocksGainNoEnergyAndOthersDo)
{
  const SlipSystems systems(Lattice::fcc, a0);
  for (const SlipSystem &s : systems)
    for (const SlipSystem &t : systems)
    {
      if (s.plane == t.plane || same_burgers(s, t))
        continue;
      const Junction j = junction_of(systems, s, t);
      EXPECT_NEAR(j.energy_change, j.type == BurgersType::full_100 ? 0 : -a0 * a0 / 2, 1e-15) << s.name << t.name;
    }
}

TEST(ProductPlane, LomerLockLiesInACubePlane)
{
  const SlipSystems systems(Lattice::fcc, a0);
  int n_locks = 0;
  for (const SlipSystem &s : systems)
    for (const SlipSystem &t : systems)
      if (interaction(systems, s, t) == "a/2<110> sessile")
      {
        const Junction j = junction_of(systems, s, t);
        const Vec3 normal = j.xi.cross(j.burgers).normalized();
        EXPECT_NEAR(normal.cwiseAbs().maxCoeff(), 1, 1e-14); // {100}
        EXPECT_NEAR(j.xi.dot(j.burgers), 0, 1e-16);          // edge
        ++n_locks;
      }
  EXPECT_EQ(n_locks, 24);
}

TEST(ProductPlane, GlissileFccJunctionsKeepAParentPlane)
{
  const SlipSystems systems(Lattice::fcc, a0);
  for (const SlipSystem &s : systems)
    for (const SlipSystem &t : systems)
      if (interaction(systems, s, t) == "a/2<110> on {111}<110>")
      {
        const Junction j = junction_of(systems, s, t);
        EXPECT_TRUE(*j.plane == s.plane || *j.plane == t.plane) << s.name << t.name;
      }
}

TEST(ProductPlane, BccPairsOf110PlanesGiveCubeVectorsThatGlideWhereTheyRunAlong111)
{
  // Planes at 60 degrees meet along <111>; with <100> that spans {011}. Planes at 90 degrees meet along <100>; with
  // another <100> that spans {001}: sessile. <110> = 1/2[111] + 1/2[11-1] never forms: 2 > 3/4 + 3/4.
  const SlipSystems systems(Lattice::bcc, a0);
  expect_table(systems, SlipFamily::bcc_110, SlipFamily::bcc_110,
               {{"self", 1}, {"coplanar", 1}, {"collinear", 2}, {"a<100> on {110}<100>", 6}, {"a<100> sessile", 2}});
  for (const SlipSystem &s : systems)
    for (const SlipSystem &t : systems)
    {
      if (same_burgers(s, t))
        continue;
      const Junction j = junction_of(systems, s, t);
      EXPECT_EQ(j.type, BurgersType::full_100);
      EXPECT_NEAR(j.energy_change, -a0 * a0 / 2, 1e-15);
    }
}

TEST(ProductPlane, HcpBasalAndPrismaticLinesReactToBasalLines)
{
  // The lines meet along the a of the prismatic plane; a1 + a2 = -a3 lies with it in the basal plane.
  expect_table(hcp(), SlipFamily::basal, SlipFamily::prismatic, {{"collinear", 1}, {"1/3<11-20> on basal <a>", 2}});
  // Prismatic planes meet along c, where no <a> glides but in their own planes.
  expect_table(hcp(), SlipFamily::prismatic, SlipFamily::prismatic, {{"self", 1}, {"1/3<11-20> on prismatic <a>", 2}});
}

TEST(ProductPlane, HcpBasalAndPyramidalLines)
{
  for (const double c_over_a : {1.5929, 1.886})
  {
    // Basal a with first-order c+a: the same a leaves <c>, sessile; the a of the pyramidal plane gives the other c+a of
    // that plane; the third one a c+a in a prismatic plane, which is no slip plane of it.
    expect_table(hcp(c_over_a), SlipFamily::pyramidal_ca, SlipFamily::basal,
                 {{"<0001> sessile", 1}, {"1/3<11-23> on first-order pyramidal <c+a>", 1}, {"1/3<11-23> sessile", 1}});
    expect_table(hcp(c_over_a), SlipFamily::pyramidal_a, SlipFamily::basal,
                 {{"collinear", 1}, {"1/3<11-20> on basal <a>", 2}});
  }
}

TEST(ProductPlane, DoesNotDependOnTheSensesOfLineAndBurgersVector)
{
  for (const SlipSystems &systems : {SlipSystems(Lattice::fcc, a0), SlipSystems(Lattice::bcc, a0, {}, {true}), hcp()})
    for (const SlipSystem &s : systems)
      for (const SlipSystem &t : systems)
      {
        if (s.plane == t.plane || same_burgers(s, t))
          continue;
        const Junction j = junction_of(systems, s, t);
        const auto plane = product_plane(systems, j.xi, j.burgers);
        EXPECT_EQ(product_plane(systems, -j.xi, j.burgers), plane);
        EXPECT_EQ(product_plane(systems, j.xi, -j.burgers), plane);
      }
}

TEST(ProductPlane, GlissileProductsMapOntoGlissileProductsUnderTheSymmetryOfTheCrystal)
{
  for (const SlipSystems &systems : {SlipSystems(Lattice::fcc, a0), SlipSystems(Lattice::bcc, a0), hcp()})
    for (const SlipSystem &s : systems)
      for (const SlipSystem &t : systems)
      {
        if (s.plane == t.plane || same_burgers(s, t))
          continue;
        const Junction j = junction_of(systems, s, t);
        const bool screw = j.xi.cross(j.burgers).norm() < 1e-6 * a0;
        const auto plane = product_plane(systems, j.xi, j.burgers);
        for (const Mat3 &g : test::point_group(systems.lattice()))
        {
          const auto image = product_plane(systems, g * j.xi, g * j.burgers);
          ASSERT_EQ(image.has_value(), plane.has_value()) << s.name << t.name;
          if (!image || screw) // which of its planes a screw takes depends on their order
            continue;
          EXPECT_LT((g * systems.planes()[*plane].normal).cross(systems.planes()[*image].normal).norm(), 1e-9);
        }
      }
}

TEST(ProductPlane, ScrewKeepsAParentPlaneAndOtherwiseTakesTheFirst)
{
  const SlipSystems zirconium = hcp();
  const Vec3 a = a0 * Vec3::UnitX(), xi = Vec3::UnitX();
  const auto family = [&](const std::optional<std::size_t> plane) { return zirconium.family(a, plane.value()); };
  EXPECT_EQ(family(product_plane(zirconium, xi, a)), SlipFamily::prismatic);
  for (const std::size_t parent : zirconium.glissile_planes(a))
  {
    const std::array<std::size_t, 2> parents = {zirconium.planes().size() - 1, parent}; // the first one does not hold a
    EXPECT_EQ(product_plane(zirconium, xi, a, parents), parent);
  }
  const SlipSystems iron(Lattice::bcc, a0);
  const Vec3 b = shortest_translation(Lattice::bcc, a0, {}, {1, 1, 1});
  EXPECT_EQ(iron.family(b, *product_plane(iron, b.normalized(), b)), SlipFamily::bcc_110);
}

TEST(ProductPlane, LineMustLieInThePlane)
{
  const SlipSystems fcc(Lattice::fcc, a0);
  const SlipSystem &s = fcc[0];
  const Vec3 edge = s.normal.cross(s.burgers).normalized();
  const auto tilted = [&](const double angle) -> Vec3 { return std::cos(angle) * edge + std::sin(angle) * s.normal; };
  EXPECT_EQ(product_plane(fcc, edge, s.burgers), s.plane);
  EXPECT_EQ(product_plane(fcc, tilted(0.9e-4), s.burgers), s.plane);
  EXPECT_FALSE(product_plane(fcc, tilted(1.1e-4), s.burgers).has_value());
  EXPECT_FALSE(product_plane(fcc, edge, Vec3(2 * s.burgers)).has_value());
}
} // namespace
