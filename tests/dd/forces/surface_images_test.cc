// Images of a whole network: what remains of the tractions on the faces, equilibrium, independence of the closure.
#include "dd/elasticity/segment_stress.h"
#include "dd/forces/segment_points.h"
#include "dd/forces/surface_images.h"
#include "dd/microstructure/sources.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace ddfem
{
namespace
{
// The core radius spoils the cancellation on the faces by (a/d)^2: far below what is asked of lines a few nm deep.
const IsotropicMedium medium{50e3, 0.3, 1e-4};
const Vec3 size(300, 200, 250);
const Vec3 burgers = 0.25 * Vec3(1, -2, 3).normalized();

/// Faces z+ and x-; the others have no images.
const std::vector<ImagePlane> planes{{5, Vec3(0, 0, size[2]), Vec3::UnitZ()}, {0, Vec3::Zero(), -Vec3::UnitX()}};

/// A line from face to face, near some of them and far from others, and a loop that dips into the range of the images.
Network lines_of_all_kinds(const GrainShape &shape)
{
  Network network;
  add_line(network,
           {Vec3(40, 60, size[2]), Vec3(60, 80, 180), Vec3(100, 90, 120), Vec3(140, 150, 90), Vec3(160, 200, 70)},
           burgers, {}, false, NodeConstraint::surface);
  add_line(network, {Vec3(0, 120, 200), Vec3(20, 110, 180), Vec3(30, 70, 100), Vec3(0, 50, 60)}, Vec3(0.1, 0.2, -0.1),
           {}, false, NodeConstraint::surface);
  add_line(network, {Vec3(200, 100, 235), Vec3(180, 60, 160), Vec3(220, 120, 100)}, burgers, {}, true,
           NodeConstraint::free);
  EXPECT_EQ(shape.face(Vec3(0, 120, 200)), 0);
  return network;
}

std::vector<Vec3> points_on_top()
{
  std::vector<Vec3> points;
  for (int i = 1; i < 12; ++i)
    for (int j = 1; j < 8; ++j)
      points.emplace_back(25.0 * i, 25.0 * j, size[2]);
  return points;
}

const std::vector<Vec3> inner_points{Vec3(50, 70, 240), Vec3(10, 60, 100), Vec3(200, 110, 200), Vec3(15, 180, 235)};

/// Derivative along axis @p c by central differences of the fourth order; the fields vary over 10 nm and more.
template <typename Field> auto derivative(const Field &field, const Vec3 &x, const int c)
{
  constexpr double h = 0.1;
  const Vec3 d = h * Vec3::Unit(c);
  using Value = decltype(field(x));
  return Value((8 * (field(x + d) - field(x - d)) - (field(x + 2 * d) - field(x - 2 * d))) / (12 * h));
}

class SurfaceImagesOfANetwork : public ::testing::TestWithParam<RayDirection>
{
protected:
  BoxShape shape{Vec3::Zero(), size};
  Network network = lines_of_all_kinds(shape);
  LineSystem lines{medium, network, &shape, GetParam(), nullptr, nullptr};
  SurfaceImages images{lines, planes, {80, 1e-8}};
};
} // namespace

TEST_P(SurfaceImagesOfANetwork, LeaveOnTheirFaceWhatTheySayTheyLeave)
{
  for (const Vec3 &x : points_on_top())
  {
    SymTensor total = lines.stress(x) + images.stress(x), expected = SymTensor::Zero();
    const auto add_line_of = [&](const std::size_t i)
    {
      const StraightLine &l = lines.lines()[i];
      if (!images.is_freed_of_line(i, 5))
        expected += segment_stress(medium, x, l.start, l.end, l.burgers);
    };
    for (std::size_t i = 0; i < lines.lines().size(); ++i)
      add_line_of(i);
    for (std::size_t i = 0; i < lines.rays().size(); ++i)
      if (const VirtualRay &r = lines.rays()[i]; !images.is_freed_of_ray(i, 5))
        expected += ray_stress(medium, x, r.origin, r.direction, r.burgers);
    for (const auto &leg : images.remaining_legs())
      if (leg.face_id == 5)
        expected += ray_stress(medium, x, leg.ray.origin, leg.ray.direction, leg.ray.burgers);
    for (const auto &[line, face] : images.fading_lines())
      if (face == 5)
        expected += segment_stress(medium, x, line.start, line.end, line.burgers);
    for (unsigned i = 0; i < images.n_images(); ++i)
      if (images.face_of_image(i) != 5)
        expected += images.stress(std::vector<unsigned>{i}, x);
    const Vec3 difference = contract(SymTensor(total - expected), Vec3::UnitZ());
    EXPECT_LT(difference.norm(), 1e-5 * contract(lines.stress(x), Vec3::UnitZ()).norm()) << x.transpose();
  }
}

TEST_P(SurfaceImagesOfANetwork, AreInEquilibriumInTheGrain)
{
  for (const Vec3 &x : inner_points)
  {
    Vec3 divergence = Vec3::Zero();
    for (int c = 0; c < 3; ++c)
      divergence += contract(derivative([&](const Vec3 &y) { return images.stress(y); }, x, c), Vec3::Unit(c));
    EXPECT_LT(divergence.norm(), 1e-6 * images.stress(x).norm()) << x.transpose(); // per nm
  }
}

TEST_P(SurfaceImagesOfANetwork, HaveTheStressOfTheirDisplacement)
{
  for (const Vec3 &x : inner_points)
  {
    Mat3 gradient;
    for (int c = 0; c < 3; ++c)
      gradient.col(c) = derivative([&](const Vec3 &y) { return images.displacement(std::vector<Vec3>{y})[0]; }, x, c);
    const Mat3 strain = 0.5 * (gradient + gradient.transpose());
    const double lambda = 2 * medium.mu * medium.nu / (1 - 2 * medium.nu);
    const SymTensor s = symmetric_part(2 * medium.mu * strain + lambda * strain.trace() * Mat3::Identity());
    EXPECT_LT((s - images.stress(x)).norm(), 1e-6 * s.norm()) << x.transpose();
  }
}

TEST_P(SurfaceImagesOfANetwork, AreTheSameBitsOnAnyNumberOfThreads)
{
  const auto points = points_on_top();
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const auto one = images.stress(points);
  const auto one_displacement = images.displacement(points);
  omp_set_num_threads(3);
  EXPECT_EQ(images.stress(points), one);
  EXPECT_EQ(images.displacement(points), one_displacement);
  omp_set_num_threads(threads);
}

// To rounding (tests/dd/elasticity/image_kernels_test.cc states the bound for each): 1e-12 of what is summed.
TEST_P(SurfaceImagesOfANetwork, AtManyPointsAreThoseAtEach)
{
  const auto points = points_on_top();
  const auto many = images.stress(points);
  std::vector<unsigned> all(images.n_images());
  std::iota(all.begin(), all.end(), 0U);
  std::vector<SymTensor> chosen(points.size(), SymTensor::Zero());
  images.add_stress(all, points, chosen);
  EXPECT_EQ(chosen, many);
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    double magnitude = 0;
    for (unsigned i = 0; i < images.n_images(); ++i)
      magnitude += images.stress(std::vector<unsigned>{i}, points[k]).norm();
    EXPECT_LT((many[k] - images.stress(points[k])).norm(), 1e-12 * magnitude);
  }
}

INSTANTIATE_TEST_SUITE_P(WithRays, SurfaceImagesOfANetwork,
                         ::testing::Values(RayDirection::normal, RayDirection::radial),
                         [](const auto &p) { return p.param == RayDirection::normal ? "AlongNormals" : "Radial"; });

TEST(SurfaceImages, OfNoDepthAreNone)
{
  const BoxShape shape(Vec3::Zero(), size);
  const Network network = lines_of_all_kinds(shape);
  const LineSystem lines(medium, network, &shape, RayDirection::normal, nullptr, nullptr);
  const SurfaceImages images(lines, planes, {0, 1e-8});
  EXPECT_TRUE(images.empty());
  EXPECT_EQ(images.stress(Vec3(10, 10, 10)), SymTensor::Zero());
}

TEST(SegmentPoints, AreDenserTowardsTheSurface)
{
  Network network;
  add_line(network, {Vec3(0, 0, 0), Vec3(0, 0, 30), Vec3(0, 0, 60)}, burgers, {}, false, NodeConstraint::surface);
  const SegmentPoints plain(network);
  EXPECT_EQ(plain.positions().size(), 6U);
  const SegmentPoints graded(network, [](const Vec3 &x) { return x[2] + 0.25; });
  EXPECT_EQ(graded.fractions(1).size(), 3U);
  EXPECT_GT(graded.fractions(0).size(), 12U);
  for (std::size_t i = 0; i < graded.n_segments(); ++i)
  {
    double sum = 0, first_moment = 0;
    for (std::size_t q = 0; q < graded.weights(i).size(); ++q)
    {
      sum += graded.weights(i)[q];
      first_moment += graded.weights(i)[q] * graded.fractions(i)[q];
    }
    EXPECT_NEAR(sum, 1, 1e-14);
    EXPECT_NEAR(first_moment, 0.5, 1e-14);
  }
  // 1/(z + 0.25) along the first segment, singular just outside.
  double integral = 0;
  for (std::size_t q = 0; q < graded.weights(0).size(); ++q)
    integral += graded.weights(0)[q] / (30 * graded.fractions(0)[q] + 0.25);
  EXPECT_NEAR(integral, std::log(30.25 / 0.25) / 30, 1e-3 * std::log(30.25 / 0.25) / 30);
}
} // namespace ddfem
