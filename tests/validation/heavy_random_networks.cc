// Random networks of 1e4 and 1e5 segments, moved 200 steps at random with every operation (node splitting, which tries
// hundreds of configurations for each crossing, every 25 or 100 steps), in a periodic cell and in a grain: all invariants hold after
// each step. Prints what happened and the time per segment and step.
#include "tests/dd/topology/random_networks.h"

#include <chrono>
#include <cstdio>
#include <exception>

namespace
{
void run(const std::size_t n_segments, const ddfem::Body body, const char *name)
{
  const auto begin = std::chrono::steady_clock::now();
  ddfem::RandomNetwork f(n_segments, 1e-4, body);
  f.splitting_interval = n_segments > 50000 ? 100 : 25;
  std::size_t segment_steps = 0, refused = 0, exhausted = 0;
  for (std::uint64_t k = 0; k < 200; ++k)
  {
    segment_steps += f.network.n_segments();
    f.step(k); // throws if an invariant is violated
    refused += f.report.refused;
    exhausted += f.report.exhausted;
  }
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  const ddfem::CandidateStatistics &lists = f.candidates.statistics();
  std::printf(
      "%-9s %7zu segments at first, %7zu at last; %7zu collisions, %6zu annihilations, %7zu divided, %7zu joined, "
      "%6zu exits, %6zu splits, %6zu refused, %zu exhausted; lists built in %3zu of %3zu steps; %.2f us per segment "
      "and step\n",
      name, n_segments, f.network.n_segments(), f.counts.collisions, f.counts.annihilations, f.counts.refinements,
      f.counts.coarsenings, f.counts.surface_exits, f.counts.splits, refused, exhausted, lists.builds, lists.updates,
      1e6 * time.count() / static_cast<double>(segment_steps));
  std::fflush(stdout);
}
} // namespace

int main()
{
  try
  {
    for (const std::size_t n : {10000U, 100000U})
    {
      run(n, ddfem::Body::periodic, "periodic");
      run(n, ddfem::Body::box, "box");
      run(n, ddfem::Body::cylinder, "cylinder");
    }
  }
  catch (const std::exception &e)
  {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
