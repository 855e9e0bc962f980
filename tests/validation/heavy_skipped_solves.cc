// Steps without an elastic solve: the true error of the segment forces against its estimate, and what skipping does to a run.
//
// An aluminium pillar in which a source bows out and slips while a loop near a side relaxes and leaves, on which the constants of
// the estimate were set, and grains on which they were not: a cylinder and a film. In each step that did without a solve, the
// correction, the platen's force and its moment are compared with those of a solve at the same instant, of which the run sees
// nothing. --study [GRAIN]: the table of docs/validation.md.
#include "coupling/simulation.h"
#include "image_field.h"

#include <algorithm>

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
  double lever_error = 0;     ///< the same over the largest force, in half widths of the platen
  double energy_mismatch = 0; ///< largest, relative
  struct Instant
  {
    double time; ///< ns
    Mat3 plastic_strain;
    double load; ///< of the platen
  };
  std::vector<Instant> history; ///< of all steps, the start included
};

/// Between steps by the polynomial through two steps on either side.
Outcome::Instant at_time(const std::vector<Outcome::Instant> &history, const double time)
{
  const auto next = std::ranges::lower_bound(history, time, {}, &Outcome::Instant::time) - history.begin();
  const auto first = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(next - 2, 0, std::ssize(history) - 4));
  Outcome::Instant result{time, Mat3::Zero(), 0};
  for (std::size_t i = first; i < first + 4; ++i)
  {
    double weight = 1;
    for (std::size_t j = first; j < first + 4; ++j)
      if (j != i)
        weight *= (time - history[j].time) / (history[i].time - history[j].time);
    result.plastic_strain += weight * history[i].plastic_strain;
    result.load += weight * history[i].load;
  }
  return result;
}

/// Largest differences of two runs over the time that they share, relative to the largest values in it.
struct Difference
{
  double plastic_strain = 0, load = 0; ///< at equal times
  /// Distance of the curves of plastic strain over time: the difference in either of them, whichever is larger at the nearest points.
  double curve = 0;
};

/// The steps of the two runs differ in length, so that equal numbers of steps are not equal times: @p run is compared at its own
/// steps with values between the steps of @p reference.
Difference difference(const std::vector<Outcome::Instant> &run, const std::vector<Outcome::Instant> &reference)
{
  const double end = std::min(run.back().time, reference.back().time);
  double strain = 0, load = 0;
  for (const Outcome::Instant &i : reference)
    if (i.time <= end)
    {
      strain = std::max(strain, i.plastic_strain.norm());
      load = std::max(load, std::abs(i.load));
    }
  Difference largest;
  for (const Outcome::Instant &i : run)
  {
    if (i.time > end)
      break;
    const Outcome::Instant same_time = at_time(reference, i.time);
    const double at_equal_time = (i.plastic_strain - same_time.plastic_strain).norm() / strain;
    largest.plastic_strain = std::max(largest.plastic_strain, at_equal_time);
    largest.load = std::max(largest.load, std::abs(i.load - same_time.load) / load);
    double distance = at_equal_time;
    for (double shift = 1e-6; shift < distance; shift *= 1.2)
      for (const double time : {i.time - shift * end, i.time + shift * end})
        if (time >= 0 && time <= reference.back().time)
          distance = std::min(
              distance, std::max(shift, (i.plastic_strain - at_time(reference, time).plastic_strain).norm() / strain));
    largest.curve = std::max(largest.curve, distance);
  }
  return largest;
}

/// Of the values between steps: with every second step left out it is 16 times as large.
double interpolation_error(const std::vector<Outcome::Instant> &history)
{
  std::vector<Outcome::Instant> half;
  for (std::size_t i = 0; i < history.size(); i += 2)
    half.push_back(history[i]);
  return difference(history, half).plastic_strain / 16;
}

using Entries = std::vector<std::string>;

coupling::Parameters interpreted(const Entries &entries, const double tolerance)
{
  coupling::InputDeck deck;
  for (const std::string s :
       {"Crystal/Direction along x=1 2 -1", "Crystal/Direction along z=-1 3 5", "Discretisation/Minimum segment=1.5e-8",
        "Discretisation/Maximum segment=4e-8", "Time stepping/Maximum steps=120", "Time stepping/Initial step=1e-12",
        "Loading/Type=strain rate", "Loading/Strain rate=-2e6", "Output/Frame interval=0"})
    deck.set_from_command_line(s);
  for (const std::string &s : entries)
    deck.set_from_command_line(s);
  deck.set_from_command_line("Domain/Correction tolerance=" + std::to_string(tolerance));
  return interpret(deck);
}

/// What the constants of the estimate were set on.
Entries pillar(const std::string &contact)
{
  return {"Domain/Origin=-2e-7 -2e-7 0",
          "Domain/Size=4e-7 4e-7 8e-7",
          "Domain/Subdivisions=4 4 8",
          "Domain/Elastic tolerance=1e-8",
          "Boundary conditions/Platen contact=" + contact,
          "Microstructure/Frank-Read sources=1 1 1 / -1 0 1 / 0 0 4e-7 / 2e-7 / 90",
          "Microstructure/Loops=1 -1 1 / 1 1 0 / 1.5e-7 0 5.5e-7 / 3e-8 / 12"};
}

/// A curved side, which has no analytic images.
Entries cylinder(const std::string &elements)
{
  return {"Domain/Shape=cylinder",
          "Domain/Origin=0 0 0",
          "Domain/Radius=2.5e-7",
          "Domain/Height=9e-7",
          "Domain/Subdivisions=" + elements,
          "Time stepping/Maximum steps=400",
          "Microstructure/Frank-Read sources=1 -1 1 / 1 1 0 / 5e-8 2e-8 4e-7 / 2.4e-7 / 30"};
}

/// A half loop on the upper face of a film that is stretched along it, which shrinks and leaves, and a source.
Entries film(const std::string &degree, const std::string &elements, const std::string &image_depth)
{
  return {"Domain/Origin=0 0 0",
          "Domain/Size=6e-7 5e-7 2.5e-7",
          "Domain/Element degree=" + degree,
          "Domain/Subdivisions=" + elements,
          "Domain/Image depth=" + image_depth,
          "Boundary conditions/Fixed face=x-",
          "Boundary conditions/Platen face=x+",
          "Loading/Strain rate=2e6",
          "Microstructure/Cut at surface=true",
          "Microstructure/Frank-Read sources=1 1 1 / -1 0 1 / 2e-7 2.5e-7 1.2e-7 / 1.4e-7 / 60",
          "Microstructure/Loops=1 -1 1 / 1 1 0 / 4.2e-7 2.4e-7 2.5e-7 / 8e-8 / 16"};
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
    load.add(given.platen_force, exact.platen_force);
    moment.add(given.platen_moment, exact.platen_moment);
    grain.extrapolate_to(lines, state, given.load_at_rest, given);
    grain.move_platen(given, q);
  }

  /// Largest error of a vector over its largest magnitude, of all steps so far.
  struct Extremes
  {
    double error = 0, magnitude = 1e-300;
    void add(const Vec3 &given, const Vec3 &exact)
    {
      error = std::max(error, (given - exact).norm());
      magnitude = std::max(magnitude, exact.norm());
    }
    double relative() const { return error / magnitude; }
  };
  Extremes load, moment; ///< on the platen

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
};

Outcome run_grain(const coupling::Parameters &parameters)
{
  Outcome outcome;
  Simulation simulation(parameters, MPI_COMM_WORLD);
  Check check(simulation, parameters.grain.correction_tolerance, outcome);
  simulation.observe_correction(
      [&](FiniteGrain &grain, const LineSystem &lines)
      {
        check(grain, lines);
        outcome.history.push_back(
            {simulation.current_time(), to_matrix(simulation.plastic_strain()), simulation.grain_solution().load});
        outcome.energy_mismatch =
            std::max(outcome.energy_mismatch, std::abs(simulation.energy_balance().relative_mismatch()));
      });
  coupling::RunOutput silent("", false);
  simulation.run(silent);
  outcome.load_error = check.load.relative();
  outcome.moment_error = check.moment.relative();
  outcome.lever_error = check.moment.error / (check.load.magnitude * 0.5 * std::sqrt(simulation.grain()->section()));
  outcome.solves = simulation.correction_update()->counts().solves;
  outcome.skips = simulation.correction_update()->counts().skips;
  return outcome;
}

/// The run that solves in every step goes on for a while where the others end: what they do a little earlier is found in it.
Outcome run_with_all_solves(const Entries &entries)
{
  coupling::Parameters p = interpreted(entries, 0);
  p.stop.max_steps += p.stop.max_steps / 10;
  return run_grain(p);
}

void note_interpolation_error(Report &report, const std::string &name, const Outcome &o)
{
  char row[120];
  std::snprintf(row, sizeof row, "%s: interpolation in time adds up to %.1e to the change of the plastic strain",
                name.c_str(), interpolation_error(o.history));
  report.note(row);
}

/// @p only: one of the grains; empty: all.
void study(Report &report, const std::string &only)
{
  report.note(
      "grain                tolerance  solves  skips  largest error  rms error  true/estimate  load err.  moment "
      "err.     lever  energy mismatch  plastic strain     curve      load");
  const std::vector<std::pair<std::string, Entries>> grains{{"cylinder", cylinder("4 1 7")},
                                                            {"film", film("2", "8 7 4", "4")},
                                                            {"film, Q1", film("1", "16 14 8", "4")},
                                                            {"film without images", film("2", "8 7 4", "0")},
                                                            {"cylinder, fine", cylinder("6 1 11")},
                                                            {"clamped pillar", pillar("clamped")},
                                                            {"frictionless pillar", pillar("frictionless")}};
  for (const auto &[name, entries] : grains)
  {
    if (!only.empty() && only != name)
      continue;
    const Outcome reference = run_with_all_solves(entries);
    note_interpolation_error(report, name, reference);
    for (const double tolerance : {0.0, 1e-2, 3e-3, 1e-3, 3e-4})
    {
      const Outcome o = run_grain(interpreted(entries, tolerance));
      const Difference d = difference(o.history, reference.history);
      char row[250];
      std::snprintf(row, sizeof row,
                    "%-20s %9.0e %7u %6u %14.2e %10.2e %14.3f %10.1e %12.1e %9.1e %16.1e %15.1e %9.1e %9.1e",
                    name.c_str(), tolerance, o.solves, o.skips, o.largest_error, o.mean_error, o.largest_ratio,
                    o.load_error, o.moment_error, o.lever_error, o.energy_mismatch, d.plastic_strain, d.curve, d.load);
      report.note(row);
    }
  }
}

/// @p share: most steps that may solve. @p ratio: of the true error to its estimate.
void check_errors(Report &report, const std::string &name, const Outcome &o, const double tolerance, const double share,
                  const double ratio)
{
  report.below(name + ": share of steps that solve", o.solves / double(o.solves + o.skips), share);
  report.below(name + ": largest true error of the force over its estimate", o.largest_ratio, ratio);
  report.below(name + ": largest true error of the force", o.largest_error, tolerance);
  report.below(name + ": error of the platen's force", o.load_error, tolerance);
  // Not over the moment itself, which is a small remainder of forces that balance, and zero in the middle of the grain.
  report.below(name + ": error of the platen's moment over force x half width", o.lever_error, tolerance);
}

/// Against a run that solves in every step. @p stable: no line passes its critical shape. One that does moves away from the
/// other run exponentially: then the two are compared in the time at equal strain too.
void check_run(Report &report, const std::string &name, const Entries &entries, const Outcome &o,
               const double tolerance, const bool stable)
{
  const Outcome every = run_with_all_solves(entries);
  note_interpolation_error(report, name, every);
  const Difference d = difference(o.history, every.history);
  if (stable)
    report.below(name + ": change of the plastic strain at equal times", d.plastic_strain, tolerance);
  report.below(name + ": change of the curve of plastic strain over time", d.curve, tolerance);
  report.below(name + ": change of the load at equal times", d.load, tolerance);
  report.below(name + ": energy mismatch beyond that of the run that always solves",
               std::max(0.0, o.energy_mismatch - every.energy_mismatch), tolerance);
}

void check_pillar(Report &report, const std::string &contact)
{
  constexpr double tolerance = 1e-2;
  const Outcome o = run_grain(interpreted(pillar(contact), tolerance));
  check_errors(report, contact, o, tolerance, 0.5, 1.5);
  check_run(report, contact, pillar(contact), o, tolerance, true);
}

/// With the default tolerance. The estimate should be an upper bound on grains that it was not set on.
void check_others(Report &report)
{
  constexpr double tolerance = 1e-3;
  const Entries round = cylinder("4 1 7"), flat = film("2", "8 7 4", "4");
  const Outcome of_cylinder = run_grain(interpreted(round, tolerance)),
                of_film = run_grain(interpreted(flat, tolerance));
  check_errors(report, "cylinder", of_cylinder, tolerance, 0.5, 1);
  check_run(report, "cylinder", round, of_cylinder, tolerance, false);
  check_errors(report, "film", of_film, tolerance, 0.7, 1);
  check_run(report, "film", flat, of_film, tolerance, true);
}
} // namespace

int main(int argc, char **argv)
{
  const bool all = study_requested(argc, argv);
  return run(argc, argv,
             [&](Report &report)
             {
               if (all)
                 study(report, argc > 2 ? argv[2] : "");
               else
               {
                 for (const std::string contact : {"clamped", "frictionless"})
                   check_pillar(report, contact);
                 check_others(report);
               }
             });
}
