// Ten thousand random draws of loops in random grains, each moved until all have left or 200 steps have passed: after every step
// all invariants hold, no node is outside, surface nodes lie on the surface, and what has been swept is bounded by the old and
// the new lines. Every second draw begins where faces meet. Arguments: number of draws, first seed.
#include "tests/dd/topology/surface_loops.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  const long n_draws = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 10000;
  const long first = argc > 2 ? std::strtol(argv[2], nullptr, 10) : 0;
  struct Sum
  {
    std::size_t draws = 0, left = 0, failed = 0, steps = 0, exits = 0, collisions = 0;
  };
  std::map<std::string, Sum> sums;
  std::size_t failed = 0;
  for (long seed = first; seed < first + n_draws; ++seed)
  {
    const auto placement =
        seed / ddfem::n_grain_kinds % 2 == 0 ? ddfem::Placement::anywhere : ddfem::Placement::at_edges;
    const ddfem::DrawResult r = ddfem::run_draw(static_cast<std::uint64_t>(seed), 200, placement);
    for (const std::string &name : {r.description, std::string("all")})
    {
      Sum &sum = sums[name];
      ++sum.draws;
      sum.left += r.left ? 1 : 0;
      sum.failed += r.failure.empty() ? 0 : 1;
      sum.steps += r.steps;
      sum.exits += r.counts.surface_exits;
      sum.collisions += r.counts.collisions;
    }
    if (!r.failure.empty() && ++failed <= 40)
      std::printf("%s\n", r.failure.substr(0, 400).c_str());
    std::fflush(stdout);
  }
  for (const auto &[name, sum] : sums)
    std::printf("%-45s %6zu draws, %6zu left, %4zu failed, %8zu steps, %7zu exits, %7zu collisions\n", name.c_str(),
                sum.draws, sum.left, sum.failed, sum.steps, sum.exits, sum.collisions);
  MPI_Finalize();
  return failed == 0 ? 0 : 1;
}
