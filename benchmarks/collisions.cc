// Cost of finding collisions: lists of candidates, and exact detection on them.
#include "benchmarks/networks.h"
#include "dd/topology/collisions/candidate_list.h"
#include "dd/topology/collisions/contact.h"

#include <benchmark/benchmark.h>
#include <omp.h>

#include <chrono>

namespace
{
using namespace ddfem;

constexpr double capture_radius = 0.05;    // nm
constexpr double segments_per_unit = 50e3; // of irradiated_grain()
constexpr int n_settling = 50, n_steps = 200;

MovingSegment moving(const IrradiatedGrain &grain, SegmentIndex s)
{
  const Network &network = grain.network;
  const Vec3 &x = network.position(network.start(s));
  return {x, x + network.direction(s), grain.displacement[network.start(s).value],
          grain.displacement[network.end(s).value]};
}

std::size_t count_contacts(const IrradiatedGrain &grain, std::span<const CandidatePair> pairs)
{
  std::size_t found = 0;
#pragma omp parallel for schedule(static) reduction(+ : found)
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (first_contact(moving(grain, pairs[k].first), moving(grain, pairs[k].second), capture_radius, 0, 1))
      ++found;
  return found;
}

/// Seconds that @p f takes.
template <class F> double seconds(F &&f)
{
  const auto start = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Time of all work that a step has, after the skin has settled; nodes go on at constant velocity.
void detect_collisions(benchmark::State &state)
{
  const double t = static_cast<double>(state.range(0)) / segments_per_unit;
  omp_set_num_threads(static_cast<int>(state.range(1)));
  for ([[maybe_unused]] const auto unused : state)
  {
    IrradiatedGrain grain = irradiated_grain(t);
    Network &network = grain.network;
    CandidateList list;
    double build = 0, keep = 0, detect = 0;
    std::size_t n_builds = 0, n_pairs = 0, n_contacts = 0;
    CandidateStatistics settled;
    for (int step = -n_settling; step < n_steps; ++step)
    {
      if (step == 0)
        settled = list.statistics();
      const std::size_t builds = list.statistics().builds;
      const double update = seconds([&] { list.update(network, grain.displacement, capture_radius); });
      if (step >= 0)
      {
        const bool built = list.statistics().builds > builds;
        n_builds += built ? 1U : 0U;
        (built ? build : keep) += update;
        detect += seconds([&] { n_contacts += count_contacts(grain, list.pairs()); });
        n_pairs += list.pairs().size();
      }
      network.for_each_node([&](NodeIndex i)
                            { network.set_position(i, network.position(i) + grain.displacement[i.value]); });
    }
    const auto n = static_cast<double>(network.n_segments());
    const auto ns_each = [n](double time, double count) { return count > 0 ? time * 1e9 / (n * count) : 0.0; };
    const auto built = static_cast<double>(n_builds);
    state.SetIterationTime((build + keep + detect) / n_steps);
    state.counters["segments"] = n;
    state.counters["build_ns"] = ns_each(build, built);
    state.counters["keep_ns"] = ns_each(keep, n_steps - built);
    state.counters["detect_ns"] = ns_each(detect, n_steps);
    state.counters["pair_ns"] = n_pairs > 0 ? detect * 1e9 / static_cast<double>(n_pairs) : 0.0;
    state.counters["step_ns"] = ns_each(build + keep + detect, n_steps);
    state.counters["build_share"] = built / n_steps;
    state.counters["pairs"] = static_cast<double>(n_pairs) / n_steps / n;
    state.counters["tests"] =
        static_cast<double>(list.statistics().sphere_tests - settled.sphere_tests) / (n * std::max(built, 1.0));
    state.counters["entered"] = static_cast<double>(list.statistics().insertions - settled.insertions) / (n * n_steps);
    state.counters["contacts"] = static_cast<double>(n_contacts) / n_steps;
    state.counters["skin_nm"] = list.statistics().skin;
  }
}

/// As a step was found before: everything anew, with spheres that cover one step.
void detect_collisions_anew(benchmark::State &state)
{
  IrradiatedGrain grain = irradiated_grain(static_cast<double>(state.range(0)) / segments_per_unit);
  omp_set_num_threads(static_cast<int>(state.range(1)));
  double build = 0, detect = 0;
  for ([[maybe_unused]] const auto unused : state)
  {
    CandidateList list;
    const double b = seconds([&] { list.update(grain.network, grain.displacement, capture_radius); });
    const double d = seconds([&] { benchmark::DoNotOptimize(count_contacts(grain, list.pairs())); });
    build += b;
    detect += d;
    state.SetIterationTime(b + d);
  }
  const double per = 1e9 / static_cast<double>(grain.network.n_segments() * state.iterations());
  state.counters["segments"] = static_cast<double>(grain.network.n_segments());
  state.counters["build_ns"] = build * per;
  state.counters["detect_ns"] = detect * per;
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
