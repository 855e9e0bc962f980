// Cost of finding collisions: lists of candidates, and exact detection on them.
#include "benchmarks/networks.h"
#include "dd/topology/collisions/candidate_list.h"
#include "dd/topology/collisions/contact.h"

#include <benchmark/benchmark.h>
#include <omp.h>

#include <chrono>
#include <ctime>

namespace
{
using namespace ddfem;

constexpr double capture_radius = 0.05;    // nm
constexpr double segments_per_unit = 50e3; // of irradiated_grain()

MovingSegment moving(const MovingNetwork &grain, SegmentIndex s)
{
  const Network &network = grain.network;
  const Vec3 &x = network.position(network.start(s));
  return {x, x + network.direction(s), grain.displacement[network.start(s).value],
          grain.displacement[network.end(s).value]};
}

std::size_t count_contacts(const MovingNetwork &grain, std::span<const CandidatePair> pairs)
{
  std::size_t found = 0;
#pragma omp parallel for schedule(static) reduction(+ : found)
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (first_contact(moving(grain, pairs[k].first), moving(grain, pairs[k].second), capture_radius, 0, 1))
      ++found;
  return found;
}

/// Time on the clock, and time of all cores together: the latter tells the same on a machine that is shared.
struct Stopwatch
{
  double wall = 0, core = 0; ///< s

  template <class F> void measure(F &&f)
  {
    const auto wall_start = std::chrono::steady_clock::now();
    const std::clock_t core_start = std::clock();
    f();
    core += static_cast<double>(std::clock() - core_start) / CLOCKS_PER_SEC;
    wall += std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
  }
};

void report(benchmark::State &state, double n_segments, double n_steps, double n_builds, const Stopwatch &build,
            const Stopwatch &keep, const Stopwatch &detect)
{
  const auto ns_each = [n_segments](double time, double count)
  { return count > 0 ? time * 1e9 / (n_segments * count) : 0.0; };
  state.SetIterationTime((build.wall + keep.wall + detect.wall) / n_steps);
  state.counters["segments"] = n_segments;
  state.counters["build_share"] = n_builds / n_steps;
  state.counters["build_ns"] = ns_each(build.core, n_builds);
  state.counters["keep_ns"] = ns_each(keep.core, n_steps - n_builds);
  state.counters["detect_ns"] = ns_each(detect.core, n_steps);
  state.counters["step_ns"] = ns_each(build.core + keep.core + detect.core, n_steps);
  state.counters["step_wall_ns"] = ns_each(build.wall + keep.wall + detect.wall, n_steps);
}

/// All work that a step has, after the skin has settled; nodes go on at constant velocity.
void detect_collisions(benchmark::State &state)
{
  omp_set_num_threads(static_cast<int>(state.range(1)));
  const int n_settling = 30, n_steps = state.range(0) < 1'000'000 ? 200 : 100;
  for ([[maybe_unused]] const auto unused : state)
  {
    MovingNetwork grain = irradiated_grain(static_cast<double>(state.range(0)) / segments_per_unit);
    Network &network = grain.network;
    CandidateList list;
    Stopwatch build, keep, detect;
    CandidateStatistics settled;
    std::size_t n_pairs = 0, n_contacts = 0;
    for (int step = -n_settling; step < n_steps; ++step)
    {
      if (step == 0)
      {
        build = keep = detect = {};
        settled = list.statistics();
        n_pairs = n_contacts = 0;
      }
      const std::size_t n_builds = list.statistics().builds;
      Stopwatch update;
      update.measure([&] { list.update(network, grain.displacement, capture_radius); });
      Stopwatch &kind = list.statistics().builds > n_builds ? build : keep;
      kind.wall += update.wall;
      kind.core += update.core;
      detect.measure([&] { n_contacts += count_contacts(grain, list.pairs()); });
      n_pairs += list.pairs().size();
      network.for_each_node([&](NodeIndex i)
                            { network.set_position(i, network.position(i) + grain.displacement[i.value]); });
    }
    const CandidateStatistics &end = list.statistics();
    const auto n = static_cast<double>(network.n_segments()),
               n_builds = static_cast<double>(end.builds - settled.builds);
    report(state, n, n_steps, n_builds, build, keep, detect);
    state.counters["pairs"] = static_cast<double>(n_pairs) / (n_steps * n);
    state.counters["pair_ns"] = n_pairs > 0 ? detect.core * 1e9 / static_cast<double>(n_pairs) : 0.0;
    state.counters["tests"] = static_cast<double>(end.sphere_tests - settled.sphere_tests) / (n_steps * n);
    state.counters["entered"] = static_cast<double>(end.insertions - settled.insertions) / (n_steps * n);
    state.counters["contacts"] = static_cast<double>(n_contacts) / n_steps;
    state.counters["skin_nm"] = end.skin;
  }
}

/// The same without lists that live on: everything is built in every step, with spheres that cover one step only.
void detect_collisions_anew(benchmark::State &state)
{
  const MovingNetwork grain = irradiated_grain(static_cast<double>(state.range(0)) / segments_per_unit);
  omp_set_num_threads(static_cast<int>(state.range(1)));
  Stopwatch build, detect;
  for ([[maybe_unused]] const auto unused : state)
  {
    const double start = build.wall + detect.wall;
    CandidateList list;
    build.measure([&] { list.update(grain.network, grain.displacement, capture_radius); });
    detect.measure([&] { benchmark::DoNotOptimize(count_contacts(grain, list.pairs())); });
    state.SetIterationTime(build.wall + detect.wall - start);
  }
  const double per = 1e9 / (static_cast<double>(grain.network.n_segments()) * static_cast<double>(state.iterations()));
  state.counters["segments"] = static_cast<double>(grain.network.n_segments());
  state.counters["build_ns"] = build.core * per;
  state.counters["detect_ns"] = detect.core * per;
  state.counters["step_ns"] = (build.core + detect.core) * per;
}

BENCHMARK(detect_collisions)
    ->ArgNames({"segments", "threads"})
    ->ArgsProduct({{10'000, 100'000, 1'000'000}, {1, 2}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();
BENCHMARK(detect_collisions_anew)
    ->ArgNames({"segments", "threads"})
    ->ArgsProduct({{10'000, 100'000, 1'000'000}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();
} // namespace
