// The vectorised nodal forces of pairs against the scalar reference, for every instruction set of the machine.
#include "dd/elasticity/distance.h"
#include "dd/elasticity/gauss.h"
#include "dd/elasticity/segment_force.h"
#include "dd/elasticity/segment_stress.h"
#include "dd/elasticity/vectorised/force_kernels.h"
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
using ForceKernel = test::KernelTargets;
using test::copper_like;
using test::RandomVectors;

constexpr double tolerance = 1e-5;

struct Pair
{
  const char *kind;
  Vec3 x1, x2, x3, x4;
};

/// Pairs of segments 1 to 30 long, of which every kind is hard in its own way.
std::vector<Pair> hard_pairs()
{
  RandomVectors random(21);
  std::vector<Pair> pairs;
  for (int k = 0; k < 20; ++k)
  {
    const Vec3 x1 = 20 * random.vector(), r = 15 * random.vector(), x2 = x1 + r, x3 = 20 * random.vector();
    const Vec3 across = r.cross(random.vector()).normalized();
    pairs.push_back({"random", x1, x2, x3, x3 + 15 * random.vector()});
    pairs.push_back({"far", x1, x2, x3 + Vec3(2000, 500, 0), x3 + Vec3(2003, 490, 5)});
    pairs.push_back({"parallel", x1, x2, x1 + 2 * across, x2 + 2 * across});
    pairs.push_back({"antiparallel", x1, x2, x2 + 3 * across, x1 + 3 * across + 0.2 * r});
    for (const double angle : {1e-2, 1e-5, 1e-8, 1e-11})
      pairs.push_back({"nearly parallel", x1, x2, x1 + across, x2 + across + angle * r.norm() * random.vector()});
    pairs.push_back({"connected", x1, x2, x2, x2 + 15 * random.vector()});
    pairs.push_back({"connected at the starts", x1, x2, x1, x1 + 15 * random.vector()});
    pairs.push_back({"touching in the middle", x1, x2, x1 + 0.4 * r, x1 + 0.4 * r + 15 * random.vector()});
    pairs.push_back({"collinear", x1, x2, x2 + 0.1 * r, x2 + r});
    pairs.push_back({"collinear and connected", x1, x2, x2, x2 + 0.5 * r});
    pairs.push_back({"overlapping", x1, x2, x1 + 0.3 * r, x1 + 1.3 * r});
    pairs.push_back({"at a core radius", x1, x2, x1 + 0.5 * r + 0.3 * across, x1 + 15 * random.vector()});
    pairs.push_back({"crossing", x1, x2, x1 + 0.5 * r - 5 * across, x1 + 0.5 * r + 5 * across + 0.1 * random.vector()});
  }
  return pairs;
}

/// What rounding may change in the force of a pair. A bound of the integrand, sigma b with sigma = mu b/(2 pi (1-nu) D),
/// D^2 = d^2 + a^2, d the distance of the segments, times the length: relative to it 64 epsilon by the some hundred
/// operations of the formula, and the rounding of positions, a few epsilon times the largest coordinate, over D.
double rounding(const Pair &p, const Vec3 &b12, const Vec3 &b34)
{
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const IsotropicMedium &m = copper_like;
  const double distance = std::sqrt(distance_segment_segment(p.x1, p.x2, p.x3, p.x4).squared + m.a * m.a);
  const double force =
      m.mu * b12.norm() * b34.norm() / (2 * std::numbers::pi * (1 - m.nu) * distance) * (p.x4 - p.x3).norm();
  double largest = 0;
  for (const Vec3 &x : {p.x1, p.x2, p.x3, p.x4})
    largest = std::max(largest, x.lpNorm<Eigen::Infinity>());
  return force * epsilon * (64 + 4 * largest / distance);
}

double difference(const SegmentForces &f, const SegmentForces &g)
{
  return std::max((f.start - g.start).lpNorm<Eigen::Infinity>(), (f.end - g.end).lpNorm<Eigen::Infinity>());
}
} // namespace

TEST_P(ForceKernel, OfAPairIsTheReferenceToRounding)
{
  RandomVectors random(22);
  for (const Pair &p : hard_pairs())
  {
    const Vec3 b12 = 0.3 * random.vector(), b34 = 0.3 * random.vector();
    LineTable table;
    table.add_segment(p.x1, p.x2, b12);
    const SegmentForces f = force_of_segments(copper_like, table, p.x3, p.x4, b34, tolerance);
    const SegmentForces expected = segment_force(copper_like, p.x1, p.x2, b12, p.x3, p.x4, b34, tolerance);
    EXPECT_LT(difference(f, expected), rounding(p, b12, b34)) << p.kind;
  }
}

TEST_P(ForceKernel, OfARayIsTheReferenceToRounding)
{
  RandomVectors random(23);
  for (const Pair &p : hard_pairs())
  {
    const Vec3 b12 = 0.3 * random.vector(), b34 = 0.3 * random.vector(), t = (p.x2 - p.x1).normalized();
    LineTable table;
    table.add_ray(p.x1, t, b12);
    const SegmentForces f = force_of_rays(copper_like, table, p.x3, p.x4, b34, tolerance);
    const SegmentForces expected = segment_force_from_ray(copper_like, p.x1, t, b12, p.x3, p.x4, b34, tolerance);
    const Pair ray{p.kind, p.x1, p.x1 + 5000 * t, p.x3, p.x4};
    EXPECT_LT(difference(f, expected), rounding(ray, b12, b34)) << p.kind;
  }
}

// Lanes with different numbers of points, near lines among far ones, a last block that is not full, a line left out.
TEST_P(ForceKernel, OfManyIsTheSumOfAllButTheOneLeftOut)
{
  RandomVectors random(24);
  const std::vector<Pair> pairs = hard_pairs();
  LineTable segments, rays;
  std::vector<Vec3> burgers;
  for (const Pair &p : pairs)
  {
    burgers.push_back(0.3 * random.vector());
    segments.add_segment(p.x1, p.x2, burgers.back());
    segments.add_segment(p.x3, p.x4, burgers.back());
    rays.add_ray(p.x1, (p.x2 - p.x1).normalized(), burgers.back());
  }
  for (const std::size_t without : {std::size_t{0}, std::size_t{101}, segments.size() - 1, no_line})
  {
    const Pair &target = pairs[without == no_line ? 7 : without / 2];
    const Vec3 &x3 = without % 2 == 0 ? target.x1 : target.x3, &x4 = without % 2 == 0 ? target.x2 : target.x4;
    const Vec3 b34(0.1, -0.2, 0.3);
    SegmentForces sum, sum_of_rays;
    double bound = 0, bound_of_rays = 0;
    for (std::size_t k = 0; k < pairs.size(); ++k)
    {
      const auto add = [&](std::size_t number, const Vec3 &x1, const Vec3 &x2)
      {
        if (number == without)
          return;
        const SegmentForces f = segment_force(copper_like, x1, x2, burgers[k], x3, x4, b34, tolerance);
        sum.start += f.start;
        sum.end += f.end;
        bound += rounding({"", x1, x2, x3, x4}, burgers[k], b34);
      };
      add(2 * k, pairs[k].x1, pairs[k].x2);
      add(2 * k + 1, pairs[k].x3, pairs[k].x4);
      const Vec3 t = (pairs[k].x2 - pairs[k].x1).normalized();
      const SegmentForces f = segment_force_from_ray(copper_like, pairs[k].x1, t, burgers[k], x3, x4, b34, tolerance);
      sum_of_rays.start += f.start;
      sum_of_rays.end += f.end;
      bound_of_rays += rounding({"", pairs[k].x1, pairs[k].x1 + 5000 * t, x3, x4}, burgers[k], b34);
    }
    EXPECT_LT(difference(force_of_segments(copper_like, segments, x3, x4, b34, tolerance, without), sum), bound);
    EXPECT_LT(difference(force_of_rays(copper_like, rays, x3, x4, b34, tolerance), sum_of_rays), bound_of_rays);
  }
}

TEST_P(ForceKernel, ByARuleIsThatOfTheStressAtItsPoints)
{
  RandomVectors random(23);
  const Vec3 x3(1, 2, 3), x4(14, -5, 9), b(0.1, -0.2, 0.15);
  LineTable table;
  std::vector<SegmentStressField> fields;
  for (int k = 0; k < 77; ++k) // more than are planned together, and not a multiple of a block
  {
    const Vec3 x1 = 20 * random.vector(), x2 = x1 + 10 * random.vector(), b12 = random.vector();
    table.add_segment(x1, x2, b12);
    fields.emplace_back(copper_like, x1, x2, b12);
  }
  for (const int n : {1, 2, 3})
  {
    SegmentForces sum{Vec3::Zero(), Vec3::Zero()};
    double scale = 0;
    const GaussRule rule = gauss_rule(n);
    for (std::size_t q = 0; q < rule.points.size(); ++q)
      for (const SegmentStressField &stress : fields)
      {
        const double s = rule.points[q];
        const Vec3 f = rule.weights[q] * contract(stress(x3 + s * (x4 - x3)), b).cross(x4 - x3);
        sum.start += (1 - s) * f;
        sum.end += s * f;
        scale += f.norm();
      }
    const SegmentForces f = force_of_segments_by_rule(copper_like, table, x3, x4, b, n);
    EXPECT_LT((f.start - sum.start).norm(), 1e-13 * scale) << n;
    EXPECT_LT((f.end - sum.end).norm(), 1e-13 * scale) << n;
  }
}

TEST_P(ForceKernel, OfSegmentsOfLengthZeroVanishes)
{
  LineTable table;
  const Vec3 x(1, 2, 3), b(0.1, 0.2, 0.3);
  table.add_segment(x, x, b);
  const SegmentForces on_other = force_of_segments(copper_like, table, x, Vec3(4, 4, 4), b, tolerance);
  EXPECT_EQ(on_other.start, Vec3(Vec3::Zero()));
  EXPECT_EQ(on_other.end, Vec3(Vec3::Zero()));
  table.add_segment(x, Vec3(4, 4, 4), b);
  EXPECT_EQ(force_of_segments(copper_like, table, x, x, b, tolerance).end, Vec3(Vec3::Zero()));
}

INSTANTIATE_TEST_SUITE_P(Kernels, ForceKernel, testing::ValuesIn(kernel_targets()), test::name_of_target);
} // namespace ddfem
