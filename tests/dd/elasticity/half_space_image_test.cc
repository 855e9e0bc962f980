// Images of lines under a free plane: reference values, free surfaces, closed forms of infinite lines.
#include "dd/elasticity/half_space_image.h"
#include "dd/elasticity/segment_stress.h"
#include "elasticity_test_helpers.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <numbers>
#include <vector>

namespace ddfem::test
{
namespace
{
constexpr double tight = 1e-12;

Vec3 vector_of(const nlohmann::json &j)
{
  return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()};
}

SymTensor image_of_loop(const IsotropicMedium &m, const std::vector<Vec3> &loop, const Vec3 &b, const Vec3 &x,
                        const double tolerance)
{
  SymTensor sum = SymTensor::Zero();
  for (std::size_t k = 0; k < loop.size(); ++k)
    sum += SegmentImage(m, loop[k], loop[(k + 1) % loop.size()], b, tolerance).stress(x);
  return sum;
}

/// Points on z = 0 whose distance from the origin is between 0.3 and 2.
std::vector<Vec3> surface_points()
{
  std::vector<Vec3> points;
  for (int k = 0; k < 12; ++k)
    points.emplace_back((0.3 + 0.15 * k) * std::cos(1.7 * k), (0.3 + 0.15 * k) * std::sin(1.7 * k), 0.0);
  return points;
}

/// Largest traction on z = 0 over the points, relative to the largest of `infinite` alone.
template <typename Infinite, typename Image> double remaining_traction(const Infinite &infinite, const Image &image)
{
  double worst = 0, scale = 0;
  for (const Vec3 &x : surface_points())
  {
    const Vec3 before = contract(infinite(x), Vec3::UnitZ());
    worst = std::max(worst, (before + contract(image(x), Vec3::UnitZ())).norm());
    scale = std::max(scale, before.norm());
  }
  return worst / scale;
}

/// Stress by Hooke's law from central differences of a displacement field.
template <typename Displacement>
SymTensor stress_of_displacement(const IsotropicMedium &m, const Displacement &u, const Vec3 &x, const double h)
{
  Mat3 gradient;
  for (int c = 0; c < 3; ++c)
  {
    const Vec3 d = h * Vec3::Unit(c);
    gradient.col(c) = (8 * (u(Vec3(x + d)) - u(Vec3(x - d))) - (u(Vec3(x + 2 * d)) - u(Vec3(x - 2 * d)))) / (12 * h);
  }
  const Mat3 strain = 0.5 * (gradient + gradient.transpose());
  const double lambda = 2 * m.mu * m.nu / (1 - 2 * m.nu);
  return symmetric_part(2 * m.mu * strain + lambda * strain.trace() * Mat3::Identity());
}
} // namespace

TEST(HalfSpaceImage, OfTriangularLoopsAgreesWithMindlinsTensor)
{
  std::ifstream in(DDFEM_TEST_DATA "/halfspace_loops.json");
  const auto reference = nlohmann::json::parse(in);
  for (const auto &test : reference["cases"])
  {
    const IsotropicMedium m{test["mu"].get<double>(), test["nu"].get<double>(), 0.0};
    std::vector<Vec3> loop;
    for (const auto &v : test["vertices"])
      loop.push_back(vector_of(v));
    const Vec3 b = vector_of(test["b"]);
    double error = 0, scale = 0;
    for (std::size_t k = 0; k < test["points"].size(); ++k)
    {
      SymTensor expected;
      for (int c = 0; c < 6; ++c)
        expected[c] = test["image_stress"][k][static_cast<std::size_t>(c)].get<double>();
      const SymTensor value = image_of_loop(m, loop, b, vector_of(test["points"][k]), tight);
      error = std::max(error, (value - expected).lpNorm<Eigen::Infinity>());
      scale = std::max(scale, expected.lpNorm<Eigen::Infinity>());
    }
    EXPECT_LT(error, 1e-10 * scale); // the accuracy of the reference
  }
}

TEST(HalfSpaceImage, OfAClosedLoopFreesTheSurfaceToTheToleranceOfItsQuadrature)
{
  const IsotropicMedium m{50e3, 0.3, 0.0};
  const std::vector<Vec3> loop{{0.2, 0.1, 0.05}, {-0.6, 0.3, 0.3}, {-0.1, -0.5, 0.9}, {0.4, -0.2, 0.4}};
  const Vec3 b(0.1, -0.2, 0.15);
  const auto infinite = [&](const Vec3 &x)
  {
    SymTensor sum = SymTensor::Zero();
    for (std::size_t k = 0; k < loop.size(); ++k)
      sum += segment_stress(m, x, loop[k], loop[(k + 1) % loop.size()], b);
    return sum;
  };
  for (const double tolerance : {1e-2, 1e-4, 1e-8})
    EXPECT_LT(remaining_traction(infinite, [&](const Vec3 &x) { return image_of_loop(m, loop, b, x, tolerance); }),
              tolerance);
}

TEST(HalfSpaceImage, OfAClosedLoopFreesTheSurfaceForAnyCoreRadius)
{
  const std::vector<Vec3> loop{{0.2, 0.1, 0.05}, {-0.6, 0.3, 0.3}, {-0.1, -0.5, 0.9}, {0.4, -0.2, 0.4}};
  const Vec3 b(0.1, -0.2, 0.15);
  for (const double a : {0.01, 0.1, 0.5})
  {
    const IsotropicMedium m{50e3, 0.3, a};
    const auto infinite = [&](const Vec3 &x)
    {
      SymTensor sum = SymTensor::Zero();
      for (std::size_t k = 0; k < loop.size(); ++k)
        sum += segment_stress(m, x, loop[k], loop[(k + 1) % loop.size()], b);
      return sum;
    };
    EXPECT_LT(remaining_traction(infinite, [&](const Vec3 &x) { return image_of_loop(m, loop, b, x, 1e-9); }), 1e-9);
  }
}

class HalfLoopWithRays : public ::testing::TestWithParam<double>
{
};

// Points are 0.1 and more from where the lines end: within and beyond the core, and beyond the 30 core radii up to which it is integrated.
TEST_P(HalfLoopWithRays, AlongTheNormalFreesTheSurface)
{
  const double a = GetParam();
  const IsotropicMedium m{50e3, 0.3, a};
  const Vec3 p(0.11, 0.03, 0), q(0.05, 0.2, 0.5), r(-0.13, -0.1, 0), b(0.1, -0.2, 0.15), up(0, 0, -1);
  const auto infinite = [&](const Vec3 &x)
  {
    return SymTensor(segment_stress(m, x, p, q, b) + segment_stress(m, x, q, r, b) + ray_stress(m, x, r, up, b) -
                     ray_stress(m, x, p, up, b));
  };
  const auto image = [&](const Vec3 &x)
  {
    return SymTensor(SegmentImage(m, p, q, b, tight).stress(x) + SegmentImage(m, q, r, b, tight).stress(x) +
                     PiercingImage(m, r, b, tight).stress(x) + PiercingImage(m, p, -b, tight).stress(x));
  };
  EXPECT_LT(remaining_traction(infinite, image), 1e-10 + (a > 0 ? 2 * std::pow(30.0, -4) : 0));
}

INSTANTIATE_TEST_SUITE_P(OfCoreRadius, HalfLoopWithRays, ::testing::Values(0.0, 0.005, 0.02, 0.3));

TEST(HalfSpaceImage, OfASegmentClosedByLegsIntoTheDepthFreesTheSurface)
{
  for (const double a : {0.0, 0.01, 0.03}) // the legs begin more than 10 core radii deep: errors of (a/d)^4
  {
    const IsotropicMedium m{50e3, 0.3, a};
    const Vec3 p(0.11, 0.03, 0.4), q(-0.4, -0.2, 0.7), b(0.1, -0.2, 0.15), down(0, 0, 1);
    const auto infinite = [&](const Vec3 &x)
    { return SymTensor(segment_stress(m, x, p, q, b) + ray_stress(m, x, q, down, b) - ray_stress(m, x, p, down, b)); };
    const auto image = [&](const Vec3 &x)
    {
      return SymTensor(SegmentImage(m, p, q, b, tight).stress(x) + LegImage(m, q, b).stress(x) +
                       LegImage(m, p, -b).stress(x));
    };
    EXPECT_LT(remaining_traction(infinite, image), 1e-10 + 2 * std::pow(a / 0.4, 4));
  }
}

TEST(HalfSpaceImage, DisplacementsHaveTheStress)
{
  const IsotropicMedium m{50e3, 0.3, 0.0};
  const Vec3 p(0.11, 0.03, 0.4), q(-0.4, -0.2, 0.7), s(0.2, 0.3, 0), b(0.1, -0.2, 0.15), up(0, 0, -1);
  const Vec3 b_mirror(-b[0], -b[1], b[2]);
  const SegmentImage segment(m, p, q, b, tight);
  const LegImage leg(m, q, b);
  for (const Vec3 &x : {Vec3(0.3, -0.2, 0.5), Vec3(-0.2, 0.4, 0.05), Vec3(0.05, 0.02, 1.5)})
  {
    // The displacement of the segment has the mirrored legs, that of leg and piercing line lack them.
    const auto ray = [&](const Vec3 &origin) { return ray_stress(m, x, origin, up, b_mirror); };
    const Vec3 mp(p[0], p[1], -p[2]), mq(q[0], q[1], -q[2]);
    const SymTensor of_segment = segment.stress(x) + ray(mq) - ray(mp);
    const double scale = of_segment.lpNorm<Eigen::Infinity>(), h = 1e-3;
    const auto expect = [&](const SymTensor &expected, const auto &displacement)
    {
      const SymTensor difference = stress_of_displacement(m, displacement, x, h) - expected;
      EXPECT_LT(difference.norm(), 1e-6 * scale);
    };
    expect(of_segment, [&](const Vec3 &y) { return segment.displacement(y); });
    expect(leg.stress(x) - ray(mq), [&](const Vec3 &y) { return leg.displacement(y); });
    for (const double a : {0.0, 0.003, 0.02}) // beyond the 30 core radii up to which it is integrated, and within
    {
      const IsotropicMedium core{50e3, 0.3, a};
      const PiercingImage piercing(core, s, b, tight);
      const SymTensor mirrored_leg = ray_stress(core, x, s, up, b_mirror);
      expect(piercing.stress(x) - mirrored_leg, [&](const Vec3 &y) { return piercing.displacement(y); });
    }
  }
}

// Head, Proc. Phys. Soc. B 66 (1953) 793: line along the surface at depth d; the field less that of the infinite body.
TEST(HalfSpaceImage, OfALongEdgeIsThatOfHead)
{
  const IsotropicMedium m{50e3, 0.3, 0.0};
  const double d = 0.7, b = 0.25, half = 3000, D = m.mu * b / (2 * std::numbers::pi * (1 - m.nu));
  // Head's x is the depth z, his y is y, the line runs along x of the half-space.
  const Vec3 from(half, 0, d), to(-half, 0, d);
  const auto head_normal = [&](const double x, const double y)
  {
    const double X = x + d, r2 = X * X + y * y, r6 = r2 * r2 * r2;
    return std::array<double, 3>{
        D * (y * (3 * X * X + y * y) / (r2 * r2) + 4 * d * x * y * (3 * X * X - y * y) / r6),
        D * (-y * (X * X - y * y) / (r2 * r2) + 4 * d * y * ((2 * d - x) * X * X + (3 * x + 2 * d) * y * y) / r6),
        D * (-X * (X * X - y * y) / (r2 * r2) +
             2 * d * (-(x - d) * X * X * X + 6 * x * X * y * y - y * y * y * y) / r6)};
  };
  const auto head_along = [&](const double x, const double y)
  {
    const double X = x + d, r2 = X * X + y * y, r6 = r2 * r2 * r2, y4 = y * y * y * y;
    return std::array<double, 3>{
        D * (-X * (X * X - y * y) / (r2 * r2) + 2 * d * ((3 * x + d) * X * X * X - 6 * x * X * y * y - y4) / r6),
        D * (-X * (X * X + 3 * y * y) / (r2 * r2) - 2 * d * ((x - d) * X * X * X - 6 * x * X * y * y + y4) / r6),
        D * (-y * (X * X - y * y) / (r2 * r2) + 4 * d * x * y * (3 * X * X - y * y) / r6)};
  };
  for (const Vec3 &x : {Vec3(0, 0, 0.7), Vec3(0, 0.4, 0.2), Vec3(0, -1.1, 1.5), Vec3(0, 0.05, 0.02)})
  {
    // Frame of Head: (x, y, z) = (depth, y, line); the line sense -x makes it right-handed.
    const SymTensor normal = SegmentImage(m, from, to, Vec3(0, 0, b), 1e-10).stress(x);
    const SymTensor along = SegmentImage(m, from, to, Vec3(0, b, 0), 1e-10).stress(x);
    const auto expected_normal = head_normal(x[2], x[1]), expected_along = head_along(x[2], x[1]);
    const double scale = D / d;
    // Sense of the line: depth x y = -x, so that the line along -x has Head's z.
    EXPECT_NEAR(normal[2], expected_normal[0], 1e-5 * scale);
    EXPECT_NEAR(normal[1], expected_normal[1], 1e-5 * scale);
    EXPECT_NEAR(normal[5], expected_normal[2], 1e-5 * scale);
    EXPECT_NEAR(along[2], expected_along[0], 1e-5 * scale);
    EXPECT_NEAR(along[1], expected_along[1], 1e-5 * scale);
    EXPECT_NEAR(along[5], expected_along[2], 1e-5 * scale);
  }
}

TEST(HalfSpaceImage, OfALongScrewIsItsOpposite)
{
  const IsotropicMedium m{50e3, 0.3, 0.0};
  const double d = 0.4, b = 0.25;
  const SegmentImage image(m, Vec3(-3000, 0, d), Vec3(3000, 0, d), Vec3(b, 0, 0), 1e-10);
  const SymTensor s = image.stress(Vec3(0, 0, d));
  // sigma_xy of the opposite screw at the distance 2 d above.
  EXPECT_NEAR(std::abs(s[3]), m.mu * b / (2 * std::numbers::pi * 2 * d), 1e-5 * m.mu * b);
  EXPECT_NEAR(s.norm(), std::abs(s[3]), 1e-5 * m.mu * b);
}
} // namespace ddfem::test
