// Errors of point stresses and nodal forces by the fast multipole method against direct sums, as rows of a table.
//
//   accuracy COST_FACTOR N_LOOPS [SEED]
#include "samples/multipole_errors.h"

#include <cstdio>
#include <cstdlib>

namespace
{
using namespace ddfem;
using namespace ddfem::samples;

std::vector<SampleLines> networks(const int n_loops, const unsigned seed)
{
  std::vector<SampleLines> all;
  // Fewer loops: all of their 27 images are summed directly.
  all.push_back(periodic_loops(n_loops / 2, Vec3(-500, -500, -500), Vec3(1000, 1000, 1000), 16, seed));
  all.push_back(clustered_loops(n_loops, seed));
  all.push_back(pillar(n_loops * 2 / 3, n_loops / 5, seed));
  all.push_back(long_line_among_loops(n_loops, seed));
  return all;
}

void print(const FieldError &e, const double tolerance)
{
  std::printf(" %.1e (%.1e) | %.1e (%.1e) | %.1f |", e.rms / e.far, e.largest / e.far, e.rms / e.total,
              e.largest / e.total, tolerance * e.far / e.rms);
}

void print_row(const double tolerance, const MultipoleErrors &e)
{
  std::printf("| %.0e | %d, %d |", tolerance, e.order, e.n_gauss);
  for (const FieldError &field : {e.stress, e.stress_on_lines, e.force})
    print(field, tolerance);
  std::printf(" %.1e |\n", e.force_error_of_stress / e.force.far);
  std::fflush(stdout);
}
} // namespace

int main(int argc, char **argv)
{
  if (argc < 3)
  {
    std::fprintf(stderr, "usage: %s COST_FACTOR N_LOOPS [SEED]\n", argv[0]);
    return 2;
  }
  const unsigned seed = argc > 3 ? static_cast<unsigned>(std::atoi(argv[3])) : 1;
  for (const SampleLines &lines : networks(std::atoi(argv[2]), seed))
  {
    const MultipoleErrorMeter meter(lines, 2000);
    std::printf(
        "\n%s, %zu segments\n\n"
        "| requested | order, Gauss points | stress: of far | of total | overshoot | stress on lines: of far | of "
        "total | overshoot | force: of far | of total | overshoot | of far, without quadrature |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        lines.name.c_str(), meter.n_lines());
    for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8})
      print_row(tolerance, meter.errors(tolerance, std::atof(argv[1])));
  }
  return 0;
}
