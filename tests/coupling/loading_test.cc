// Runs of small grains under stages, read back from history.csv.
#include "coupling/simulation.h"
#include "dd/elasticity/segment_energy.h"
#include "tests/support/history.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <unistd.h>

namespace ddfem::coupling
{
namespace
{
using test::Columns;
using test::read_history;

/// An aluminium box of 400 x 400 x 900 nm with one source of 200 nm whose slip plane does not meet the platens.
const std::vector<std::string> pillar{"Crystal/Direction along x=1 2 -1",
                                      "Crystal/Direction along z=-1 3 5",
                                      "Domain/Origin=-2e-7 -2e-7 0",
                                      "Domain/Size=4e-7 4e-7 9e-7",
                                      "Domain/Subdivisions=3 3 6",
                                      "Boundary conditions/Platen contact=frictionless",
                                      "Microstructure/Frank-Read sources=1 1 1 / -1 0 1 / 0 0 4.5e-7 / 2e-7 / 90",
                                      "Discretisation/Minimum segment=1.5e-8",
                                      "Discretisation/Maximum segment=4e-8",
                                      "Time stepping/Maximum steps=2000",
                                      "Time stepping/Initial step=1e-12",
                                      "Output/Frame interval=0"};

Columns run(const std::vector<std::string> &more, const std::vector<std::string> &base = pillar)
{
  InputDeck deck;
  for (const std::string &s : base)
    deck.set_from_command_line(s);
  for (const std::string &s : more)
    deck.set_from_command_line(s);
  const std::string directory =
      (std::filesystem::temp_directory_path() / ("ddfem_loading_" + std::to_string(getpid()))).string();
  Simulation simulation(interpret(deck), MPI_COMM_SELF);
  {
    RunOutput output(directory, true);
    simulation.run(output);
  }
  const Columns h = read_history(directory + "/history.csv");
  std::filesystem::remove_all(directory);
  return h;
}

std::vector<std::string> stages(const std::string &list)
{
  return {"Loading/Type=stages", "Loading/Stages=" + list};
}

const double section = 4e-7 * 4e-7;

TEST(FiniteLoading, StressAndForceAreThoseOfTheStages)
{
  const Columns h = run(stages("stress rate 1e17 until stress 6e7; constant stress until duration 2e-10; "
                               "stress rate -1e17 until stress -6e7; constant stress 5e7 until duration 5e-10; "
                               "free until duration 1e-10"));
  const auto &t = h.at("time [s]"), &stress = h.at("stress [Pa]"), &force = h.at("reaction platen [N]");
  const auto &stage = h.at("stage");
  for (std::size_t i = 0; i < t.size(); ++i)
  {
    // The history holds the state after a change of stage, so that a row of a new stage may be its first.
    const double expected = stage[i] == 1   ? 1e17 * t[i]
                            : stage[i] == 2 ? 6e7
                            : stage[i] == 3 ? 6e7 - 1e17 * (t[i] - 8e-10)
                            : stage[i] == 4 ? 5e7
                                            : 0;
    EXPECT_NEAR(stress[i], expected, 1e-6 * 6e7) << "stage " << stage[i] << " at " << t[i];
    // The reaction is read from the solution, not from the loading.
    EXPECT_NEAR(force[i] / section, expected, 1e-6 * 6e7);
  }
  EXPECT_EQ(stage.back(), 5);
  EXPECT_NEAR(t.back(), 6e-10 + 2e-10 + 1.2e-9 + 5e-10 + 1e-10, 1e-18);
  EXPECT_GT(std::abs(h.at("axial plastic strain [-]").back()), 1e-9); // lines have moved
}

/// Compression until the source is bowed out, hold, unloading, rest, reloading.
const Columns &compression()
{
  static const Columns h = run(stages("strain rate -2e6 until plastic strain -6e-5; hold until duration 1e-10; "
                                      "unload 2e6 until stress -2e6; free until duration 2e-9; "
                                      "strain rate -2e6 until stress -4e7"));
  return h;
}

std::pair<std::size_t, std::size_t> rows_of(const Columns &h, const double stage)
{
  const auto &s = h.at("stage");
  std::size_t first = 0;
  while (s[first] != stage)
    ++first;
  std::size_t last = first;
  while (last + 1 < s.size() && s[last + 1] == stage)
    ++last;
  return {first, last};
}

TEST(FiniteLoading, EndsOfStagesAreMet)
{
  const Columns &h = compression();
  const auto &strain = h.at("strain [-]"), &stress = h.at("stress [Pa]");
  const auto [first_2, last_2] = rows_of(h, 2);
  const auto [first_3, last_3] = rows_of(h, 3);
  const std::size_t first_4 = rows_of(h, 4).first, last_5 = rows_of(h, 5).second;
  // Rows at a change of stage belong to the new one. Tolerance of the stages: 1e-3 of their way.
  const auto plastic = [&](const std::size_t i) { return strain[i] - h.at("elastic strain [-]")[i]; };
  EXPECT_NEAR(plastic(first_2) / -6e-5, 1, 1e-3);
  EXPECT_NEAR(h.at("time [s]")[first_3] - h.at("time [s]")[first_2], 1e-10, 1e-19);
  EXPECT_NEAR(strain[last_2], strain[first_2], 1e-15);
  EXPECT_NEAR(stress[last_3], -2e6, 0.1 * std::abs(stress[first_3] + 2e6)); // a row before the end
  EXPECT_EQ(stress[first_4], 0);                                            // jumped to
  EXPECT_NEAR(stress[last_5], -4e7, 1e-3 * 4e7);
}

TEST(FiniteLoading, UnloadingAndReloadingFollowTheModulus)
{
  const Columns &h = compression();
  const double e = interpret(InputDeck()).medium.youngs_modulus() * 1e6;
  for (const double stage : {3.0, 5.0})
  {
    const auto [first, last] = rows_of(h, stage);
    const auto change = [&](const char *column) { return h.at(column)[last] - h.at(column)[first]; };
    // Frictionless platens: E is the modulus exactly, once the slip is subtracted that lines still do; 0.1 % of the slip that
    // is there, over the elastic strain of the stage.
    const double elastic = change("strain [-]") - change("axial plastic strain [-]");
    EXPECT_NEAR(change("stress [Pa]") / elastic / e, 1, 1e-4);
    // After a rest lines are in equilibrium, and the slope is that of the elastic grain but for their bowing.
    if (stage == 5)
    {
      EXPECT_NEAR(change("stress [Pa]") / change("strain [-]") / e, 1, 0.02);
    }
  }
}

TEST(FiniteLoading, PlasticStrainIsTotalMinusElastic)
{
  const Columns &h = compression();
  const auto &plastic = h.at("axial plastic strain [-]");
  EXPECT_LT(*std::min_element(plastic.begin(), plastic.end()), -5.9e-5);
  for (std::size_t i = 0; i < plastic.size(); ++i)
    EXPECT_NEAR(h.at("strain [-]")[i] - h.at("elastic strain [-]")[i], plastic[i], 1e-3 * 6e-5);
}

TEST(FiniteLoading, WorkIsStoredOrDissipated)
{
  const Columns &h = compression();
  const auto &work = h.at("work [J]"), &force = h.at("reaction platen [N]"), &strain = h.at("strain [-]");
  double by_force = 0, largest = 0;
  for (std::size_t i = 1; i < work.size(); ++i)
  {
    if (h.at("stage")[i] == h.at("stage")[i - 1]) // rows hold the state after a change of stage
      by_force += 0.5 * (force[i] + force[i - 1]) * (strain[i] - strain[i - 1]) * 9e-7;
    // 1 % of the largest work; rows at rest hold rounding.
    largest = std::max(largest, std::abs(work[i]));
    EXPECT_NEAR(work[i], h.at("stored energy [J]")[i] + h.at("dissipated energy [J]")[i], 0.01 * largest + 1e-30);
    EXPECT_GE(h.at("dissipated energy [J]")[i], h.at("dissipated energy [J]")[i - 1] - 1e-5 * largest);
  }
  EXPECT_NEAR(by_force / work.back(), 1, 0.05);
}

TEST(FiniteLoading, StepsWithoutASolveShowTheWorkOfThePlatens)
{
  const Columns h =
      run({"Loading/Strain rate=-2e6", "Time stepping/Final time=8e-10", "Domain/Correction tolerance=1e-2"});
  const auto &work = h.at("work [J]"), &force = h.at("reaction platen [N]"), &strain = h.at("strain [-]");
  double by_force = 0;
  std::size_t solves = 0;
  for (std::size_t i = 1; i < work.size(); ++i)
  {
    by_force += 0.5 * (force[i] + force[i - 1]) * (strain[i] - strain[i - 1]) * 9e-7;
    solves += h.at("FEM iterations").at(i) > 0 ? 1 : 0;
    // The load at rest is exact but for the mesh (some 1e-4), and jumps by its error at a solve.
    EXPECT_NEAR(work[i], by_force, 1e-2 * std::abs(by_force) + 1e-30);
    EXPECT_NEAR(work[i], h.at("stored energy [J]")[i] + h.at("dissipated energy [J]")[i],
                0.01 * std::abs(work[i]) + 1e-30);
  }
  EXPECT_LT(solves, work.size() / 2);
}

TEST(FiniteLoading, MachineSpringSharesTheDisplacement)
{
  // A spring as stiff as the grain: k = E S / L.
  const double e = interpret(InputDeck()).medium.youngs_modulus() * 1e6, k = e * section / 9e-7;
  const Columns h = run(
      {"Loading/Strain rate=-4e6", "Loading/Machine stiffness=" + std::to_string(k), "Time stepping/Final time=8e-10"});
  for (std::size_t i = 0; i < h.at("step").size(); ++i)
  {
    const double drive = -4e6 * h.at("time [s]")[i] * 9e-7, grain = h.at("strain [-]")[i] * 9e-7;
    EXPECT_NEAR(k * (drive - grain), h.at("reaction platen [N]")[i], 1e-6 * k * 1.6e-3 * 9e-7);
  }
  EXPECT_NEAR(h.at("strain [-]").back(), -1.6e-3, 0.02 * 1.6e-3); // half of the drive, and a little slip
}

TEST(FiniteLoading, AGrainWithoutPlatensRelaxesWithoutForce)
{
  std::vector<std::string> loop = pillar;
  loop.push_back("Microstructure/Loops=1 1 1 / -1 0 1 / 0 0 3e-7 / 6e-8 / 12");
  const Columns h =
      run({"Boundary conditions/Platen motion=none", "Loading/Type=none", "Time stepping/Final time=1e-10"}, loop);
  for (const char *column : {"stress [Pa]", "strain [-]", "reaction platen [N]", "platen moment x [N m]", "work [J]"})
    EXPECT_EQ(h.at(column).back(), 0) << column;
  EXPECT_GT(h.at("dissipated energy [J]").back(), 0);
  EXPECT_LT(h.at("stored energy [J]").back(), 0); // the loop shrinks
  EXPECT_NEAR(h.at("stored energy [J]").back() / h.at("dissipated energy [J]").back(), -1, 0.01);
}

TEST(FiniteLoading, StartsAtZeroLoad)
{
  const Columns &h = compression();
  for (const char *column : {"strain [-]", "work [J]", "stored energy [J]", "dissipated energy [J]"})
    EXPECT_EQ(h.at(column)[0], 0) << column;
  // A source at rest is a line minus itself: rounding of 100 MPa.
  EXPECT_NEAR(h.at("stress [Pa]")[0], 0, 1e-4);
}
/// Energy of all lines in an unbounded body, J.
double line_energy(const Network &network, const IsotropicMedium &medium)
{
  double energy = 0;
  const auto segments = network.segments();
  for (auto s = segments.begin(); s != segments.end(); ++s)
  {
    const auto ends = [&](const SegmentIndex i)
    { return std::pair(network.position(network.start(i)), network.position(network.end(i))); };
    const auto [x1, x2] = ends(*s);
    energy += segment_self_energy(medium, x1, x2, network.burgers(*s));
    for (auto other = std::next(s); other != segments.end(); ++other)
    {
      const auto [x3, x4] = ends(*other);
      energy += segment_interaction_energy(medium, x1, x2, network.burgers(*s), x3, x4, network.burgers(*other), 1e-8);
    }
  }
  return energy * 1e-21;
}

TEST(InfiniteLoading, StoredEnergyIsThatOfTheLinesByBlinsFormula)
{
  // A loop that shrinks under its own field: what is stored is the elastic energy of closed lines, known in closed form.
  InputDeck deck;
  for (const char *s : {"Mode=infinite", "Loading/Type=none", "Microstructure/Loops=1 1 1 / -1 0 1 / 0 0 0 / 2e-7 / 24",
                        "Discretisation/Minimum segment=1.5e-8", "Discretisation/Maximum segment=6e-8",
                        "Time stepping/Final time=6e-11", "Time stepping/Initial step=1e-12"})
    deck.set_from_command_line(s);
  Simulation simulation(interpret(deck), MPI_COMM_SELF);
  const IsotropicMedium medium = interpret(deck).medium;
  const double before = line_energy(simulation.network(), medium);
  RunOutput silent("", false);
  simulation.run(silent);
  const double released = before - line_energy(simulation.network(), medium);
  const Energies &e = simulation.energy_balance().energies();
  EXPECT_GT(released, 0.1 * before);
  EXPECT_EQ(e.work, 0);
  // Remeshing cuts corners, whose energy the work of the forces does not see.
  EXPECT_NEAR(e.dissipated * 1e-21 / released, 1, 0.02);
  EXPECT_NEAR(e.stored, -e.dissipated, 1e-12 * e.dissipated);
}
} // namespace
} // namespace ddfem::coupling
