#include "dd/elasticity/gauss.h"
#include "dd/elasticity/segment_stress.h"
#include "tests/dd/elasticity/elasticity_test_helpers.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace ddfem
{
namespace
{
using test::copper_like;
using test::RandomVectors;
using test::relative_error;

constexpr double pi = std::numbers::pi;

IsotropicMedium without_core()
{
  IsotropicMedium medium = copper_like;
  medium.a = 0.0;
  return medium;
}

/// Infinite straight line along +z through the origin as two opposite rays.
SymTensor two_rays(const IsotropicMedium &medium, const Vec3 &x, const Vec3 &b)
{
  // The second ray runs along -z; its sense, and with it b, is reversed.
  return ray_stress(medium, x, Vec3::Zero(), Vec3::UnitZ(), b) +
         ray_stress(medium, x, Vec3::Zero(), -Vec3::UnitZ(), -b);
}

TEST(InfiniteStraightLine, ScrewHasTheTextbookShearStress)
{
  const IsotropicMedium medium = without_core();
  const double x = 1.3, y = -0.7, b = 0.25, r2 = x * x + y * y;
  SymTensor expected = SymTensor::Zero();
  expected[4] = -medium.mu * b * y / (2.0 * pi * r2);
  expected[5] = medium.mu * b * x / (2.0 * pi * r2);
  EXPECT_LT(relative_error(two_rays(medium, {x, y, 0.4}, {0, 0, b}), expected), 1e-14);
  // A segment of half length H misses terms of order (r/H)^2.
  const SymTensor segment = segment_stress(medium, {x, y, 0.4}, {0, 0, -1e6}, {0, 0, 1e6}, {0, 0, b});
  EXPECT_LT(relative_error(segment, expected), 1e-11);
}

TEST(InfiniteStraightLine, EdgeHasTheTextbookStress)
{
  const IsotropicMedium medium = without_core();
  const double x = 1.3, y = -0.7, b = 0.25, r2 = x * x + y * y;
  const double d = medium.mu * b / (2.0 * pi * (1.0 - medium.nu) * r2 * r2);
  SymTensor expected = SymTensor::Zero();
  expected[0] = -d * y * (3.0 * x * x + y * y);
  expected[1] = d * y * (x * x - y * y);
  expected[2] = medium.nu * (expected[0] + expected[1]);
  expected[3] = d * x * (x * x - y * y);
  EXPECT_LT(relative_error(two_rays(medium, {x, y, 0.4}, {b, 0, 0}), expected), 1e-14);
  const SymTensor segment = segment_stress(medium, {x, y, 0.4}, {0, 0, -1e6}, {0, 0, 1e6}, {b, 0, 0});
  EXPECT_LT(relative_error(segment, expected), 1e-6);
}

TEST(InfiniteStraightLine, OppositeRaysDoNotDependOnWhereTheyMeet)
{
  RandomVectors random(1);
  const Vec3 direction = random.vector().normalized(), b = random.vector(), x(0.3, 0.2, -0.9);
  const auto line = [&](double shift)
  {
    const Vec3 origin = shift * direction;
    return SymTensor(ray_stress(copper_like, x, origin, direction, b) +
                     ray_stress(copper_like, x, origin, -direction, -b));
  };
  const SymTensor reference = line(0.0);
  for (const double shift : {-100.0, -3.0, 0.1, 1.0, 50.0})
    EXPECT_LT(relative_error(line(shift), reference), 1e-12) << "meeting point at " << shift;
}

TEST(Ray, IsTheSumOfASegmentAndTheRestOfTheRay)
{
  RandomVectors random(2);
  for (int i = 0; i < 200; ++i)
  {
    const Vec3 origin = random.vector(), direction = random.vector().normalized(), b = random.vector();
    const Vec3 x = 5.0 * random.vector();
    const double length = std::pow(10.0, 2.0 * random.number());
    const Vec3 cut = origin + length * direction;
    const SymTensor whole = ray_stress(copper_like, x, origin, direction, b);
    const SymTensor parts =
        segment_stress(copper_like, x, origin, cut, b) + ray_stress(copper_like, x, cut, direction, b);
    EXPECT_LT(relative_error(parts, whole), 1e-12) << "case " << i;
  }
}

TEST(Ray, IsTheLimitOfALongSegment)
{
  RandomVectors random(3);
  const Vec3 origin = random.vector(), direction = random.vector().normalized(), b = random.vector();
  // In front of, behind, beside the origin and on the ray.
  for (const Vec3 &x :
       {Vec3(origin + 3.0 * direction + 0.1 * direction.unitOrthogonal()), Vec3(origin - 4.0 * direction),
        Vec3(origin + direction.unitOrthogonal()), Vec3(origin + 2.0 * direction)})
  {
    const SymTensor ray = ray_stress(copper_like, x, origin, direction, b);
    for (const double length : {1e4, 1e5, 1e6})
    {
      // What is missing, the rest of the ray, falls like 1/length in general; the scale is the stress at distance 1.
      const SymTensor segment = segment_stress(copper_like, x, origin, origin + length * direction, b);
      const double missing = (segment - ray).lpNorm<Eigen::Infinity>();
      EXPECT_LT(missing, copper_like.mu * b.norm() / length) << "length " << length << ", x " << x.transpose();
    }
  }
}

TEST(Ray, IsRegularOnItsLineAheadAndBehind)
{
  const Vec3 direction = Vec3(1, 2, 2) / 3.0, b(0.1, -0.2, 0.15);
  for (const double s : {-1e6, -10.0, -1.0, 1.0, 10.0, 1e6})
  {
    const SymTensor on = ray_stress(copper_like, s * direction, Vec3::Zero(), direction, b);
    const SymTensor beside =
        ray_stress(copper_like, s * direction + 1e-9 * direction.unitOrthogonal(), Vec3::Zero(), direction, b);
    EXPECT_TRUE(on.allFinite());
    EXPECT_LT((on - beside).lpNorm<Eigen::Infinity>(), 1e-5 * copper_like.mu) << s;
  }
  // Behind the origin there is no line, so that a core radius of zero is harmless there.
  EXPECT_TRUE(ray_stress(without_core(), -2.0 * direction, Vec3::Zero(), direction, b).allFinite());
}

/// Defining integral of the segment's stress by composite Gauss quadrature, as an independent reference.
SymTensor stress_by_quadrature(const IsotropicMedium &medium, const Vec3 &x, const Vec3 &x1, const Vec3 &x2,
                               const Vec3 &b, int n_panels)
{
  const Vec3 dx = x2 - x1;
  const GaussRule rule = gauss_rule(20);
  Mat3 sum = Mat3::Zero();
  for (int panel = 0; panel < n_panels; ++panel)
    for (std::size_t i = 0; i < rule.points.size(); ++i)
    {
      const Vec3 r = x - x1 - (panel + rule.points[i]) / n_panels * dx;
      const double ra = std::sqrt(r.squaredNorm() + medium.a * medium.a), a2 = medium.a * medium.a;
      const Vec3 e = b.cross(dx), rb = r.cross(b);
      const double i3 = std::pow(ra, -3), i5 = std::pow(ra, -5);
      const Mat3 sym_rb = rb * dx.transpose() + dx * rb.transpose(), sym_e = e * r.transpose() + r * e.transpose();
      sum += rule.weights[i] / n_panels *
             (-(i3 + 1.5 * a2 * i5) * sym_rb + (-i3 * sym_e + 3.0 * i5 * r.dot(e) * r * r.transpose() +
                                                r.dot(e) * (i3 + 3.0 * a2 * i5) * Mat3::Identity()) /
                                                   (1.0 - medium.nu));
    }
  return medium.mu / (4.0 * pi) * symmetric_part(sum);
}

TEST(Segment, StressIsTheDefiningIntegralForAllDistances)
{
  RandomVectors random(4);
  for (int i = 0; i < 300; ++i)
  {
    const Vec3 x1 = random.vector(), x2 = random.vector(), b = random.vector();
    const Vec3 x = std::pow(10.0, 3.0 * std::abs(random.number())) * random.vector();
    const SymTensor reference = stress_by_quadrature(copper_like, x, x1, x2, b, 20);
    EXPECT_LT(relative_error(segment_stress(copper_like, x, x1, x2, b), reference), 1e-11) << "case " << i;
  }
}

TEST(Segment, StressIsTheDefiningIntegralOnAndNearItsOwnLine)
{
  RandomVectors random(5);
  for (const double offset : {0.0, 1e-14, 1e-10, 1e-6, 1e-3, 1e-1})
    for (const double position : {-300.0, -1.0, -0.01, 0.0, 0.3, 1.0, 1.001, 2.0, 300.0})
    {
      const Vec3 x1 = random.vector(), x2 = random.vector(), b = random.vector();
      const Vec3 x = x1 + position * (x2 - x1) + offset * (x2 - x1).unitOrthogonal();
      const SymTensor reference = stress_by_quadrature(copper_like, x, x1, x2, b, 20);
      EXPECT_LT(relative_error(segment_stress(copper_like, x, x1, x2, b), reference), 1e-11)
          << "offset " << offset << " position " << position;
    }
}

TEST(Segment, StressNearTheFarEndOfAVeryLongSegmentKeepsItsDigits)
{
  // A segment is the difference of two rays; rounding must be relative to the distance from the nearer end.
  const Vec3 t = Vec3(1, 2, 2) / 3.0, b(0.1, 0.2, 0.3), x(0.1, -0.2, 0.15), end(0, 0, 0);
  for (const double length : {1e3, 1e6, 1e9})
  {
    const Vec3 far = -length * t;
    const SymTensor rays = ray_stress(copper_like, x, end, -t, -b) - ray_stress(copper_like, x, far, -t, -b);
    EXPECT_LT(relative_error(segment_stress(copper_like, x, far, end, b), rays), 1e-14) << "length " << length;
    EXPECT_LT(relative_error(segment_stress(copper_like, x, end, far, -b), rays), 1e-14) << "length " << length;
  }
}

TEST(Segment, StressIsContinuousAcrossTheChangeOfFormula)
{
  // Where the foot of the perpendicular passes an end of the segment.
  const Vec3 x1(0, 0, 0), x2(0, 0, 10), b(0.1, 0.2, 0.3);
  const SymTensor below = segment_stress(copper_like, {0.5, 0, -1e-15}, x1, x2, b);
  const SymTensor above = segment_stress(copper_like, {0.5, 0, 1e-15}, x1, x2, b);
  EXPECT_LT(relative_error(below, above), 1e-13);
}

TEST(Segment, StressOfNoLengthIsZero)
{
  const Vec3 x1(1, 2, 3), b(0.1, 0.2, 0.3);
  EXPECT_EQ(segment_stress(copper_like, {2, 2, 2}, x1, x1, b), SymTensor::Zero());
  EXPECT_EQ(segment_stress(copper_like, x1, x1, x1, b), SymTensor::Zero());
}

TEST(Segment, StressIsLinearInTheBurgersVectorAndOddInTheLineSense)
{
  RandomVectors random(6);
  const Vec3 x = 2.0 * random.vector(), x1 = random.vector(), x2 = random.vector();
  const Vec3 b1 = random.vector(), b2 = random.vector();
  const auto stress = [&](const Vec3 &b) { return segment_stress(copper_like, x, x1, x2, b); };
  EXPECT_LT(relative_error(stress(2.0 * b1 - 3.0 * b2), 2.0 * stress(b1) - 3.0 * stress(b2)), 1e-13);
  EXPECT_LT(relative_error(segment_stress(copper_like, x, x2, x1, -b1), stress(b1)), 1e-14);
}

TEST(Segment, StressMovesAndTurnsWithTheBody)
{
  RandomVectors random(7);
  const Mat3 rotation = random.rotation();
  const Vec3 shift = random.vector();
  const auto moved = [&](const Vec3 &v) { return Vec3(rotation * v + shift); };
  const Vec3 x = 2.0 * random.vector(), x1 = random.vector(), x2 = random.vector(), b = random.vector();
  const Vec3 direction = (x2 - x1).normalized();

  const auto turned = [&](const SymTensor &s)
  { return symmetric_part(rotation * to_matrix(s) * rotation.transpose()); };
  EXPECT_LT(relative_error(segment_stress(copper_like, moved(x), moved(x1), moved(x2), rotation * b),
                           turned(segment_stress(copper_like, x, x1, x2, b))),
            1e-13);
  EXPECT_LT(relative_error(ray_stress(copper_like, moved(x), moved(x1), rotation * direction, rotation * b),
                           turned(ray_stress(copper_like, x, x1, direction, b))),
            1e-13);
}

TEST(ClosedLine, TractionsOnACubeAroundTheLoopBalance)
{
  RandomVectors random(8);
  const std::array<Vec3, 4> nodes{random.vector(), random.vector(), random.vector(), random.vector()};
  const Vec3 b = random.vector();
  const auto stress = [&](const Vec3 &x)
  {
    SymTensor s = SymTensor::Zero();
    for (std::size_t k = 0; k < nodes.size(); ++k)
      s += segment_stress(copper_like, x, nodes[k], nodes[(k + 1) % nodes.size()], b);
    return s;
  };
  const double half = 1.5;
  const int n_panels = 4;
  const GaussRule rule = gauss_rule(12);
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double scale = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0})
      for (int i = 0; i < n_panels * 12; ++i)
        for (int j = 0; j < n_panels * 12; ++j)
        {
          const auto point = [&](int k)
          { return (k / 12 + rule.points[static_cast<std::size_t>(k % 12)]) / n_panels * 2.0 * half - half; };
          const auto weight = [&](int k)
          { return rule.weights[static_cast<std::size_t>(k % 12)] * 2.0 * half / n_panels; };
          Vec3 x, normal = Vec3::Zero();
          x[axis] = side * half;
          x[(axis + 1) % 3] = point(i);
          x[(axis + 2) % 3] = point(j);
          normal[axis] = side;
          const Vec3 traction = weight(i) * weight(j) * contract(stress(x), normal);
          force += traction;
          moment += x.cross(traction);
          scale += traction.norm();
        }
  EXPECT_LT(force.norm(), 1e-8 * scale);
  EXPECT_LT(moment.norm(), 1e-8 * scale);
}

TEST(ClosedLine, StressIsInEquilibriumInsideTheBody)
{
  RandomVectors random(9);
  const std::array<Vec3, 3> nodes{random.vector(), random.vector(), random.vector()};
  const Vec3 b = random.vector(), x(0.3, -0.2, 1.4);
  const auto stress = [&](const Vec3 &at)
  {
    SymTensor s = SymTensor::Zero();
    for (std::size_t k = 0; k < nodes.size(); ++k)
      s += segment_stress(copper_like, at, nodes[k], nodes[(k + 1) % nodes.size()], b);
    return s;
  };
  const double h = 1e-3;
  Vec3 divergence = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis)
  {
    const Vec3 step = h * Vec3::Unit(axis);
    const SymTensor derivative =
        (8.0 * (stress(x + step) - stress(x - step)) - stress(x + 2 * step) + stress(x - 2 * step)) / (12.0 * h);
    divergence += contract(derivative, Vec3::Unit(axis));
  }
  // Fourth-order differences: error ~ h^4 = 1e-12, and rounding 1e-16/h.
  EXPECT_LT(divergence.norm(), 1e-9 * stress(x).norm());
}
} // namespace
} // namespace ddfem
