// The vectorised evaluation of stresses against the one point by point, for every instruction set of the machine.
#include "dd/elasticity/distance.h"
#include "dd/elasticity/segment_stress.h"
#include "dd/elasticity/vectorised/stress_kernels.h"
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
using StressKernel = test::KernelTargets;

const Vec3 b(0.1, 0.2, -0.3);

/// What rounding may change in the stress at @p x: a relative error of the formula itself, and the error of the distance
/// from the line, a few times the spacing of numbers of the size of x - @p first, times a bound of the stress gradient,
/// mu b/(pi (1-nu) (d^2 + a^2)).
double rounding(const SymTensor &stress, const Vec3 &x, const Vec3 &first, const Vec3 &direction)
{
  const IsotropicMedium &m = test::copper_like;
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const double distance2 = (x - first).cross(direction).squaredNorm();
  const double gradient = m.mu * b.norm() / (std::numbers::pi * (1 - m.nu) * (distance2 + m.a * m.a));
  return 1e-13 * stress.lpNorm<Eigen::Infinity>() + 4 * epsilon * (x - first).norm() * gradient;
}

/// Points near, far, beside and ahead of a line; on it for scale zero.
std::vector<Vec3> points_around(const Vec3 &first, const Vec3 &direction)
{
  test::RandomVectors random(11);
  std::vector<Vec3> points;
  for (const double scale : {0.0, 1e-3, 1.0, 30.0, 1e5})
    for (int k = 0; k < 23; ++k) // not a multiple of any vector's width
      points.push_back(first + 40 * random.number() * direction + scale * random.vector());
  return points;
}

/// Largest difference of what @p add(batch) adds from field(x), over rounding().
template <typename Field, typename Add>
double error_of_batch(const Field &field, const Vec3 &first, const Vec3 &direction, Add &&add)
{
  const std::vector<Vec3> points = points_around(first, direction);
  StressBuffer buffer(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    buffer.set_point(i, points[i]);
  add(buffer.batch());
  add(buffer.batch()); // adds: twice the stress
  double error = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const SymTensor exact = field(points[i]);
    error = std::max(error, (0.5 * buffer.value(i) - exact).lpNorm<Eigen::Infinity>() /
                                rounding(exact, points[i], first, direction));
  }
  return error;
}
} // namespace

// Both are the same formula; products and sums may be contracted.
TEST_P(StressKernel, OfASegmentIsThatOfItsPoints)
{
  const Vec3 x1(1, -2, 3), x2(11, 20, -17);
  LineTable segment;
  segment.add_segment(x1, x2, b);
  EXPECT_LT(error_of_batch(SegmentStressField(test::copper_like, x1, x2, b), x1, (x2 - x1).normalized(),
                           [&](const StressBatch &batch) { add_segment_stress(test::copper_like, segment, batch); }),
            1);
}

TEST_P(StressKernel, OfARayIsThatOfItsPoints)
{
  const Vec3 origin(1, -2, 3), direction = Vec3(1, 2, -2) / 3;
  LineTable ray;
  ray.add_ray(origin, direction, b);
  EXPECT_LT(error_of_batch(RayStressField(test::copper_like, origin, direction, b), origin, direction,
                           [&](const StressBatch &batch) { add_ray_stress(test::copper_like, ray, batch); }),
            1);
}

TEST_P(StressKernel, OfChosenLinesIsTheSumOfTheirFields)
{
  test::RandomVectors random(12);
  LineTable segments, rays;
  std::vector<SegmentStressField> segment_fields;
  std::vector<RayStressField> ray_fields;
  for (int k = 0; k < 13; ++k)
  {
    const Vec3 x1 = 10 * random.vector(), x2 = x1 + random.vector(), t = random.vector().normalized();
    segments.add_segment(x1, x2, b);
    segment_fields.emplace_back(test::copper_like, x1, x2, b);
    rays.add_ray(x1, t, b);
    ray_fields.emplace_back(test::copper_like, x1, t, b);
  }
  StressBuffer buffer(3);
  const Vec3 points[] = {{1, 2, 3}, {-4, 5, 0}, {30, 0, 10}};
  for (std::size_t i = 0; i < 3; ++i)
    buffer.set_point(i, points[i]);
  const std::vector<unsigned> which{12, 0, 7, 7, 9};
  add_segment_stress(test::copper_like, segments, which, buffer.batch());
  add_ray_stress(test::copper_like, rays, which, buffer.batch());
  add_segment_stress(test::copper_like, segments, buffer.batch());
  add_ray_stress(test::copper_like, rays, buffer.batch());
  for (std::size_t i = 0; i < 3; ++i)
  {
    SymTensor sum = SymTensor::Zero();
    double scale = 0;
    const auto add = [&](const SymTensor &s)
    {
      sum += s;
      scale += s.norm();
    };
    for (const unsigned k : which)
    {
      add(segment_fields[k](points[i]));
      add(ray_fields[k](points[i]));
    }
    for (std::size_t k = 0; k < segment_fields.size(); ++k)
    {
      add(segment_fields[k](points[i]));
      add(ray_fields[k](points[i]));
    }
    EXPECT_LT((buffer.value(i) - sum).norm(), 1e-13 * scale);
  }
}

// The short form at points from half a length on, in both precisions. Bound of a stress: the integrand, mu b/(2 pi (1-nu) R^2), times
// the length, R >= d. Rounding: of some 50 operations, and of coordinates, which are relative to the box in single precision.
TEST_P(StressKernel, OfDistantSegmentsIsTheReferenceToItsPrecision)
{
  const IsotropicMedium &m = test::copper_like;
  test::RandomVectors random(5);
  constexpr double unit = 200, length = 30;
  const Vec3 box(1e6, -2e5, 3e5); // far from the origin: what coordinates relative to the box are for
  for (int k = 0; k < 200; ++k)
  {
    const Vec3 middle = box + unit * random.vector(), half = 0.5 * length * random.vector().normalized();
    LineTable table;
    for (int i = 0; i < 11; ++i) // others in the block
      table.add_segment(box, box + random.vector(), b);
    table.add_segment(middle - half, middle + half, b);
    const std::vector<unsigned> which{11};
    const Vec3 points[] = {middle + half.unitOrthogonal() * 0.5 * length, middle + 2 * half,
                           middle + unit * random.vector()};
    StressBuffer in_double(3), in_single(3);
    for (std::size_t i = 0; i < 3; ++i)
    {
      in_double.set_point(i, points[i]);
      in_single.set_point(i, points[i]);
    }
    add_distant_segment_stress(m, table, which, in_double.batch());
    add_single_precision_stress(m, table, which, box, unit, in_single.batch());
    for (std::size_t i = 0; i < 3; ++i)
    {
      const double d = std::sqrt(distance_point_segment(points[i], middle - half, middle + half).squared);
      if (d < 0.49 * length)
        continue;
      const SymTensor exact = segment_stress(m, points[i], middle - half, middle + half, b);
      const double bound = m.mu * b.norm() * length / (2 * std::numbers::pi * (1 - m.nu) * d * d);
      EXPECT_LT((in_double.value(i) - exact).norm(), (1e-14 + 1e-15 * box.norm() / d) * bound);
      EXPECT_LT((in_single.value(i) - exact).norm(), 5e-7 * (1 + unit / d) * bound);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, StressKernel, testing::ValuesIn(kernel_targets()), test::name_of_target);
} // namespace ddfem
