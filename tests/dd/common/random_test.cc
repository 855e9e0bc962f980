#include "dd/common/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace ddfem
{
namespace
{
using Counter = std::array<std::uint32_t, 4>;

// Known answers published with the paper (Random123, file kat_vectors, philox4x32 10).
TEST(Philox, GivesThePublishedAnswers)
{
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (Counter{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (Counter{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Counter{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(CounterRandom, EveryPartOfTheCounterAndOfTheSeedMatters)
{
  constexpr auto purpose = RandomPurpose::thermal_force;
  const double base = CounterRandom(1, 2, 3, purpose).uniform();
  EXPECT_EQ(base, CounterRandom(1, 2, 3, purpose).uniform());
  constexpr std::uint64_t high = std::uint64_t{1} << 32;
  for (const double other :
       {CounterRandom(2, 2, 3, purpose).uniform(), CounterRandom(1 + high, 2, 3, purpose).uniform(),
        CounterRandom(1, 3, 3, purpose).uniform(), CounterRandom(1, 2 + high, 3, purpose).uniform(),
        CounterRandom(1, 2, 4, purpose).uniform(), CounterRandom(1, 2, 3 + high, purpose).uniform(),
        CounterRandom(1, 2, 3, RandomPurpose::cross_slip).uniform(), CounterRandom(1, 2, 3, purpose).uniform(1),
        CounterRandom(1, 2, 3, purpose).uniform_pair()[1]})
    EXPECT_NE(base, other);
}

/// Mean of f over numbers of neighbouring ids, steps and draws.
template <class F> double mean(const F &f)
{
  double sum = 0;
  for (unsigned id = 0; id < 100; ++id)
    for (unsigned step = 0; step < 100; ++step)
      for (unsigned draw = 0; draw < 20; ++draw)
        sum += f(CounterRandom(77, id, step, RandomPurpose::cross_slip), draw);
  return sum / 200000;
}

constexpr double n_samples = 200000, sigmas = 4;

TEST(CounterRandom, UniformNumbersFillTheUnitInterval)
{
  const auto uniform = [](const CounterRandom &r, const unsigned k) { return r.uniform(k); };
  EXPECT_NEAR(mean(uniform), 0.5, sigmas * std::sqrt(1 / 12.0 / n_samples));
  const auto square = [&](const CounterRandom &r, const unsigned k) { return std::pow(uniform(r, k) - 0.5, 2); };
  EXPECT_NEAR(mean(square), 1 / 12.0, sigmas * std::sqrt(1 / 180.0 / n_samples));
}

TEST(CounterRandom, NormalNumbersHaveTheMomentsOfTheNormalDistribution)
{
  const auto moment = [](const int power)
  {
    return mean([power](const CounterRandom &r, const unsigned k)
                { return 0.5 * (std::pow(r.normal_pair(k)[0], power) + std::pow(r.normal_pair(k)[1], power)); });
  };
  // Of 2 n_samples numbers; the variance of x^p is <x^2p> - <x^p>^2.
  const double n = 2 * n_samples;
  EXPECT_NEAR(moment(1), 0, sigmas * std::sqrt(1 / n));
  EXPECT_NEAR(moment(2), 1, sigmas * std::sqrt(2 / n));
  EXPECT_NEAR(moment(3), 0, sigmas * std::sqrt(15 / n));
  EXPECT_NEAR(moment(4), 3, sigmas * std::sqrt(96 / n));
}

TEST(CounterRandom, NumbersOfNeighbouringCountersAreUncorrelated)
{
  const auto number = [](const unsigned id, const unsigned step, const unsigned k)
  { return CounterRandom(5, id, step, RandomPurpose::thermal_force).normal_pair(k); };
  double by_id = 0, by_step = 0, by_draw = 0, in_pair = 0;
  constexpr unsigned n = 300;
  for (unsigned id = 0; id < n; ++id)
    for (unsigned step = 0; step < n; ++step)
    {
      const auto [a, b] = number(id, step, 0);
      by_id += a * number(id + 1, step, 0)[0];
      by_step += a * number(id, step + 1, 0)[0];
      by_draw += a * number(id, step, 1)[0];
      in_pair += a * b;
    }
  for (const double sum : {by_id, by_step, by_draw, in_pair})
    EXPECT_NEAR(sum / (n * n), 0, sigmas / n);
}
} // namespace
} // namespace ddfem
