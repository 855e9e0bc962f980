// Steps without an elastic solve: the true error of the segment forces against its estimate, and what skipping does to a run.
//
// An aluminium pillar in which a source bows out and slips while a loop near a side relaxes and leaves. In each step that did
// without a solve, the correction, the platen's force and its moment are compared with those of a solve at the same instant, of
// which the run sees nothing. --study: the table of docs/validation.md.
#include "coupling/simulation.h"
#include "image_field.h"

#include <algorithm>
#include <chrono>

using namespace ddfem;
using namespace ddfem::validation;
using coupling::FiniteGrain;
using coupling::GrainSolution;
using coupling::Simulation;

namespace
{
/// What a run without or with skipping gave.
struct Outcome
{
  unsigned solves = 0, skips = 0;
  double largest_error = 0;   ///< true error of the force over the force scale, largest of all steps
  double mean_error = 0;      ///< rms over the steps that were skipped
  double largest_ratio = 0;   ///< true error over its estimate, where either exceeds a tenth of the tolerance
  double load_error = 0;      ///< of the platen's load, over the largest load of the run
  double moment_error = 0;    ///< of the platen's moment, over the largest
  double plastic_strain = 0;  ///< norm at the end
  double energy_mismatch = 0; ///< largest, relative
  double seconds = 0;         ///< wall time of the steps
};

coupling::Parameters pillar(const std::string &contact, const double tolerance, const bool fine)
{
  coupling::InputDeck deck;
  for (const std::string &s :
       {std::string("Crystal/Direction along x=1 2 -1"), std::string("Crystal/Direction along z=-1 3 5"),
        std::string("Domain/Origin=-2e-7 -2e-7 0"), std::string("Domain/Size=4e-7 4e-7 8e-7"),
        std::string(fine ? "Domain/Subdivisions=8 8 16" : "Domain/Subdivisions=4 4 8"),
        std::string("Domain/Elastic tolerance=1e-8"), "Boundary conditions/Platen contact=" + contact,
        std::string("Microstructure/Frank-Read sources=1 1 1 / -1 0 1 / 0 0 4e-7 / 2e-7 / 90"),
        std::string("Microstructure/Loops=1 -1 1 / 1 1 0 / 1.5e-7 0 5.5e-7 / 3e-8 / 12"),
        std::string("Discretisation/Minimum segment=1.5e-8"), std::string("Discretisation/Maximum segment=4e-8"),
        std::string("Loading/Type=strain rate"), std::string("Loading/Strain rate=-2e6"),
        std::string(fine ? "Time stepping/Maximum steps=400" : "Time stepping/Maximum steps=120"),
        "Domain/Correction tolerance=" + std::to_string(tolerance), std::string("Time stepping/Initial step=1e-12"),
        std::string("Output/Frame interval=0")})
    deck.set_from_command_line(s);
  return interpret(deck);
}

/// Compares with solves that the run does not see.
class Check
{
public:
  Check(const Simulation &observed, const double allowed, Outcome &result)
      : simulation(observed), tolerance(allowed), outcome(result)
  {
  }

  void operator()(FiniteGrain &grain, const LineSystem &lines)
  {
    const auto &update = *simulation.correction_update();
    if (update.counts().skips == skips_seen)
      return;
    skips_seen = update.counts().skips;
    const Network &network = simulation.network();
    const SegmentField extrapolated = grain.correction_at_segments(network);
    const FiniteGrain::ElementState state = grain.element_state();
    const double q = simulation.load_state().strain / grain.platen().strain_per_motion();
    GrainSolution given = simulation.grain_solution();
    const GrainSolution exact = grain.solve(lines, q);
    const SegmentField solved = grain.correction_at_segments(network);
    compare(network, extrapolated, solved, update.estimate());
    load_scale = std::max(load_scale, exact.platen_force.norm());
    moment_scale = std::max(moment_scale, exact.platen_moment.norm());
    outcome.load_error = std::max(outcome.load_error, (given.platen_force - exact.platen_force).norm() / load_scale);
    outcome.moment_error =
        std::max(outcome.moment_error, (given.platen_moment - exact.platen_moment).norm() / moment_scale);
    grain.extrapolate_to(lines, state, given.load_at_rest, given);
    grain.move_platen(given, q);
  }

private:
  void compare(const Network &network, const SegmentField &extrapolated, const SegmentField &solved,
               const double estimate)
  {
    std::vector<SymTensor> difference = extrapolated.stress;
    for (std::size_t k = 0; k < difference.size(); ++k)
      difference[k] -= solved.stress[k];
    const double scale = simulation.correction_update()->force_scale();
    const double error = coupling::force_norm(network, solved.points, difference) / scale;
    outcome.largest_error = std::max(outcome.largest_error, error);
    outcome.mean_error =
        std::sqrt((outcome.mean_error * outcome.mean_error * (skips_seen - 1) + error * error) / skips_seen);
    if (std::max(error, estimate) > 0.1 * tolerance)
      outcome.largest_ratio = std::max(outcome.largest_ratio, error / estimate);
  }

  const Simulation &simulation;
  double tolerance;
  Outcome &outcome;
  unsigned skips_seen = 0;
  double load_scale = 1e-300, moment_scale = 1e-300;
};

Outcome run_pillar(const coupling::Parameters &parameters, const bool compare)
{
  Outcome outcome;
  Simulation simulation(parameters, MPI_COMM_WORLD);
  Check check(simulation, parameters.grain.correction_tolerance, outcome);
  simulation.observe_correction(
      [&](FiniteGrain &grain, const LineSystem &lines)
      {
        if (compare)
          check(grain, lines);
        outcome.energy_mismatch =
            std::max(outcome.energy_mismatch, std::abs(simulation.energy_balance().relative_mismatch()));
      });
  coupling::RunOutput silent("", false);
  const auto start = std::chrono::steady_clock::now();
  simulation.run(silent);
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  outcome.solves = simulation.correction_update()->counts().solves;
  outcome.skips = simulation.correction_update()->counts().skips;
  outcome.plastic_strain = to_matrix(simulation.plastic_strain()).norm();
  return outcome;
}

void study(Report &report)
{
  report.note("contact      tolerance  solves  skips  largest error  rms error  true/estimate  load err.  moment err.  "
              "plastic strain  energy mismatch  seconds");
  for (const std::string contact : {"frictionless", "clamped"})
    for (const double tolerance : {0.0, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2})
    {
      const coupling::Parameters parameters = pillar(contact, tolerance, true);
      const Outcome timed = run_pillar(parameters, false), o = run_pillar(parameters, true);
      char row[250];
      std::snprintf(row, sizeof row, "%-12s %9.0e %7u %6u %14.2e %10.2e %14.3f %10.1e %12.1e %15.5e %16.1e %8.1f",
                    contact.c_str(), tolerance, o.solves, o.skips, o.largest_error, o.mean_error, o.largest_ratio,
                    o.load_error, o.moment_error, timed.plastic_strain, timed.energy_mismatch, timed.seconds);
      report.note(row);
    }
}

void check(Report &report, const std::string &contact)
{
  constexpr double tolerance = 1e-2;
  const Outcome every = run_pillar(pillar(contact, 0, false), false);
  const Outcome o = run_pillar(pillar(contact, tolerance, false), true);
  report.below(contact + ": share of steps that solve", o.solves / double(o.solves + o.skips), 0.5);
  report.below(contact + ": largest true error of the force over its estimate", o.largest_ratio, 1.5);
  report.below(contact + ": largest true error of the force", o.largest_error, tolerance);
  report.below(contact + ": error of the platen's force", o.load_error, tolerance);
  report.below(contact + ": change of the final plastic strain", o.plastic_strain / every.plastic_strain - 1,
               tolerance);
  report.below(contact + ": energy mismatch beyond that of the run that always solves",
               std::max(0.0, o.energy_mismatch - every.energy_mismatch), tolerance);
}
} // namespace

int main(int argc, char **argv)
{
  const bool all = study_requested(argc, argv);
  return run(argc, argv,
             [&](Report &report)
             {
               if (all)
                 study(report);
               else
                 for (const std::string contact : {"clamped", "frictionless"})
                   check(report, contact);
             });
}
