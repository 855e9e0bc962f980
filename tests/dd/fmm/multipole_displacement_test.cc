#include "dd/elasticity/vectorised/displacement_kernels.h"
#include "dd/fmm/multipole_displacement.h"
#include "tests/dd/elasticity/elasticity_test_helpers.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ddfem
{
namespace
{
using test::RandomVectors;

constexpr double nu = 0.31;

/// Triangles swept by segments of 20 nm in a cube of 1000 nm, thin ones by a small motion and a few wide ones.
std::vector<TriangularLoop> swept_triangles(const int n, RandomVectors &random)
{
  std::vector<TriangularLoop> loops;
  for (int k = 0; k < n; ++k)
  {
    const Vec3 p = 500 * random.vector(), q = p + 20 * random.vector().normalized(), b = 0.25 * random.vector();
    const Vec3 motion = (k % 10 == 0 ? 30 : 0.5) * random.vector();
    loops.emplace_back(LoopVertex{p}, LoopVertex{Vec3(p + motion)}, LoopVertex{q}, b);
  }
  return loops;
}

double rms(const std::vector<Vec3> &u)
{
  double sum = 0;
  for (const Vec3 &v : u)
    sum += v.squaredNorm();
  return std::sqrt(sum / static_cast<double>(u.size()));
}

std::vector<Vec3> difference(std::vector<Vec3> a, const std::vector<Vec3> &b)
{
  for (std::size_t i = 0; i < a.size(); ++i)
    a[i] -= b[i];
  return a;
}

TEST(MultipoleDisplacement, HasTheRequestedErrorOfTheFarDisplacement)
{
  RandomVectors random(3);
  const std::vector<TriangularLoop> loops = swept_triangles(3000, random);
  std::vector<Vec3> points;
  for (int k = 0; k < 3000; ++k)
    points.emplace_back(520 * random.vector());
  const std::vector<Vec3> direct = triangle_displacements(nu, loops, points);
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-6})
  {
    // A deeper tree than pays, so that most pairs are far.
    fmm::MultipoleDisplacement sum(nu, {tolerance, 0, 0.02}, loops, points);
    EXPECT_GE(sum.octree().levels().size(), 4U);
    const std::vector<Vec3> all = sum.displacement(MPI_COMM_SELF);
    const double error = rms(difference(all, direct)) / rms(sum.displacement(MPI_COMM_SELF, fmm::Part::far));
    EXPECT_LT(error, tolerance);
    EXPECT_GT(error, tolerance / 30) << "wasted work";
    RecordProperty("error at " + std::to_string(tolerance), std::to_string(error));
  }
}

TEST(MultipoleDisplacement, OfOneLoopFarAwayIsTheClosedForm)
{
  // Expansions only: a loop in one corner, points in the opposite one.
  const Vec3 p(3, 4, 5), q(13, 6, 7), r(6, 14, 9);
  const std::vector<TriangularLoop> loops{{LoopVertex{p}, LoopVertex{q}, LoopVertex{r}, Vec3(0.1, -0.2, 0.15)}};
  std::vector<Vec3> points;
  RandomVectors random(5);
  for (int k = 0; k < 200; ++k)
    points.emplace_back(Vec3(800, 850, 900) + 50 * random.vector());
  fmm::MultipoleDisplacement sum(nu, {1e-8, 0, 1e-6}, loops, points);
  const std::vector<Vec3> direct = triangle_displacements(nu, loops, points);
  const std::vector<Vec3> far = sum.displacement(MPI_COMM_SELF, fmm::Part::far);
  EXPECT_LT(rms(sum.displacement(MPI_COMM_SELF, fmm::Part::near)), 1e-15);
  EXPECT_LT(rms(difference(far, direct)), 1e-7 * rms(direct));
}
} // namespace
} // namespace ddfem
