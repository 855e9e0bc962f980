// Random networks moved at random with every operation: all invariants hold after each step.
#include "tests/dd/topology/random_networks.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <array>
#include <cstdint>
#include <string>

namespace ddfem
{
namespace
{
class RandomNetworkIn : public testing::TestWithParam<Body>
{
};

TEST_P(RandomNetworkIn, KeepsAllInvariantsInEveryStep)
{
  RandomNetwork f(1000, 3e-4, GetParam());
  for (std::uint64_t k = 0; k < 200; ++k)
  {
    ASSERT_NO_THROW(f.step(k)) << "step " << k;
    ASSERT_EQ(f.report.exhausted, 0U);
  }
  EXPECT_GT(f.counts.collisions, 1000U);
  EXPECT_GT(f.counts.annihilations, 300U);
  EXPECT_GT(f.counts.splits, 100U);
  EXPECT_GT(f.counts.refinements, 1000U);
  EXPECT_GT(f.counts.coarsenings, 1000U);
  EXPECT_EQ(f.counts.surface_exits > 500, GetParam() != Body::periodic);
}

TEST_P(RandomNetworkIn, IndependentEventsHandledTogetherGiveTheSequentialOutcomeToTheLastBit)
{
  RandomNetwork f(2000, 3e-4, GetParam());
  f.splitting = false;
  std::size_t events = 0, rounds = 0, sequential_rounds = 0;
  for (std::uint64_t k = 0; k < 70; ++k)
  {
    if (k < 40)
    {
      f.step(k);
      continue;
    }
    RandomNetwork other = f.copy();
    other.collision_settings.concurrent = false;
    f.step(k);
    other.step(k);
    events += f.report.handled;
    rounds += f.report.rounds;
    sequential_rounds += other.report.rounds;
    ASSERT_EQ(f.report.handled, other.report.handled) << "step " << k;
    ASSERT_TRUE(picture_of(f.network) == picture_of(other.network)) << "step " << k;
  }
  EXPECT_GT(events, 1000U);
  EXPECT_LT(rounds, sequential_rounds); // some of them at the same time
}

TEST_P(RandomNetworkIn, DoesNotDependOnTheNumberOfThreads)
{
  const int threads = omp_get_max_threads();
  std::array<std::uint64_t, 2> checksums{};
  for (const int n : {1, 2})
  {
    omp_set_num_threads(n);
    RandomNetwork f(1000, 3e-4, GetParam());
    for (std::uint64_t k = 0; k < 60; ++k)
      f.step(k);
    checksums[static_cast<std::size_t>(n - 1)] = f.network.checksum();
  }
  omp_set_num_threads(threads);
  EXPECT_EQ(checksums[0], checksums[1]);
}

std::string body_name(const testing::TestParamInfo<Body> &parameter)
{
  switch (parameter.param)
  {
    case Body::periodic: return "PeriodicCell";
    case Body::box: return "Box";
    case Body::cylinder: break;
  }
  return "Cylinder";
}

INSTANTIATE_TEST_SUITE_P(Bodies, RandomNetworkIn, testing::Values(Body::periodic, Body::box, Body::cylinder),
                         body_name);
} // namespace
} // namespace ddfem
