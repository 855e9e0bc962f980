// The vectorised image fields against the scalar reference, for every instruction set of the machine.
#include "dd/elasticity/half_space_image.h"
#include "tests/dd/elasticity/elasticity_test_helpers.h"
#include "tests/dd/elasticity/kernel_targets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace ddfem
{
namespace
{
using ImageKernel = test::KernelTargets;
using test::copper_like;
using test::RandomVectors;

constexpr double tolerance = 1e-6;

struct Segment
{
  Vec3 start, end;
};

/// At a depth of a tenth to a hundred core radii, parallel to the surface, along its normal, with an end on it.
std::vector<Segment> segments()
{
  RandomVectors random(41);
  std::vector<Segment> result;
  const auto inside = [&](const Vec3 &x) { return Vec3(x[0], x[1], std::abs(x[2])); };
  for (const double scale : {0.1, 3.0, 100.0})
  {
    const Vec3 x = inside(scale * random.vector());
    result.push_back({x, inside(x + 10 * random.vector())});
    result.push_back({x, x + Vec3(7, -4, 0)});
    result.push_back({x + Vec3(0, 0, 8), x});
    result.push_back({Vec3(x[0], x[1], 0), x + Vec3(3, 2, 1)});
  }
  return result;
}

/// Near and far, on the surface, on it above the ends, and in the ends themselves.
std::vector<Vec3> points(const Segment &s)
{
  RandomVectors random(42);
  std::vector<Vec3> result;
  for (const double scale : {1.0, 20.0, 1e4})
    for (int k = 0; k < 9; ++k)
    {
      const Vec3 x = s.start + scale * random.vector();
      result.emplace_back(x[0], x[1], k % 3 == 0 ? 0.0 : std::abs(x[2]));
    }
  for (const Vec3 &x : {s.start, s.end, Vec3(0.5 * (s.start + s.end))})
  {
    result.push_back(x);
    result.emplace_back(x[0], x[1], 0.0);
  }
  return result;
}

/// What rounding may change in a field that varies like 1/D^n with D, the distance of the mirror image, at least a core radius.
/// Of it 1e-12 for the some hundred operations of each of up to a hundred points, among them the cancellation between
/// the third derivatives at points far from the surface; and the rounding of positions over D.
double rounding(const double scale, const Vec3 &x, const double distance)
{
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  return scale * (1e-12 + 16 * epsilon * x.norm() / distance);
}

template <class Image> void expect_same(const Image &image, const std::vector<Vec3> &at, const double b)
{
  StressBuffer buffer(at.size());
  std::vector<double> coordinates(3 * at.size()), u(3 * at.size(), 0.0);
  for (std::size_t i = 0; i < at.size(); ++i)
  {
    buffer.set_point(i, at[i]);
    for (std::size_t c = 0; c < 3; ++c)
      coordinates[c * at.size() + i] = at[i][static_cast<Eigen::Index>(c)];
  }
  const double *const x = coordinates.data();
  image.add_stress(buffer.batch());
  image.add_displacement(
      {at.size(), {x, x + at.size(), x + 2 * at.size()}, {u.data(), u.data() + at.size(), u.data() + 2 * at.size()}});
  const IsotropicMedium &m = copper_like;
  for (std::size_t i = 0; i < at.size(); ++i)
  {
    const double d = std::hypot(image.distance(at[i]), m.a);
    const double stress_scale = m.mu * b / (std::numbers::pi * (1 - m.nu) * d);
    EXPECT_LT((buffer.stress(i) - image.stress(at[i])).norm(), rounding(stress_scale, at[i], d)) << at[i].transpose();
    const Vec3 of_batch(u[i], u[at.size() + i], u[2 * at.size() + i]);
    EXPECT_LT((of_batch - image.displacement(at[i])).norm(), 10 * rounding(b, at[i], d)) << at[i].transpose();
  }
}
} // namespace

TEST_P(ImageKernel, OfASegmentIsTheReferenceToRounding)
{
  RandomVectors random(43);
  for (const Segment &s : segments())
  {
    const Vec3 b = 0.3 * random.vector();
    expect_same(SegmentImage(copper_like, s.start, s.end, b, tolerance), points(s), b.norm());
  }
}

TEST_P(ImageKernel, OfALegIsTheReferenceToRounding)
{
  RandomVectors random(44);
  for (const Segment &s : segments())
  {
    const Vec3 b = 0.3 * random.vector();
    expect_same(LegImage(copper_like, s.start, b), points(s), b.norm());
  }
}

TEST_P(ImageKernel, OfAPiercingLineIsTheReferenceToRounding)
{
  RandomVectors random(45);
  for (const Segment &s : segments())
  {
    const Vec3 b = 0.3 * random.vector();
    expect_same(PiercingImage(copper_like, Vec3(s.start[0], s.start[1], 0), b), points(s), b.norm());
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, ImageKernel, testing::ValuesIn(kernel_targets()), test::name_of_target);
} // namespace ddfem
