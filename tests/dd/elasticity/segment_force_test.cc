#include "dd/elasticity/segment_energy.h"
#include "dd/elasticity/segment_force.h"
#include "dd/elasticity/segment_stress.h"
#include "dd/elasticity/self_force.h"
#include "tests/dd/elasticity/elasticity_test_helpers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace ddfem
{
namespace
{
using test::copper_like;
using test::RandomVectors;
using test::relative_error;

constexpr double pi = std::numbers::pi;

/// Derivative of @p energy with respect to node @p node, fourth-order differences.
Vec3 gradient(const std::function<double(const std::vector<Vec3> &)> &energy, const std::vector<Vec3> &nodes,
              std::size_t node, double h)
{
  Vec3 result;
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto at = [&](double shift)
    {
      std::vector<Vec3> moved = nodes;
      moved[node][axis] += shift;
      return energy(moved);
    };
    result[axis] = (8.0 * (at(h) - at(-h)) - at(2.0 * h) + at(-2.0 * h)) / (12.0 * h);
  }
  return result;
}

double loop_energy(const IsotropicMedium &medium, const std::vector<Vec3> &x, const Vec3 &b)
{
  double energy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    const Vec3 &i_end = x[(i + 1) % x.size()];
    energy += segment_self_energy(medium, x[i], i_end, b);
    for (std::size_t j = i + 1; j < x.size(); ++j)
      energy += segment_interaction_energy(medium, x[i], i_end, b, x[j], x[(j + 1) % x.size()], b);
  }
  return energy;
}

std::vector<Vec3> loop_forces(const IsotropicMedium &medium, const std::vector<Vec3> &x, const Vec3 &b)
{
  std::vector<Vec3> forces(x.size(), Vec3::Zero());
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < x.size(); ++j)
    {
      const std::size_t i_end = (i + 1) % x.size(), j_end = (j + 1) % x.size();
      const SegmentForces f = i == j ? self_force(medium, x[i], x[i_end], b)
                                     : segment_force(medium, x[j], x[j_end], b, x[i], x[i_end], b, 1e-12);
      forces[i] += f.start;
      forces[i_end] += f.end;
    }
  return forces;
}

TEST(ClosedLoop, NodalForcesAreMinusTheGradientOfTheEnergy)
{
  RandomVectors random(1);
  const std::vector<Vec3> nodes{2.0 * random.vector(), 2.0 * random.vector(), 2.0 * random.vector(),
                                2.0 * random.vector()};
  const Vec3 b = random.vector();
  const auto energy = [&](const std::vector<Vec3> &x) { return loop_energy(copper_like, x, b); };
  const std::vector<Vec3> forces = loop_forces(copper_like, nodes, b);
  // Fourth-order differences: truncation (h/a)^4 ~ 1e-10 and rounding 1e-15/h.
  for (std::size_t i = 0; i < nodes.size(); ++i)
    EXPECT_LT(relative_error(forces[i], -gradient(energy, nodes, i, 1e-3)), 1e-8) << "node " << i;
}

TEST(ClosedLoop, SumOfItsOwnNodalForcesVanishes)
{
  RandomVectors random(2);
  const std::vector<Vec3> nodes{random.vector(), random.vector(), random.vector(), random.vector(), random.vector()};
  Vec3 sum = Vec3::Zero();
  double scale = 0.0;
  for (const Vec3 &f : loop_forces(copper_like, nodes, random.vector()))
  {
    sum += f;
    scale = std::max(scale, f.norm());
  }
  EXPECT_LT(sum.norm(), 1e-10 * scale);
}

TEST(TwoLoops, ForcesOfOneOnTheOtherAreEqualAndOpposite)
{
  RandomVectors random(3);
  std::vector<Vec3> first, second;
  for (int i = 0; i < 3; ++i)
  {
    first.push_back(random.vector());
    second.push_back(random.vector() + Vec3(1, 0, 0));
  }
  const Vec3 b1 = random.vector(), b2 = random.vector();
  Vec3 sum = Vec3::Zero(), on_first = Vec3::Zero();
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
    {
      const Vec3 &p = first[i], &q = first[(i + 1) % 3], &r = second[j], &s = second[(j + 1) % 3];
      const SegmentForces f = segment_force(copper_like, r, s, b2, p, q, b1, 1e-12);
      const SegmentForces g = segment_force(copper_like, p, q, b1, r, s, b2, 1e-12);
      on_first += f.start + f.end;
      sum += f.start + f.end + g.start + g.end;
    }
  EXPECT_LT(sum.norm(), 1e-10 * on_first.norm());
}

TEST(ParallelLines, ForcesAreEqualAndOppositeUpToTheEnds)
{
  // Action and reaction hold for closed or infinite lines. For open segments they differ by what the missing rest would
  // add: a contribution of the ends, that is a fraction 1/length of the force.
  const Vec3 shift(0.4, 0.3, 0.0), b1(0.1, 0.0, 0.2), b2(0.0, 0.1, -0.1);
  const auto imbalance = [&](double length)
  {
    const Vec3 x1(0, 0, 0), x2(0, 0, length);
    const SegmentForces on_second = segment_force(copper_like, x1, x2, b1, x1 + shift, x2 + shift, b2);
    const SegmentForces on_first = segment_force(copper_like, x1 + shift, x2 + shift, b2, x1, x2, b1);
    const Vec3 total = on_second.start + on_second.end;
    return (total + on_first.start + on_first.end).norm() / total.norm();
  };
  EXPECT_LT(imbalance(100.0), 1e-2);
  EXPECT_NEAR(imbalance(1000.0) / imbalance(100.0), 0.1, 0.01);
}

TEST(Force, IsBilinearInTheBurgersVectors)
{
  RandomVectors random(4);
  const Vec3 x1 = random.vector(), x2 = random.vector(), x3 = random.vector(), x4 = random.vector();
  const Vec3 b = random.vector(), c = random.vector(), d = random.vector();
  const auto end = [&](const Vec3 &b12, const Vec3 &b34)
  { return segment_force(copper_like, x1, x2, b12, x3, x4, b34).end; };
  EXPECT_LT(relative_error(end(2.0 * b - c, d), 2.0 * end(b, d) - end(c, d)), 1e-12);
  EXPECT_LT(relative_error(end(d, 2.0 * b - c), 2.0 * end(d, b) - end(d, c)), 1e-12);
}

TEST(Force, DoesNotDependOnTheLineSense)
{
  RandomVectors random(5);
  const Vec3 x1 = random.vector(), x2 = random.vector(), x3 = random.vector(), x4 = random.vector();
  const Vec3 b = random.vector(), c = random.vector();
  const SegmentForces f = segment_force(copper_like, x1, x2, b, x3, x4, c, 1e-12);
  const SegmentForces g = segment_force(copper_like, x2, x1, -b, x4, x3, -c, 1e-12);
  EXPECT_LT(relative_error(f.start, g.end), 1e-10);
  EXPECT_LT(relative_error(f.end, g.start), 1e-10);
}

TEST(Force, MovesAndTurnsWithTheBody)
{
  RandomVectors random(6);
  const Mat3 rotation = random.rotation();
  const Vec3 shift = random.vector();
  const auto moved = [&](const Vec3 &v) { return Vec3(rotation * v + shift); };
  const Vec3 x1 = random.vector(), x2 = random.vector(), x3 = random.vector(), x4 = random.vector();
  const Vec3 b = random.vector(), c = random.vector();
  const SegmentForces f = segment_force(copper_like, x1, x2, b, x3, x4, c);
  const SegmentForces g =
      segment_force(copper_like, moved(x1), moved(x2), rotation * b, moved(x3), moved(x4), rotation * c);
  EXPECT_LT(relative_error(g.start, rotation * f.start), 1e-11);
  EXPECT_LT(relative_error(g.end, rotation * f.end), 1e-11);
}

TEST(Force, OfSplitSegmentsAddsUp)
{
  RandomVectors random(7);
  for (const double angle : {0.0, 1e-7, 1e-3, 0.3})
  {
    // Passing each other at a third of the core radius, fifty long.
    const Vec3 along(std::cos(angle), std::sin(angle), 0.0), x3 = Vec3(-20, 0, 0.1), x4 = x3 + 50.0 * along;
    const Vec3 x1(-25, 0, 0), x2(25, 0, 0), middle(3, 0, 0), b = random.vector(), c = random.vector();
    const SegmentForces whole = segment_force(copper_like, x1, x2, b, x3, x4, c);
    const SegmentForces left = segment_force(copper_like, x1, middle, b, x3, x4, c);
    const SegmentForces right = segment_force(copper_like, middle, x2, b, x3, x4, c);
    EXPECT_LT(relative_error(left.start + right.start, whole.start), 1e-9) << "angle " << angle;
    EXPECT_LT(relative_error(left.end + right.end, whole.end), 1e-9) << "angle " << angle;
  }
}

TEST(ForceFromRay, IsTheForceOfASegmentAndTheRestOfTheRay)
{
  RandomVectors random(8);
  for (int i = 0; i < 100; ++i)
  {
    const Vec3 origin = random.vector(), direction = random.vector().normalized(), cut = origin + 2.0 * direction;
    const Vec3 x3 = random.vector(), x4 = random.vector(), b = random.vector(), c = random.vector();
    const SegmentForces whole = segment_force_from_ray(copper_like, origin, direction, b, x3, x4, c, 1e-11);
    const SegmentForces near = segment_force(copper_like, origin, cut, b, x3, x4, c, 1e-11);
    const SegmentForces rest = segment_force_from_ray(copper_like, cut, direction, b, x3, x4, c, 1e-11);
    EXPECT_LT(relative_error(near.start + rest.start, whole.start), 1e-8) << "case " << i;
    EXPECT_LT(relative_error(near.end + rest.end, whole.end), 1e-8) << "case " << i;
  }
}

TEST(SelfForce, IsTheForceOfTheSegmentsOwnStress)
{
  RandomVectors random(9);
  for (const double length : {0.01, 0.1, 1.0, 10.0, 1000.0})
  {
    const Vec3 x1 = random.vector(), x2 = x1 + length * random.vector(), b = random.vector();
    const SegmentForces closed = self_force(copper_like, x1, x2, b);
    const SegmentForces integrated = segment_force(copper_like, x1, x2, b, x1, x2, b, 1e-12);
    // Rounding of the positions on the segment moves points off it; on a scale of a that matters when the line is long.
    EXPECT_LT(relative_error(closed.start, integrated.start), 1e-9) << "length " << length;
    EXPECT_LT(relative_error(closed.end, integrated.end), 1e-9) << "length " << length;
    EXPECT_EQ(closed.start, -closed.end);
  }
}

TEST(SelfForce, OfVeryShortSegmentsFollowsTheSeries)
{
  // Both sides of the switch to the series.
  const Vec3 b(0.3, 0.2, 0.1), t(1, 0, 0);
  const auto scaled = [&](double u)
  { return self_force(copper_like, Vec3::Zero(), u * copper_like.a * t, b).end[1] / std::pow(u, 3); };
  EXPECT_NEAR(scaled(0.03 * (1 - 1e-9)) / scaled(0.03 * (1 + 1e-9)), 1.0, 1e-9);
  EXPECT_TRUE(std::isfinite(scaled(1e-6)));
}

TEST(SelfForce, TurnsAMixedSegmentTowardsScrew)
{
  // nu > 0: screw is the character of lowest energy. At L >> a the logarithm dominates.
  const Vec3 b(0.1, 0.1, 0.0);
  const SegmentForces f = self_force(copper_like, {0, 0, 0}, {1000, 0, 0}, b);
  EXPECT_GT(f.end[1], 0.0);
  EXPECT_LT(f.start[1], 0.0);
}

TEST(CoreForce, IsMinusTheGradientOfTheCoreEnergy)
{
  RandomVectors random(10);
  const CoreEnergy core{.core_radius_cutoff = 0.1};
  const std::vector<Vec3> nodes{random.vector(), random.vector()};
  const Vec3 b = random.vector();
  const auto energy = [&](const std::vector<Vec3> &x) { return core_energy(copper_like, core, x[0], x[1], b); };
  const SegmentForces f = core_force(copper_like, core, nodes[0], nodes[1], b);
  EXPECT_LT(relative_error(f.start, -gradient(energy, nodes, 0, 1e-3)), 1e-9);
  EXPECT_LT(relative_error(f.end, -gradient(energy, nodes, 1, 1e-3)), 1e-9);
}

TEST(CoreEnergy, MakesTheEnergyOfALongLineIndependentOfTheCoreRadius)
{
  const CoreEnergy core{.core_radius_cutoff = 0.25};
  const Vec3 x1(0, 0, 0), x2(1e4, 0, 0), b(0.1, 0.2, 0.0);
  const auto elastic = [&](double a)
  {
    IsotropicMedium medium = copper_like;
    medium.a = a;
    return segment_self_energy(medium, x1, x2, b);
  };
  const auto total = [&](double a)
  {
    IsotropicMedium medium = copper_like;
    medium.a = a;
    return segment_self_energy(medium, x1, x2, b) + core_energy(medium, core, x1, x2, b);
  };
  EXPECT_EQ(total(0.25), elastic(0.25));
  // The remainder is of relative order a/L.
  EXPECT_NEAR(total(2.5) / total(0.25), 1.0, 1e-3);
  EXPECT_GT(std::abs(elastic(2.5) / elastic(0.25) - 1.0), 0.1);
}

TEST(SelfEnergy, IsHalfTheInteractionEnergyWithItself)
{
  RandomVectors random(11);
  for (const double length : {0.1, 1.0, 30.0})
  {
    const Vec3 x1 = random.vector(), x2 = x1 + length * random.vector(), b = random.vector();
    const double twice = segment_interaction_energy(copper_like, x1, x2, b, x1, x2, b);
    EXPECT_NEAR(2.0 * segment_self_energy(copper_like, x1, x2, b) / twice, 1.0, 1e-11) << "length " << length;
  }
}

TEST(InteractionEnergy, IsSymmetricInTheSegments)
{
  RandomVectors random(12);
  const Vec3 x1 = random.vector(), x2 = random.vector(), x3 = random.vector(), x4 = random.vector();
  const Vec3 b = random.vector(), c = random.vector();
  const double w = segment_interaction_energy(copper_like, x1, x2, b, x3, x4, c);
  EXPECT_NEAR(segment_interaction_energy(copper_like, x3, x4, c, x1, x2, b) / w, 1.0, 1e-10);
}

/// Regular polygon of @p n sides in the plane z = 0, with the area of the circle of radius @p radius.
std::vector<Vec3> polygon(int n, double radius)
{
  // Equal area: the leading error of the energy, O(1/n^2), becomes smaller than that of the inscribed polygon.
  const double circumradius = radius * std::sqrt(2.0 * pi / (n * std::sin(2.0 * pi / n)));
  std::vector<Vec3> nodes;
  for (int i = 0; i < n; ++i)
    nodes.emplace_back(circumradius * std::cos(2.0 * pi * i / n), circumradius * std::sin(2.0 * pi * i / n), 0.0);
  return nodes;
}

/// Energy of the circle from polygons whose sides resolve the curvature; their error falls with 1/n^2.
double circle_energy(double radius, const Vec3 &b)
{
  const double coarse = loop_energy(copper_like, polygon(100, radius), b);
  const double fine = loop_energy(copper_like, polygon(200, radius), b);
  return fine + (fine - coarse) / 3.0;
}

double cai_prismatic_energy(double radius, double b)
{
  return copper_like.mu * b * b * radius / (2.0 * (1.0 - copper_like.nu)) *
         (std::log(8.0 * radius / copper_like.a) - 1.0);
}

/// From the energy double integral: with I = int int t.t'/R_a = 4 pi R (ln(8R/a) - 2) and int int a^2/R_a^3 = 4 pi R to
/// leading order (only s << R counts), W = mu b^2/(16 pi) { I + (4 pi R)/2 + I/(1-nu) }.
double glide_energy(double radius, double b)
{
  const double nu = copper_like.nu, logarithm = std::log(8.0 * radius / copper_like.a);
  return 0.25 * copper_like.mu * b * b * radius * ((2.0 - nu) / (1.0 - nu) * (logarithm - 2.0) + 0.5);
}

// The closed forms are limits for R >> a: relative error of order (a/R)^2 ln(R/a) ~ 2e-3 times a small factor. The
// polygons are better than that.
TEST(CircularLoop, PrismaticEnergyIsTheClosedForm)
{
  EXPECT_NEAR(circle_energy(15.0, {0, 0, 0.25}) / cai_prismatic_energy(15.0, 0.25), 1.0, 2e-4);
}

TEST(CircularLoop, GlideEnergyIsTheClosedForm)
{
  EXPECT_NEAR(circle_energy(15.0, {0.25, 0, 0}) / glide_energy(15.0, 0.25), 1.0, 2e-4);
}

TEST(CircularLoop, ShrinkingForceIsTheDerivativeOfTheClosedFormEnergy)
{
  // Uniform scaling: sum f.x = -R dW/dR. Forces come from stresses, so that this tests the energy constants
  // independently of the energy kernel.
  const double radius = 15.0, b = 0.25, h = 1e-3;
  const auto derivative = [&](double (*energy)(double, double))
  { return (energy(radius * (1.0 + h), b) - energy(radius * (1.0 - h), b)) / (2.0 * h); };
  const auto virial = [&](const Vec3 &burgers)
  {
    const std::vector<Vec3> nodes = polygon(200, radius);
    const std::vector<Vec3> forces = loop_forces(copper_like, nodes, burgers);
    double sum = 0.0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      sum += forces[i].dot(nodes[i]);
    return -sum;
  };
  EXPECT_NEAR(virial({0, 0, b}) / derivative(cai_prismatic_energy), 1.0, 5e-4);
  EXPECT_NEAR(virial({b, 0, 0}) / derivative(glide_energy), 1.0, 5e-4);
}

TEST(CircularLoop, EnergyOfPolygonsConvergesWithTheirNumberOfSides)
{
  const double limit = circle_energy(5.0, {0, 0, 0.25});
  double previous = 1.0;
  for (const int n : {10, 20, 40, 80})
  {
    const double error = std::abs(loop_energy(copper_like, polygon(n, 5.0), {0, 0, 0.25}) / limit - 1.0);
    EXPECT_LT(error, 0.5 * previous) << n << " sides";
    previous = error;
  }
  EXPECT_LT(previous, 1e-3);
}
} // namespace
} // namespace ddfem
