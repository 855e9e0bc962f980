#include "coupling/loading.h"
#include "coupling/stages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

namespace ddfem::coupling
{
namespace
{
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Stages, AreReadInSiUnits)
{
  const auto stages = parse_stages({"strain rate -1e4 until strain -2e-3", "constant stress until duration 1e-8",
                                    "constant stress 50e6 until plastic strain 1e-4", "unload 2e4 until stress -1e6",
                                    "free until duration 1e-9", "stress rate 1e15 until stress 1e8", "hold"});
  ASSERT_EQ(stages.size(), 7U);
  EXPECT_EQ(stages[0].kind, StageKind::strain_rate);
  EXPECT_DOUBLE_EQ(stages[0].rate, -1e-5);
  EXPECT_DOUBLE_EQ(stages[0].end_value, -2e-3);
  EXPECT_FALSE(stages[1].jumps);
  EXPECT_DOUBLE_EQ(stages[1].end_value, 10);
  EXPECT_TRUE(stages[2].jumps);
  EXPECT_DOUBLE_EQ(stages[2].stress, 50);
  EXPECT_EQ(stages[2].end, StageEnd::plastic_strain);
  EXPECT_EQ(stages[3].kind, StageKind::unload);
  EXPECT_DOUBLE_EQ(stages[3].end_value, -1);
  EXPECT_TRUE(stages[4].jumps);
  EXPECT_DOUBLE_EQ(stages[4].stress, 0);
  EXPECT_DOUBLE_EQ(stages[5].rate, 1);
  EXPECT_EQ(stages[6].end, StageEnd::none);
}

TEST(Stages, MistakesAreRefused)
{
  for (const char *item :
       {"strain rate", "strain rates 1e4 until duration 1", "strain rate 1e4 until", "strain rate 1e4 until lunch 3",
        "hold 3 until duration 1", "hold until strain 1", "unload 1e4 until duration 1", "unload -1 until stress 0",
        "constant stress 1e6 until stress 2e6", "strain rate 1e4 2e4 until duration 1",
        "strain rate 1x until duration 1", "hold until duration -1", "free 1", ""})
    EXPECT_THROW(parse_stages({item, "hold"}), std::invalid_argument) << item;
  EXPECT_THROW(parse_stages({"hold", "hold"}), std::invalid_argument) << "a stage without an end that is not the last";
}

/// Plays stages on a body without lines, or with a plastic strain that grows with time, in steps of at most @p step.
struct Body
{
  double modulus = 7e4;
  double plastic_rate = 0; ///< 1/ns
  double plastic(const double t) const { return plastic_rate * t; }
  BodyResponse response(const double t) const { return {-modulus * plastic(t), modulus}; }
};

Loading play(const std::vector<std::string> &stages, const Body &body, const double step,
             const std::function<void(const Loading &)> &look, const double machine = infinity)
{
  Loading loading({parse_stages(stages), machine, 1e-3});
  double t = 0;
  loading.start(t, body.response(t));
  for (int k = 0; k < 100000 && !loading.finished(); ++k)
  {
    t += std::min(step, loading.time_left());
    loading.update(t, body.response(t));
    look(loading);
    while (loading.stage_over())
      loading.next_stage(body.response(t));
  }
  EXPECT_TRUE(loading.finished());
  return loading;
}

TEST(Loading, StagesEndExactlyAtTimesAndPrescribedStrainsAndStresses)
{
  const Body body{.plastic_rate = 1e-7};
  std::vector<LoadState> ends;
  play({"strain rate 1e4 until strain 1.23e-3", "hold until duration 7.7e-9", "stress rate -1e16 until stress 1e7",
        "constant stress until duration 1e-8"},
       body, 0.77,
       [&](const Loading &l)
       {
         if (l.stage_over() || l.finished())
           ends.push_back(l.state());
       });
  ASSERT_EQ(ends.size(), 4U);
  EXPECT_NEAR(ends[0].strain, 1.23e-3, 1e-12);
  EXPECT_NEAR(ends[1].time - ends[0].time, 7.7, 1e-9);
  EXPECT_NEAR(ends[1].strain, 1.23e-3, 1e-12);
  EXPECT_NEAR(ends[1].stress, body.modulus * (1.23e-3 - body.plastic(ends[1].time)), 1e-9); // it has relaxed
  EXPECT_NEAR(ends[2].stress, 10, 1e-7);
  EXPECT_NEAR(ends[3].stress, 10, 1e-7);
  EXPECT_NEAR(ends[3].strain - ends[2].strain, body.plastic(10), 1e-12); // creep
}

TEST(Loading, StressUnderAStrainRateIsMetToTheTolerance)
{
  for (const double plastic_rate : {0.0, 5e-6, 9e-6}) // of 1e-5
  {
    const Loading l =
        play({"strain rate 1e4 until stress 3e7"}, {.plastic_rate = plastic_rate}, 100, [](const Loading &) {});
    EXPECT_NEAR(l.state().stress, 30, 1e-3 * 30) << plastic_rate;
  }
}

TEST(Loading, PlasticStrainOfCreepIsMetToTheTolerance)
{
  const Loading l =
      play({"constant stress 2e7 until plastic strain 1e-4"}, {.plastic_rate = 1e-7}, 30, [](const Loading &) {});
  EXPECT_NEAR(l.plastic_strain(), 1e-4, 1e-3 * 1e-4);
  EXPECT_NEAR(l.state().stress, 20, 1e-12);
}

TEST(Loading, UnloadingFindsItsDirectionFromBothSides)
{
  for (const char *sense : {"", "-"})
  {
    double slope = 0;
    LoadState before;
    const std::string sign = sense;
    const Body body{};
    const Loading l =
        play({"strain rate " + sign + "1e4 until strain " + sign + "1e-3", "unload 1e4 until stress 0"}, body, 3,
             [&](const Loading &now)
             {
               if (now.stage() == 1)
                 slope = (now.state().stress - before.stress) / (now.state().strain - before.strain);
               before = now.state();
             });
    EXPECT_NEAR(l.state().stress, 0, 1e-3 * 70);
    EXPECT_NEAR(slope / body.modulus, 1, 1e-9);
  }
}

TEST(Loading, SpringInSeriesSharesTheMotionOfTheDrive)
{
  const Body body{.plastic_rate = 2e-6};
  const double k = 3e4, rate = 1e-5;
  bool looked = false;
  play(
      {"strain rate 1e4 until duration 1e-7", "hold until duration 5e-8"}, body, 7,
      [&](const Loading &l)
      {
        const double drive = rate * std::min(l.state().time, 100.0);
        EXPECT_NEAR(k * (drive - l.state().strain), l.state().stress, 1e-9);
        EXPECT_NEAR(body.modulus * (l.state().strain - body.plastic(l.state().time)), l.state().stress, 1e-9);
        looked = true;
      },
      k);
  EXPECT_TRUE(looked);
}

TEST(Loading, MachineOfAnyStiffnessHoldsWhatItHasReachedUnderForce)
{
  // From force control to hold nothing jumps, because the drive starts where it balances.
  LoadState at_end_of_force;
  play(
      {"stress rate 1e16 until stress 5e7", "hold until duration 1e-8"}, {}, 1,
      [&](const Loading &l)
      {
        if (l.stage() == 0)
          at_end_of_force = l.state();
        else
          EXPECT_NEAR(l.state().strain, at_end_of_force.strain, 1e-15);
      },
      2e4);
  EXPECT_NEAR(at_end_of_force.stress, 50, 1e-7);
}

TEST(Loading, StageThatLeadsAwayFromItsEndIsAnError)
{
  Loading loading({parse_stages({"strain rate 1e4 until strain -1e-3"})});
  EXPECT_THROW(loading.start(0, {0, 7e4}), std::runtime_error);
}
} // namespace
} // namespace ddfem::coupling
