#include "coupling/simulation.h"

#include <gtest/gtest.h>
#include <omp.h>

namespace ddfem::coupling
{
namespace
{
InputDeck deck_of(const std::string &mode, const std::vector<std::string> &more = {})
{
  InputDeck deck;
  std::vector<std::string> all{"Mode=" + mode,
                               "Domain/Origin=-4e-7 -4e-7 -4e-7",
                               "Domain/Size=8e-7 8.4e-7 8.8e-7",
                               "Microstructure/Frank-Read sources=1 1 1 / -1 0 1 / 0 0 0 / 2e-7 / 90",
                               "Microstructure/Loops=1 -1 1 / 1 1 0 / 1e-7 1e-7 1e-7 / 8e-8 / 12",
                               "Discretisation/Minimum segment=1.5e-8",
                               "Discretisation/Maximum segment=4e-8",
                               "Time stepping/Maximum steps=60",
                               "Output/Frame interval=0"};
  all.insert(all.end(), more.begin(), more.end());
  for (const std::string &s : all)
    deck.set_from_command_line(s);
  return deck;
}

const std::vector<std::string> high_stress{"Loading/Type=stress", "Loading/Stress=0 0 200e6 0 150e6 0"};

struct Outcome
{
  std::uint64_t checksum;
  SymTensor plastic_strain;
  std::size_t cross_slips;
};

Outcome run(const InputDeck &deck, MPI_Comm communicator, const int threads)
{
  const int before = omp_get_max_threads();
  omp_set_num_threads(threads);
  Simulation simulation(interpret(deck), communicator);
  RunOutput silent("", false);
  simulation.run(silent);
  omp_set_num_threads(before);
  return {simulation.network().checksum(), simulation.plastic_strain(), simulation.topology_counts().cross_slips};
}

/// Mode and integrator.
class SameTrajectory : public testing::TestWithParam<std::pair<std::string, std::string>>
{
};

TEST_P(SameTrajectory, BitByBitOnAnyNumberOfRanksAndThreads)
{
  std::vector<std::string> entries = high_stress;
  entries.push_back("Time stepping/Integrator=" + GetParam().second);
  const InputDeck deck = deck_of(GetParam().first, entries);
  const Outcome one = run(deck, MPI_COMM_SELF, 1);
  EXPECT_GT(one.plastic_strain.norm(), 1e-7); // something has happened
  for (const auto &[communicator, threads] : {std::pair(MPI_COMM_SELF, 2), {MPI_COMM_WORLD, 1}, {MPI_COMM_WORLD, 2}})
  {
    const Outcome other = run(deck, communicator, threads);
    EXPECT_EQ(one.checksum, other.checksum) << threads << " threads";
    for (Eigen::Index c = 0; c < 6; ++c)
      EXPECT_EQ(one.plastic_strain[c], other.plastic_strain[c]);
  }
}

class RandomTrajectory : public testing::TestWithParam<const char *>
{
};

TEST_P(RandomTrajectory, IsTheSameOnAnyNumberOfRanksAndThreads)
{
  // Screw sources that cross-slip often, and the noise of the heat bath.
  std::vector<std::string> settings = high_stress;
  settings.insert(settings.end(), {"Microstructure/Frank-Read sources=1 1 1 / -1 0 1 / 0 0 0 / 2e-7 / 0",
                                   "Mobility/Thermal motion=true", "Cross-slip/Model=thermally activated",
                                   "Cross-slip/Attempt rate=1e14", "Cross-slip/Activation energy=1e-20",
                                   "Time stepping/Maximum steps=25"});
  const Outcome one = run(deck_of(GetParam(), settings), MPI_COMM_SELF, 1);
  EXPECT_GT(one.cross_slips, 0U);
  for (const auto &[communicator, threads] : {std::pair(MPI_COMM_SELF, 2), {MPI_COMM_WORLD, 1}})
  {
    const Outcome other = run(deck_of(GetParam(), settings), communicator, threads);
    EXPECT_EQ(one.checksum, other.checksum) << threads << " threads";
    EXPECT_EQ(one.cross_slips, other.cross_slips);
  }
  settings.push_back("Random seed=2");
  EXPECT_NE(one.checksum, run(deck_of(GetParam(), settings), MPI_COMM_SELF, 1).checksum);
}

INSTANTIATE_TEST_SUITE_P(Modes, SameTrajectory,
                         testing::Values(std::pair("infinite", "stabilised"), std::pair("periodic", "stabilised"),
                                         std::pair("periodic", "subcycling")));

INSTANTIATE_TEST_SUITE_P(Modes, RandomTrajectory, testing::Values("infinite", "periodic"));

TEST(FiniteTrajectory, AgreesOnAnyNumberOfRanksToTheSolverTolerance)
{
  const InputDeck deck =
      deck_of("finite", {"Loading/Strain rate=-2e6", "Boundary conditions/Platen contact=frictionless",
                         "Domain/Subdivisions=3 3 4", "Domain/Elastic tolerance=1e-10"});
  const Outcome one = run(deck, MPI_COMM_SELF, 1);
  const Outcome other = run(deck, MPI_COMM_WORLD, 2);
  EXPECT_GT(one.plastic_strain.norm(), 1e-8);
  EXPECT_NEAR((one.plastic_strain - other.plastic_strain).norm(), 0, 1e-6 * one.plastic_strain.norm());
}

TEST(PeriodicLoading, ConstantStrainRateStressIsTheElasticPartOfTheStrain)
{
  const InputDeck deck =
      deck_of("periodic", {"Loading/Type=strain rate", "Loading/Strain rate=1e7", "Loading/Axis=0 0 1"});
  Simulation simulation(interpret(deck), MPI_COMM_SELF);
  RunOutput silent("", false);
  simulation.run(silent);
  const double modulus = interpret(deck).medium.youngs_modulus();
  const double strain = simulation.nominal_strain();
  EXPECT_GT(strain, 1e-5);
  EXPECT_NEAR(simulation.applied_stress()[2], modulus * (strain - simulation.plastic_strain()[2]),
              1e-9 * modulus * strain);
  EXPECT_NEAR(simulation.applied_stress().norm(), std::abs(simulation.applied_stress()[2]), 1e-12 * modulus * strain);
}

TEST(StopCriteria, RunEndsExactlyAtTheFinalTime)
{
  InputDeck deck = deck_of("infinite", {"Time stepping/Maximum steps=100000", "Time stepping/Final time=1.23e-11"});
  for (const std::string &s : high_stress)
    deck.set_from_command_line(s);
  Simulation simulation(interpret(deck), MPI_COMM_SELF);
  RunOutput silent("", false);
  EXPECT_EQ(simulation.run(silent), RunEnd::finished);
  EXPECT_NEAR(simulation.current_time(), 0.0123, 1e-15);
}
} // namespace
} // namespace ddfem::coupling
