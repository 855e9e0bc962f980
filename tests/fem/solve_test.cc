// How the linear system is solved: preconditioners, starting vectors, superposition.
#include "support.h"

#include <gtest/gtest.h>

namespace ddfem::fem::test
{
TEST(Elasticity, WarmStartsSaveIterationsAndRestartsRepeatBits)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({200., 200., 400.}, {3, 3, 6}));
  const std::vector<DisplacementCondition> conditions = {{4, {false, false, true}}, {5, {false, false, true}}};
  const auto load = [](ElasticProblem &problem, double time)
  {
    problem.set_tractions(field_of(PointForce{Point(100. + time, 260., 150.), Vector({3e4, -2e4, 1e4}), copper}));
    return problem.solve(prescribe(problem, [](const Point &) { return Vector(); }));
  };
  ElasticProblem first(*mesh, {}, copper, conditions);
  const auto cold = load(first, 0.);
  // The load varies over 60 nm, the distance of the force: a polynomial of degree k through k + 1 solutions that are 0.5 nm
  // apart errs by about (0.5/60)^(k+1). With k = 1 that is 1e-4, with k = 3 it is 5e-9, below the tolerance.
  load(first, 0.5);
  const auto second_start = load(first, 1.);
  EXPECT_LT(second_start.iterations, cold.iterations - 3);
  EXPECT_LT(second_start.initial_residual, 1e-3);
  load(first, 1.5);
  load(first, 2.);
  const auto kept = first.start_vectors();
  EXPECT_EQ(kept.size(), 10u); // and their products with the stiffness
  const auto warm = load(first, 2.5);
  EXPECT_LE(warm.iterations, 2u);
  EXPECT_LT(warm.initial_residual, 1e-6);
  ElasticProblem second(*mesh, {}, copper, conditions);
  second.set_start_vectors(kept);
  load(second, 2.5);
  EXPECT_EQ(first.solution(), second.solution());
}

TEST(Elasticity, KeptFactorisationAndMultigridSolveTheSameProblem)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({200., 200., 400.}, {3, 3, 6}));
  const PointForce outside{Point(100., 260., 150.), Vector({3e4, -2e4, 1e4}), copper};
  for (const bool held : {true, false})
  {
    std::vector<DisplacementCondition> conditions;
    if (held)
    {
      conditions = {{4, {true, true, true}}, {5, {true, true, true}}};
    }
    std::vector<std::vector<double>> solutions;
    for (const Solver solver : {Solver::multigrid, Solver::direct})
    {
      auto parameters = accurate(2);
      parameters.relative_tolerance = 1e-11;
      parameters.solver = solver;
      ElasticProblem problem(*mesh, parameters, copper, conditions);
      problem.set_tractions(field_of(outside));
      const auto info = problem.solve(prescribe(problem, [](const Point &) { return Vector(); }));
      if (solver == Solver::direct)
      {
        // Exact inverse: one iteration, and one more for rounding; the shift of a free grain by 1e-7 costs another.
        EXPECT_LE(info.iterations, held ? 2u : 3u);
      }
      solutions.push_back(problem.solution());
    }
    std::array<double, 2> sums{};
    for (std::size_t i = 0; i < solutions[0].size(); ++i)
    {
      sums[0] += std::pow(solutions[0][i] - solutions[1][i], 2);
      sums[1] += std::pow(solutions[1][i], 2);
    }
    MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    // Residual of 1e-11 times a condition number of some hundred in the long bar.
    EXPECT_LT(std::sqrt(sums[0] / sums[1]), 1e-8) << held;
    EXPECT_GT(sums[1], 0.);
  }
}

TEST(Elasticity, SolutionsCanBeSuperposed)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({200., 200., 400.}, {2, 2, 4}));
  ElasticProblem problem(*mesh, accurate(2), copper, {{4, {true, true, true}}, {5, {true, true, true}}});
  const auto pull = [](const Point &x) { return Vector({0., 0., 1e-3 * x[2]}); };
  problem.solve(prescribe(problem, pull));
  const double force = problem.reaction(5)[2];
  auto values = problem.solution();
  for (double &value : values)
  {
    value *= -2.;
  }
  problem.set_solution(values);
  EXPECT_NEAR(problem.reaction(5)[2] / force, -2., 1e-12);
  EXPECT_NEAR(problem.displacement_at({Point(100., 100., 400.)})[0][2], -0.8, 1e-9);
}
} // namespace ddfem::fem::test
