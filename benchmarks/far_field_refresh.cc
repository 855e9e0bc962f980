// When the far field is computed again: time and error of the forces in the two cases of Durocher (thesis, Bordeaux 2018,
// tables IV.3 and IV.4), by mode.
//
//   far_field_refresh SIZE STEPS EVALUATIONS TOLERANCE PAIR_TOLERANCE
//
// The network moves STEPS steps, each in EVALUATIONS equal parts with an evaluation of the forces after each, as the stages of
// an integrator do. All modes see the same positions.
#include "benchmarks/networks.h"
#include "benchmarks/processor_time.h"
#include "dd/crystal/material.h"
#include "dd/forces/far_field_cache.h"
#include "dd/forces/multipole_forces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <vector>

namespace
{
using namespace ddfem;

struct Case
{
  const char *name;
  IsotropicMedium medium;
  MovingNetwork moving;
  std::optional<PeriodicCell> cell;
  std::unique_ptr<PeriodicImages> images;
};

Case make_case(const char *name, const Material &m, MovingNetwork moving, const bool periodic)
{
  Case c{name, {m.mu, m.nu, m.burgers_magnitude}, std::move(moving), {}, nullptr};
  if (periodic)
  {
    c.cell = PeriodicCell{Vec3::Zero(), Vec3::Constant(c.moving.width)};
    c.images = std::make_unique<PeriodicImages>(c.cell->origin, c.cell->lengths);
  }
  return c;
}

/// One mode and what was measured.
struct Run
{
  const char *name;
  std::optional<FarFieldCache> cache; ///< none: the reference
  double time = 0;
  double square = 0, largest = 0; ///< of the error of the forces, relative to their rms
  double mean_error_of_far = 0;   ///< relative to the rms of the forces of distant boxes
  std::vector<Vec3> forces;       ///< on segments, two for each, MPa nm^2
};

std::array<Run, 5> all_modes()
{
  const auto cache = [](FarFieldRefresh mode) { return std::optional<FarFieldCache>(RefreshSettings{mode}); };
  return {
      {{"every evaluation", {}, 0, 0, 0, 0, {}},
       {"every step", std::optional<FarFieldCache>(RefreshSettings{FarFieldRefresh::every_n_steps, 1}), 0, 0, 0, 0, {}},
       {"adaptive", cache(FarFieldRefresh::adaptive), 0, 0, 0, 0, {}},
       {"every 20 steps", cache(FarFieldRefresh::every_n_steps), 0, 0, 0, 0, {}},
       {"never", cache(FarFieldRefresh::never), 0, 0, 0, 0, {}}}};
}

void evaluate(Case &c, const fmm::MultipoleSettings &settings, const double pair_tolerance, Run &run)
{
  const double start = seconds();
  const LineSystem system(c.medium, c.moving.network, nullptr, RayDirection::normal, c.cell ? &*c.cell : nullptr,
                          c.images.get(), run.cache ? ImageSources::set_by_user : ImageSources::set_at_once);
  const MultipoleForces forces = run.cache ? MultipoleForces(system, settings, pair_tolerance, MPI_COMM_SELF,
                                                             *run.cache, c.moving.network, c.images.get())
                                           : MultipoleForces(system, settings, pair_tolerance, MPI_COMM_SELF);
  run.forces.resize(2 * system.lines().size());
#pragma omp parallel for schedule(dynamic, 64)
  for (std::size_t i = 0; i < system.lines().size(); ++i)
  {
    const SegmentForces f = forces(i);
    run.forces[2 * i] = f.start;
    run.forces[2 * i + 1] = f.end;
  }
  run.time += seconds() - start;
}

double distance(const std::vector<Vec3> &a, const std::vector<Vec3> &b)
{
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum);
}

void measure(Case &c, const int n_steps, const int n_evaluations, const fmm::MultipoleSettings &settings,
             const double pair_tolerance)
{
  std::array<Run, 5> runs = all_modes();
  Network &network = c.moving.network;
  const int n = n_steps * n_evaluations;
  for (int k = 0; k < n; ++k)
  {
    for (Run &run : runs)
    {
      if (run.cache && k % n_evaluations == 0)
        run.cache->begin_step();
      evaluate(c, settings, pair_tolerance, run);
    }
    const std::vector<Vec3> &exact = runs.front().forces;
    const double total = distance(exact, std::vector<Vec3>(exact.size(), Vec3::Zero()));
    const double far = distance(exact, runs.back().forces);
    for (Run &run : runs)
    {
      const double e = distance(run.forces, exact);
      run.square += e * e / (total * total * n);
      run.largest = std::max(run.largest, e / total);
      run.mean_error_of_far += e / far / n;
    }
    for (const NodeIndex i : network.nodes())
      network.set_position(i, network.position(i) + c.moving.displacement[i.value] / n_evaluations);
  }
  std::printf("%s, %zu segments, %d steps of %d evaluations, tolerance %g\n%-18s %12s %12s %12s %12s %22s\n", c.name,
              network.n_segments(), n_steps, n_evaluations, settings.tolerance, "far field", "s per step", "rms error",
              "largest rms", "of far field", "refreshed/kept/without");
  for (const Run &run : runs)
  {
    const FarFieldCache::Counts counts = run.cache ? run.cache->counts() : FarFieldCache::Counts{};
    std::printf("%-18s %12.3f %12.2e %12.2e %12.2e %10u/%u/%u\n", run.name, run.time / n_steps, std::sqrt(run.square),
                run.largest, run.mean_error_of_far, counts.refreshed, counts.kept, counts.without);
  }
  std::fflush(stdout);
}
} // namespace

int main(int argc, char **argv)
{
  if (argc != 6)
  {
    std::fprintf(stderr, "usage: %s SIZE STEPS EVALUATIONS TOLERANCE PAIR_TOLERANCE\n", argv[0]);
    return 2;
  }
  const double size = std::atof(argv[1]), pair_tolerance = std::atof(argv[5]);
  fmm::MultipoleSettings settings;
  settings.tolerance = std::atof(argv[4]);
  Case sources = make_case("Frank-Read", find_material("aluminium"), frank_read_sources(size), true);
  measure(sources, std::atoi(argv[2]), std::atoi(argv[3]), settings, pair_tolerance);
  Case loops = make_case("loops", find_material("zirconium"), small_loops(size), false);
  measure(loops, std::atoi(argv[2]), std::atoi(argv[3]), settings, pair_tolerance);
  return 0;
}
