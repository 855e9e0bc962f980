// Images under a free surface by expansions: the translation that integrates, single images, many.
#include "dd/elasticity/segment_stress.h"
#include "dd/fmm/half_line_translation.h"
#include "dd/fmm/multipole_images.h"
#include "dd/fmm/translation.h"
#include "samples/values.h"
#include "tests/dd/elasticity/elasticity_test_helpers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ddfem
{
namespace
{
using fmm::ImageSource;
using fmm::MultipoleImages;
using samples::difference;
using samples::rms;
using test::copper_like;
using test::RandomVectors;

constexpr double image_tolerance = 1e-10;

TEST(HalfLineTranslation, WithoutIntegrationIsTheUsualOne)
{
  RandomVectors random(2);
  constexpr int order = 9;
  const std::size_t n = fmm::n_harmonics(order);
  fmm::RowBuffer source(n), usual(n), dense(n);
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < fmm::row_width; ++i)
      source(k, i) = random.vector()[0];
  for (const Vec3 &shift : {Vec3(2, 0, 1), Vec3(-1, 3, 2), Vec3(0, 0, 2), Vec3(-2, -3, 1)})
  {
    usual.set_zero();
    dense.set_zero();
    fmm::Translation(fmm::Shift::far, order, shift).add(source.rows(), usual.rows());
    const auto matrices =
        std::make_shared<const fmm::HalfLineMatrices>(0, order, order, std::hypot(shift[0], shift[1]), shift[2]);
    fmm::HalfLineTranslation(matrices, shift).add(source.rows(), dense.rows());
    double largest = 0;
    for (std::size_t k = 0; k < n; ++k)
      largest = std::max(largest, std::abs(usual(k, 0)));
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t i = 0; i < fmm::row_width; ++i)
        EXPECT_NEAR(dense(k, i), usual(k, i), 1e-12 * largest);
  }
}

TEST(HalfLineTranslation, FunctionsAreThoseOfTheHalfSpace)
{
  const double x = 0.7, z = 1.2, r = std::hypot(x, z), s = 1 / (r + z);
  const fmm::IrregularFunctions f(4, x, z);
  EXPECT_NEAR(f(-1, 0), -std::log(r + z), 1e-14);
  EXPECT_NEAR(f(-2, 0), z * std::log(r + z) - r, 1e-14);
  EXPECT_NEAR(f(0, 0), 1 / r, 1e-14);
  EXPECT_NEAR(f(1, 0), z / (r * r * r), 1e-14);
  EXPECT_NEAR(f(0, 1), x * s / r, 1e-14);         // -d_x of I_-1,0
  EXPECT_NEAR(f(-1, 1), x * s, 1e-14);            // -d_x psi
  EXPECT_NEAR(f(0, 2), x * x * s * s / r, 1e-14); // psi_,xx - psi_,yy
  EXPECT_NEAR(f(1, 2), x * x / (r * r) * s * (1 / r + s), 1e-14);
  // d_z I_n = -I_n+1 by differences, m above, on and below the degree.
  constexpr double h = 1e-5;
  const fmm::IrregularFunctions above(4, x, z + h), below(4, x, z - h);
  for (int m = 0; m <= 7; ++m)
    for (int n = std::max(m - 3, -2); n < 4; ++n)
      EXPECT_NEAR((above(n, m) - below(n, m)) / (2 * h), -f(n + 1, m), 1e-8 * (1 + std::abs(f(n + 1, m)))) << n << m;
}

std::vector<Vec3> points_far_away(RandomVectors &random)
{
  std::vector<Vec3> points;
  for (int k = 0; k < 100; ++k)
  {
    points.emplace_back(Vec3(800, 850, 60) + 50 * random.vector()); // at the surface
    points.emplace_back(Vec3(100, 0, 800) + 50 * random.vector());  // in the depth
  }
  return points;
}

/// The stress of the mirrored leg that a closed piece has at the mirror image of @p x.
SymTensor leg_stress(const Vec3 &at, const Vec3 &x, const Vec3 &burgers)
{
  return ray_stress(copper_like, at, Vec3(x[0], x[1], -x[2]), -Vec3::UnitZ(),
                    Vec3(-burgers[0], -burgers[1], burgers[2]));
}

TEST(MultipoleImages, OfOneImageFarAwayAreTheClosedForms)
{
  const IsotropicMedium medium = copper_like;
  const Vec3 p(3, 4, 0), q(18, -9, 12), b(0.1, -0.2, 0.15);
  const SegmentImage segment(medium, p, q, b, image_tolerance);
  const LegImage leg(medium, Vec3(10, 5, 30), b);
  const PiercingImage piercing(medium, Vec3(2, 5, 0), b, image_tolerance);
  RandomVectors random(5);
  const std::vector<Vec3> points = points_far_away(random);
  const fmm::MultipoleSettings settings{1e-6, 0, 1e-6};
  const auto check = [&](const ImageSource &image, const auto &closed_stress)
  {
    std::vector<SymTensor> stress;
    std::vector<Vec3> u;
    for (const Vec3 &x : points)
    {
      stress.push_back(closed_stress(x));
      u.push_back(std::visit([&](const auto &i) { return i.displacement(x); }, image));
    }
    // What is left is the core to the fourth order, (a/d)^4, and rounding against the size of the terms.
    MultipoleImages of_stress(medium, MultipoleImages::Field::stress, settings, {&image, 1}, points);
    EXPECT_LT(rms(of_stress.stress(MPI_COMM_SELF, fmm::Part::near)), 1e-15);
    EXPECT_LT(rms(difference(of_stress.stress(MPI_COMM_SELF, fmm::Part::far), stress)), 1e-6 * rms(stress));
    MultipoleImages of_u(medium, MultipoleImages::Field::displacement, settings, {&image, 1}, points);
    EXPECT_LT(rms(difference(of_u.displacement(MPI_COMM_SELF, fmm::Part::far), u)), 1e-6 * rms(u));
  };
  check(segment,
        [&](const Vec3 &x) { return SymTensor(segment.stress(x) + leg_stress(x, q, b) - leg_stress(x, p, b)); });
  check(leg, [&](const Vec3 &x) { return SymTensor(leg.stress(x) - leg_stress(x, Vec3(10, 5, 30), b)); });
  check(piercing, [&](const Vec3 &x) { return SymTensor(piercing.stress(x) - leg_stress(x, Vec3(2, 5, 0), b)); });
}

/// Polygons under the surface, some of them cut: their lines begin on the surface and end in a leg.
std::vector<ImageSource> many_images(const IsotropicMedium &medium, RandomVectors &random)
{
  std::vector<ImageSource> images;
  for (int k = 0; k < 70; ++k)
  {
    Vec3 x = 480 * random.vector();
    x[2] = std::abs(x[2]) / 8;
    const Vec3 b = 0.25 * random.vector();
    const bool is_open = k % 4 == 0;
    if (is_open)
    {
      x[2] = 0;
      images.emplace_back(PiercingImage(medium, x, -b, image_tolerance));
    }
    const Vec3 first = x;
    for (int i = 0; i < 8; ++i)
    {
      Vec3 next = i == 7 && !is_open ? first : Vec3(x + 20 * random.vector());
      next[2] = i == 7 && is_open ? 80 : std::abs(next[2]);
      images.emplace_back(SegmentImage(medium, x, next, b, image_tolerance));
      x = next;
    }
    if (is_open)
      images.emplace_back(LegImage(medium, x, b));
  }
  return images;
}

TEST(MultipoleImages, HaveTheRequestedError)
{
  const IsotropicMedium medium = copper_like;
  RandomVectors random(3);
  const std::vector<ImageSource> images = many_images(medium, random);
  std::vector<Vec3> points;
  for (int k = 0; k < 900; ++k)
  {
    points.emplace_back(500 * random.vector());
    points.back()[2] = k % 3 == 0 ? 0 : 0.5 * std::abs(points.back()[2]);
  }
  std::vector<SymTensor> stress(points.size(), SymTensor::Zero());
  std::vector<Vec3> u(points.size(), Vec3::Zero());
  for (std::size_t k = 0; k < points.size(); ++k)
    for (const ImageSource &image : images)
    {
      stress[k] += std::visit([&](const auto &i) { return i.stress(points[k]); }, image);
      u[k] += std::visit([&](const auto &i) { return i.displacement(points[k]); }, image);
    }
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-6})
  {
    // A deeper tree than pays, so that most pairs are far.
    const fmm::MultipoleSettings settings{tolerance, 0, 0.02};
    MultipoleImages of_stress(medium, MultipoleImages::Field::stress, settings, images, points);
    EXPECT_GE(of_stress.octree().levels().size(), 4U);
    const double error =
        rms(difference(of_stress.stress(MPI_COMM_SELF), stress)) / rms(of_stress.stress(MPI_COMM_SELF, fmm::Part::far));
    EXPECT_LT(error, tolerance);
    EXPECT_GT(error, tolerance / 30) << "wasted work";
    MultipoleImages of_u(medium, MultipoleImages::Field::displacement, settings, images, points);
    const double error_of_u =
        rms(difference(of_u.displacement(MPI_COMM_SELF), u)) / rms(of_u.displacement(MPI_COMM_SELF, fmm::Part::far));
    EXPECT_LT(error_of_u, tolerance);
    RecordProperty("errors at " + std::to_string(tolerance), std::to_string(error) + " " + std::to_string(error_of_u));
  }
}
} // namespace
} // namespace ddfem
