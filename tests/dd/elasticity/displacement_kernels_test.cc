// The vectorised displacement of loops against the scalar reference, for every instruction set of the machine.
#include "dd/elasticity/triangle_displacement.h"
#include "dd/elasticity/vectorised/displacement_kernels.h"
#include "tests/dd/elasticity/elasticity_test_helpers.h"
#include "tests/dd/elasticity/kernel_targets.h"

#include <gtest/gtest.h>

#include <vector>

namespace ddfem
{
namespace
{
using DisplacementKernel = test::KernelTargets;
using test::RandomVectors;

constexpr double nu = 0.3;

struct Loop
{
  LoopVertex v[3];
  Vec3 burgers;

  TriangularLoop prepared() const { return {v[0], v[1], v[2], burgers}; }
  Vec3 displacement(const Vec3 &x) const { return triangle_displacement(nu, x, v[0], v[1], v[2], burgers); }
};

/// Triangles, half-strips and sectors in every order of their vertices, a flat triangle and one with an edge of length
/// zero.
std::vector<Loop> loops()
{
  RandomVectors random(31);
  std::vector<Loop> result;
  for (int k = 0; k < 5; ++k)
  {
    const LoopVertex a = LoopVertex::at(random.vector()), b = LoopVertex::at(random.vector()),
                     c = LoopVertex::at(random.vector()), d = LoopVertex::towards(random.vector().normalized()),
                     e = LoopVertex::towards(random.vector().normalized());
    for (const auto &[p, q, r] : {std::array{a, b, c}, std::array{a, b, d}, std::array{d, a, b}, std::array{b, d, a},
                                  std::array{a, d, e}, std::array{d, e, a}})
      result.push_back({{p, q, r}, random.vector()});
    result.push_back({{a, b, LoopVertex::at(0.3 * a.value + 0.7 * b.value)}, random.vector()});
    result.push_back({{a, a, c}, random.vector()});
  }
  return result;
}

/// Near and far, in the plane, on the extension of an edge. On an edge and in a vertex the field is singular.
std::vector<Vec3> points(const std::vector<Loop> &all)
{
  RandomVectors random(32);
  std::vector<Vec3> result;
  for (const double scale : {1.0, 30.0, 1e4})
    for (int k = 0; k < 7; ++k)
      result.push_back(scale * random.vector());
  const auto &v = all.front().v;
  result.push_back(v[0].value + 1.7 * (v[1].value - v[0].value));
  result.push_back(v[2].value - 0.4 * (v[1].value - v[2].value));
  result.push_back(v[0].value + 0.3 * (v[1].value - v[0].value) + 1e-3 * random.vector());
  return result;
}

/// What rounding may change: the terms are products of b with an angle or a logarithm of at most some tens, each to a few
/// units in the last place of it; relative positions add epsilon |x| over the distance from the loop, a thousand at most.
constexpr double rounding = 1e-12;
} // namespace

TEST_P(DisplacementKernel, OfALoopIsTheReferenceToRounding)
{
  const std::vector<Loop> all = loops();
  const std::vector<Vec3> at = points(all);
  for (std::size_t k = 0; k < all.size(); ++k)
  {
    const TriangularLoop loop = all[k].prepared();
    const std::vector<Vec3> u = triangle_displacements(nu, {&loop, 1}, at);
    for (std::size_t i = 0; i < at.size(); ++i)
      EXPECT_LT((u[i] - all[k].displacement(at[i])).norm(), rounding * all[k].burgers.norm())
          << "loop " << k << ", point " << i;
  }
}

TEST_P(DisplacementKernel, OfManyIsTheSum)
{
  const std::vector<Loop> all = loops();
  const std::vector<Vec3> at = points(all);
  std::vector<TriangularLoop> prepared;
  for (const Loop &l : all)
    prepared.push_back(l.prepared());
  const std::vector<Vec3> u = triangle_displacements(nu, prepared, at);
  for (std::size_t i = 0; i < at.size(); ++i)
  {
    Vec3 sum = Vec3::Zero();
    for (const Loop &l : all)
      sum += l.displacement(at[i]);
    EXPECT_LT((u[i] - sum).norm(), rounding * static_cast<double>(all.size())) << "point " << i;
  }
}

// Infinite logarithms must not appear where the scalar reference cuts them off.
TEST_P(DisplacementKernel, IsFiniteOnEdgesAndInVertices)
{
  const std::vector<Loop> all = loops();
  for (const Loop &l : all)
  {
    std::vector<Vec3> at;
    for (std::size_t k = 0; k < 3; ++k)
      if (!l.v[k].at_infinity)
        at.push_back(l.v[k].value);
    if (at.size() > 1)
      at.push_back(0.5 * (at[0] + at[1]));
    const TriangularLoop loop = l.prepared();
    for (const Vec3 &u : triangle_displacements(nu, {&loop, 1}, at))
      EXPECT_TRUE(u.allFinite());
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, DisplacementKernel, testing::ValuesIn(kernel_targets()), test::name_of_target);
} // namespace ddfem
