// Costs of leaves by what they took.
#include "dd/fmm/work_costs.h"

#include <gtest/gtest.h>

namespace ddfem::fmm
{
namespace
{
/// An evaluation of leaves whose kinds of work cost @p each, s.
void evaluate(WorkCosts &costs, const UnitCosts &each)
{
  double translations = 0;
  for (int k = 0; k < 10; ++k)
    translations += 3.0 * k;
  costs.begin_evaluation(translations, each.translation * translations);
  for (int k = 0; k < 10; ++k)
  {
    const LeafWork work{3.0 * k, 10.0 + k, 1000.0 + 37 * ((7 * k) % 10)};
    costs.add_leaf(work, each.point * work.points + each.pair * work.pairs);
  }
}

void expect_equal(const UnitCosts &a, const UnitCosts &b, const double tolerance)
{
  EXPECT_NEAR(a.translation, b.translation, tolerance * b.translation);
  EXPECT_NEAR(a.point, b.point, tolerance * b.point);
  EXPECT_NEAR(a.pair, b.pair, tolerance * b.pair);
}

TEST(WorkCosts, OfEachKindAreFound)
{
  WorkCosts costs;
  const UnitCosts each{1e-6, 2e-6, 4e-9};
  evaluate(costs, each);
  expect_equal(costs.unit_costs(MPI_COMM_SELF), each, 1e-9);
}

TEST(WorkCosts, FollowAChange)
{
  WorkCosts costs;
  const UnitCosts before{1e-6, 2e-6, 4e-9}, after{1e-6, 1e-6, 8e-9};
  evaluate(costs, before);
  for (int k = 0; k < 30; ++k)
    evaluate(costs, after);
  expect_equal(costs.unit_costs(MPI_COMM_SELF), after, 1e-2);
}

TEST(WorkCosts, OfTranslationsAreThoseOfAMeanEvaluation)
{
  WorkCosts costs;
  const UnitCosts each{1e-6, 2e-6, 4e-9}, kept{0, 2e-6, 4e-9};
  for (int k = 0; k < 60; ++k)
    evaluate(costs, k % 2 == 0 ? each : kept);
  EXPECT_NEAR(costs.unit_costs(MPI_COMM_SELF).translation, 0.5e-6, 0.1e-6);
}

TEST(WorkCosts, AreNeverNegative)
{
  WorkCosts costs;
  costs.begin_evaluation(10, 1e-3);
  costs.add_leaf({1, 10, 1000}, 1e-3);
  costs.add_leaf({1, 10, 2000}, 0.5e-3); // pairs that save time
  const UnitCosts each = costs.unit_costs(MPI_COMM_SELF);
  EXPECT_GT(each.point, 0);
  EXPECT_GE(each.pair, 0);
  EXPECT_GT(each.of({1, 10, 1000}), 0);
}
} // namespace
} // namespace ddfem::fmm
