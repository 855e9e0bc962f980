#include "dd/elasticity/segment_stress.h"
#include "dd/elasticity/triangle_displacement.h"
#include "tests/dd/elasticity/elasticity_test_helpers.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace ddfem
{
namespace
{
using test::RandomVectors;
using test::relative_error;

constexpr double pi = std::numbers::pi, nu = 0.34;
const IsotropicMedium medium{.mu = 50.0e3, .nu = nu, .a = 0.0};

/// Hooke's law on fourth-order differences of @p displacement.
template <typename Displacement>
SymTensor stress_by_differences(const Displacement &displacement, const Vec3 &x, double h)
{
  Mat3 gradient;
  for (int axis = 0; axis < 3; ++axis)
  {
    const Vec3 step = h * Vec3::Unit(axis);
    gradient.col(axis) = (8.0 * (displacement(x + step) - displacement(x - step)) - displacement(x + 2.0 * step) +
                          displacement(x - 2.0 * step)) /
                         (12.0 * h);
  }
  const double lambda = 2.0 * medium.mu * nu / (1.0 - 2.0 * nu);
  return symmetric_part(lambda * gradient.trace() * Mat3::Identity() + medium.mu * (gradient + gradient.transpose()));
}

/// Difference reduced by the nearest whole multiple of b.
Vec3 modulo_burgers(const Vec3 &u, const Vec3 &b)
{
  return u - std::round(u.dot(b) / b.squaredNorm()) * b;
}

TEST(SolidAngle, OfAnOctantIsHalfPiSignedByTheSideItIsSeenFrom)
{
  const Vec3 p1(1, 0, 0), p2(0, 1, 0), p3(0, 0, 1);
  EXPECT_NEAR(solid_angle({0, 0, 0}, p1, p2, p3), pi / 2.0, 1e-15);
  EXPECT_LT(solid_angle({1, 1, 1}, p1, p2, p3), 0.0);
  EXPECT_NEAR(solid_angle({0, 0, 0}, LoopVertex::towards(p1), LoopVertex::towards(p2), LoopVertex::at(p3)), pi / 2.0,
              1e-15);
}

TEST(SolidAngle, OfAHalfPlaneStripAndASectorAreElementary)
{
  // Quarter plane x, y > 0 seen from height h below its corner: a quarter of the half space.
  const auto corner = LoopVertex::at({0, 0, 0});
  const auto along_x = LoopVertex::towards(Vec3::UnitX()), along_y = LoopVertex::towards(Vec3::UnitY());
  EXPECT_NEAR(solid_angle({0, 0, -0.1}, corner, along_x, along_y), pi / 2.0, 1e-14);
  // Strip |y| < w, x > 0 from (0, 0, -h): half of the dihedral wedge, 2 atan(w/h).
  const double w = 0.7, h = 0.3;
  EXPECT_NEAR(solid_angle({0, 0, -h}, LoopVertex::at({0, w, 0}), LoopVertex::at({0, -w, 0}), along_x),
              2.0 * std::atan(w / h), 1e-14);
}

TEST(SolidAngle, OfTinyDistantTrianglesKeepsAllDigits)
{
  // Equilateral, centred below the point: Omega = area/R^2 (1 + O(1/R^2)).
  for (const double distance : {1e4, 1e6, 1e8})
  {
    const double area = 3.0 * std::sqrt(3.0) / 4.0;
    const auto corner = [&](int k) { return Vec3(std::cos(2 * pi * k / 3), std::sin(2 * pi * k / 3), distance); };
    EXPECT_NEAR(solid_angle(Vec3::Zero(), corner(0), corner(1), corner(2)) * distance * distance / area, 1.0,
                2.0 / (distance * distance) + 1e-14);
  }
}

TEST(Triangle, StressOfItsDisplacementIsThatOfItsSides)
{
  RandomVectors random(1);
  for (int i = 0; i < 20; ++i)
  {
    const std::array<Vec3, 3> p{random.vector(), random.vector(), random.vector()};
    const Vec3 b = random.vector(), x = 2.5 * (random.vector() + Vec3(1.5, 0, 0));
    const auto u = [&](const Vec3 &at) { return triangle_displacement(nu, at, p[0], p[1], p[2], b); };
    SymTensor expected = SymTensor::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      expected += segment_stress(medium, x, p[k], p[(k + 1) % 3], b);
    EXPECT_LT(relative_error(stress_by_differences(u, x, 1e-3), expected), 1e-7) << "case " << i;
  }
}

TEST(StripAndSector, StressOfTheDisplacementIsThatOfSegmentsAndRays)
{
  RandomVectors random(2);
  for (int i = 0; i < 20; ++i)
  {
    const Vec3 p1 = random.vector(), p2 = random.vector(), b = random.vector();
    const Vec3 d1 = random.vector().normalized(), d2 = random.vector().normalized();
    // Out of the way of the cut surface, where differences of the displacement see the jump.
    const Vec3 x = -3.0 * (d1 + d2).normalized() + random.vector();
    const auto strip = [&](const Vec3 &at)
    { return triangle_displacement(nu, at, LoopVertex::at(p1), LoopVertex::at(p2), LoopVertex::towards(d1), b); };
    const SymTensor strip_stress =
        ray_stress(medium, x, p2, d1, b) - ray_stress(medium, x, p1, d1, b) + segment_stress(medium, x, p1, p2, b);
    EXPECT_LT(relative_error(stress_by_differences(strip, x, 1e-3), strip_stress), 1e-7) << "strip " << i;

    const auto sector = [&](const Vec3 &at)
    { return triangle_displacement(nu, at, LoopVertex::at(p1), LoopVertex::towards(d1), LoopVertex::towards(d2), b); };
    const SymTensor sector_stress = ray_stress(medium, x, p1, d1, b) - ray_stress(medium, x, p1, d2, b);
    EXPECT_LT(relative_error(stress_by_differences(sector, x, 1e-3), sector_stress), 1e-7) << "sector " << i;
  }
}

TEST(Triangle, JumpAcrossTheCutIsTheBurgersVector)
{
  const Vec3 p1(0, 0, 0), p2(1, 0, 0), p3(0, 1, 0), b(0.1, -0.2, 0.3), x(0.2, 0.3, 0.0);
  const Vec3 step(0, 0, 1e-9);
  const Vec3 below = triangle_displacement(nu, x - step, p1, p2, p3, b);
  const Vec3 above = triangle_displacement(nu, x + step, p1, p2, p3, b);
  EXPECT_LT(relative_error(below - above, b), 1e-7);
  const Vec3 outside(0.8, 0.8, 0.0);
  EXPECT_LT((triangle_displacement(nu, outside - step, p1, p2, p3, b) -
             triangle_displacement(nu, outside + step, p1, p2, p3, b))
                .norm(),
            1e-8);
}

TEST(Triangle, DisplacementReversesWithTheCircuitAndIsLinearInB)
{
  RandomVectors random(3);
  const Vec3 p1 = random.vector(), p2 = random.vector(), p3 = random.vector(), x = 2.0 * random.vector();
  const Vec3 b = random.vector(), c = random.vector();
  const auto u = [&](const Vec3 &burgers) { return triangle_displacement(nu, x, p1, p2, p3, burgers); };
  EXPECT_LT(relative_error(triangle_displacement(nu, x, p3, p2, p1, b), -u(b)), 1e-13);
  EXPECT_LT(relative_error(u(2.0 * b - 3.0 * c), 2.0 * u(b) - 3.0 * u(c)), 1e-13);
}

TEST(Triangle, DisplacementMovesAndTurnsWithTheBody)
{
  RandomVectors random(4);
  const Mat3 rotation = random.rotation();
  const Vec3 shift = random.vector();
  const auto moved = [&](const Vec3 &v) { return Vec3(rotation * v + shift); };
  const Vec3 p1 = random.vector(), p2 = random.vector(), p3 = random.vector(), x = 2.0 * random.vector();
  const Vec3 b = random.vector();
  EXPECT_LT(relative_error(triangle_displacement(nu, moved(x), moved(p1), moved(p2), moved(p3), rotation * b),
                           rotation * triangle_displacement(nu, x, p1, p2, p3, b)),
            1e-12);
}

TEST(Strip, IsTheLimitOfATriangleWithADistantVertex)
{
  RandomVectors random(5);
  for (int i = 0; i < 20; ++i)
  {
    const Vec3 p1 = random.vector(), p2 = random.vector(), d = random.vector().normalized(), b = random.vector();
    const Vec3 x = 2.0 * random.vector();
    const auto strip = [&](const Vec3 &at)
    { return triangle_displacement(nu, at, LoopVertex::at(p1), LoopVertex::at(p2), LoopVertex::towards(d), b); };
    for (const double length : {1e4, 1e6})
    {
      // The sides of the triangle deviate from the rays by an angle |p1 - p2|/length.
      const Vec3 triangle = triangle_displacement(nu, x, p1, p2, 0.5 * (p1 + p2) + length * d, b);
      EXPECT_LT(modulo_burgers(strip(x) - triangle, b).norm(), 10.0 * b.norm() / length) << i << " at " << length;
    }
  }
}

TEST(Sector, IsTheLimitOfALargeTriangleUpToATranslation)
{
  RandomVectors random(6);
  for (int i = 0; i < 20; ++i)
  {
    const Vec3 p = random.vector(), b = random.vector();
    const Vec3 d1 = random.vector().normalized(), d2 = random.vector().normalized();
    const Vec3 x = 2.0 * random.vector(), y = 2.0 * random.vector();
    const double length = 1e6;
    const auto difference = [&](const Vec3 &at)
    {
      return Vec3(
          triangle_displacement(nu, at, LoopVertex::at(p), LoopVertex::towards(d1), LoopVertex::towards(d2), b) -
          triangle_displacement(nu, at, p, p + length * d1, p + length * d2, b));
    };
    EXPECT_LT(modulo_burgers(difference(x) - difference(y), b).norm(), 100.0 * b.norm() / length) << i;
  }
}

TEST(Sector, ReferenceLengthOnlyTranslates)
{
  const auto p = LoopVertex::at({0.1, 0.2, 0.3});
  const auto d1 = LoopVertex::towards(Vec3::UnitX()), d2 = LoopVertex::towards(Vec3(1, 2, 2) / 3.0);
  const Vec3 b(0.1, 0.2, -0.1);
  const auto change = [&](const Vec3 &x)
  { return Vec3(triangle_displacement(nu, x, p, d1, d2, b, 100.0) - triangle_displacement(nu, x, p, d1, d2, b)); };
  EXPECT_LT((change({1, 2, 3}) - change({-4, 0, 1})).norm(), 1e-14);
  EXPECT_GT(change({1, 2, 3}).norm(), 1e-3);
}

TEST(SweptArea, DisplacementDoesNotDependOnTheSubdivision)
{
  RandomVectors random(7);
  const Vec3 p1 = random.vector(), p2 = random.vector(), p3 = random.vector(), b = random.vector();
  const Vec3 inside = 0.2 * p1 + 0.5 * p2 + 0.3 * p3, x = 3.0 * random.vector();
  const auto u = [&](const Vec3 &q1, const Vec3 &q2, const Vec3 &q3)
  { return triangle_displacement(nu, x, q1, q2, q3, b); };
  EXPECT_LT(relative_error(u(p1, p2, inside) + u(p2, p3, inside) + u(p3, p1, inside), u(p1, p2, p3)), 1e-12);
}

/// A line from a fixed point over an inner node to a surface node, continued as a ray.
struct LineWithRay
{
  Vec3 inner, outer, direction;
};

const Vec3 fixed_point(-1, 0, 0);

/// Displacement increment of a move: every swept quadrilateral or strip cut into triangles, with the circuit
/// new -> old so that the boundary of the sum is (new line) - (old line).
Vec3 increment(const LineWithRay &from, const LineWithRay &to, const Vec3 &x, const Vec3 &b)
{
  const auto at = [](const Vec3 &p) { return LoopVertex::at(p); };
  const auto towards = [](const Vec3 &d) { return LoopVertex::towards(d); };
  Vec3 u = triangle_displacement(nu, x, fixed_point, to.inner, from.inner, b);
  u += triangle_displacement(nu, x, from.inner, to.inner, to.outer, b);
  u += triangle_displacement(nu, x, from.inner, to.outer, from.outer, b);
  u += triangle_displacement(nu, x, at(from.outer), at(to.outer), towards(to.direction), b);
  if (from.direction != to.direction)
    u += triangle_displacement(nu, x, at(from.outer), towards(to.direction), towards(from.direction), b);
  return u;
}

TEST(SweptArea, DisplacementOfMovesOfASegmentAndItsRayIsPathIndependent)
{
  RandomVectors random(8);
  const auto state = [&](bool turn)
  {
    const Vec3 base(1, 0, 0);
    return LineWithRay{0.3 * random.vector(), base + 0.3 * random.vector(),
                       turn ? (base + 0.3 * random.vector()).normalized() : base};
  };
  for (const bool turn : {false, true})
    for (int trial = 0; trial < 20; ++trial)
    {
      const std::array<LineWithRay, 3> states{state(turn), state(turn), state(turn)};
      const Vec3 b = random.vector(), x = 2.0 * random.vector(), y = 2.0 * random.vector();
      const auto around = [&](const Vec3 &at)
      {
        return Vec3(increment(states[0], states[1], at, b) + increment(states[1], states[2], at, b) +
                    increment(states[2], states[0], at, b));
      };
      if (turn)
        EXPECT_LT(modulo_burgers(around(x) - around(y), b).norm(), 1e-13 * b.norm()) << "trial " << trial;
      else
        EXPECT_LT(modulo_burgers(around(x), b).norm(), 1e-13 * b.norm()) << "trial " << trial;
    }
}

TEST(Triangle, DisplacementIsFiniteOnEdgesVerticesAndTheirExtensions)
{
  const Vec3 p1(0, 0, 0), p2(1, 0, 0), p3(0.3, 1, 0), b(0.1, 0.2, 0.3);
  for (const double s : {-100.0, -1.0, 0.0, 0.5, 1.0, 2.0, 100.0})
  {
    const Vec3 x = p1 + s * (p2 - p1);
    EXPECT_TRUE(triangle_displacement(nu, x, p1, p2, p3, b).allFinite()) << s;
    EXPECT_TRUE(triangle_displacement(nu, x, LoopVertex::at(p1), LoopVertex::at(p3), LoopVertex::towards({1, 0, 0}), b)
                    .allFinite())
        << s;
    EXPECT_TRUE(triangle_displacement(nu, x, LoopVertex::at(p1), LoopVertex::towards({1, 0, 0}),
                                      LoopVertex::towards({0, 1, 0}), b)
                    .allFinite())
        << s;
  }
}

TEST(Triangle, DisplacementOnTheExtensionOfAnEdgeIsItsLimit)
{
  const Vec3 p1(0, 0, 0), p2(1, 0, 0), p3(0.3, 1, 0), b(0.1, 0.2, 0.3);
  for (const double s : {-100.0, -1.0, -1e-3, 1.001, 2.0, 100.0})
  {
    const Vec3 x = p1 + s * (p2 - p1), on = triangle_displacement(nu, x, p1, p2, p3, b);
    const Vec3 beside = triangle_displacement(nu, x + Vec3(0, 1e-10, 1e-10), p1, p2, p3, b);
    EXPECT_LT((on - beside).norm(), 1e-6 * on.norm()) << s;
  }
}

TEST(Triangle, WithoutAreaHasNoDisplacement)
{
  const Vec3 p1(0, 0, 0), p2(1, 0, 0), b(0.1, 0.2, 0.3), x(0.2, 0.4, 0.5);
  EXPECT_LT(triangle_displacement(nu, x, p1, p2, p2, b).norm(), 1e-16);
  EXPECT_LT(triangle_displacement(nu, x, p1, p2, 0.3 * p2, b).norm(), 1e-16);
}

TEST(PrismaticLoop, DisplacementOnItsAxisIsTheClosedForm)
{
  // V15. The formula is for material added at the loop (u_z = + b/2 just above it), which for FS/RH and an
  // anticlockwise circuit seen from +z is b along -z. The triangle fan has the polygon's error, even in 1/n: one
  // Richardson step leaves O(1/n^4).
  const double radius = 2.0, b = 0.25;
  const auto on_axis = [&](int n, double z)
  {
    Vec3 u = Vec3::Zero();
    for (int k = 0; k < n; ++k)
    {
      const auto corner = [&](int i)
      { return Vec3(radius * std::cos(2 * pi * i / n), radius * std::sin(2 * pi * i / n), 0.0); };
      u += triangle_displacement(nu, {0, 0, z}, Vec3::Zero(), corner(k), corner(k + 1), {0, 0, -b});
    }
    return u;
  };
  for (const double z : {0.1, 0.5, 1.0, 2.0, 5.0, 20.0})
  {
    const double rho = std::hypot(radius, z);
    const double expected = 0.5 * b * (1.0 - z / rho) + b * radius * radius * z / (4.0 * (1.0 - nu) * std::pow(rho, 3));
    const Vec3 coarse = on_axis(200, z), fine = on_axis(400, z);
    const Vec3 u = fine + (fine - coarse) / 3.0;
    EXPECT_NEAR(u[2] / expected, 1.0, 1e-7) << "z " << z;
    EXPECT_LT(std::hypot(u[0], u[1]), 1e-12) << "z " << z;
  }
}
} // namespace
} // namespace ddfem
