// Integrators at the same error in plastic strain: simulated time per second of processor time.
//
//   grow SEGMENTS LIMIT FILE             30 Frank-Read sources of copper in a periodic cell of 15 micrometres until there are so many
//                                        segments (or LIMIT ns have passed); goes on from FILE if it exists, and writes it
//   run FILE DURATION                    for each line "INTEGRATOR;TOLERANCE;MAX DISPLACEMENT;NEAR DISTANCE;SECONDS" of the standard input (nm), a run of
//                                        DURATION ns from the network of the file, given up after so many seconds; the first one is the reference of
//                                        the plastic strain
// FILE "source": one source in an infinite body.
//   orders                               error of a bowing source after steps of equal size, by integrator
#include "dd/io/paradis_data.h"
#include "dd/microstructure/sources.h"
#include "dd/mobility/linear_glide.h"
#include "samples/dislocation_driver.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <random>
#include <sstream>
#include <string>

namespace ddfem
{
namespace
{
// The published case: copper, cell, segments, tolerance and drag.
constexpr double burgers = 0.255; // nm
constexpr double edge = 15000;    // nm, the middle one
/// Slightly orthorhombic: a slip plane that leaves the cell does not come back onto itself, so that loops do not annihilate with their own images.
const PeriodicCell cell{Vec3::Zero(), edge *Vec3(0.95, 1, 1.06)};
constexpr double min_segment = 76.5, max_segment = 510;  // nm
constexpr double drag = 1.56e-2;                         // MPa ns
constexpr double stress = 60;                            // MPa, along [001]
const IsotropicMedium copper{54600, 0.324, 6 * burgers}; // MPa, nm
const SlipSystems fcc(Lattice::fcc, burgers *std::numbers::sqrt2);

DriverSettings settings_for(const IntegratorKind kind, const double tolerance, const double max_displacement,
                            const double near_distance)
{
  TopologySettings topology{min_segment, max_segment, 0.01 * min_segment * min_segment, 2.55};
  topology.max_area = 0.2 * max_segment * max_segment;
  DriverSettings s{copper, copper.a, linear_glide(drag, drag), topology, {}};
  s.integrator.error_tolerance = tolerance;
  s.integrator.max_displacement = max_displacement;
  s.integrator.max_step = 1;
  s.integrator.initial_step = 0.03;
  s.integrator.max_stages = 100;
  s.pair_tolerance = 1e-4;
  s.summation.multipole_from = 500;
  s.method = kind;
  s.near_distance = near_distance;
  return s;
}

SymTensor applied_stress()
{
  SymTensor t = SymTensor::Zero();
  t[2] = stress;
  return t;
}

void add_sources(Network &network, const int n)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < n; ++k)
  {
    const SlipSystem &s = fcc[static_cast<std::size_t>(12 * uniform(random))];
    FrankReadSource source;
    source.plane = s.plane_miller;
    source.burgers = s.burgers;
    source.centre = cell.lengths.cwiseProduct(Vec3(uniform(random), uniform(random), uniform(random)));
    source.length = 2000 + 2000 * uniform(random);
    source.character_angle = 180 * uniform(random);
    add_frank_read_source(network, Orientation{}, source, 0.75 * max_segment);
  }
}

/// Processor time, which other programs on the machine do not change much.
double seconds_since(const std::clock_t begin)
{
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

Network read(const std::string &file)
{
  Network network;
  if (file != "source")
    return read_paradis_data(file, {burgers, Orientation{}, true, true}).network;
  FrankReadSource source;
  source.plane = fcc[0].plane_miller;
  source.burgers = fcc[0].burgers;
  source.length = 3000;
  add_frank_read_source(network, Orientation{}, source, 0.75 * max_segment);
  return network;
}

int grow(const std::size_t n_segments, const double limit, const std::string &file)
{
  DislocationDriver d(settings_for(IntegratorKind::subcycling, 2.55, 150, 300), fcc, &cell);
  d.applied = applied_stress();
  const auto begin = std::clock();
  if (std::FILE *const known = std::fopen(file.c_str(), "r"))
  {
    std::fclose(known);
    d.network = read(file);
  }
  else
    add_sources(d.network, 30);
  for (int k = 0; d.network.n_segments() < n_segments && d.time < limit; ++k)
  {
    const IntegratorStep step = d.step(1);
    if (k % 20 == 0)
    {
      std::printf("%8.3f ns  dt %.2e  %6zu segments  %zu collisions %zu splits  near %.1f refined %zu rejected %u "
                  "error %.2f parts %zu speed %.0f  %.0f s "
                  "(topology %.0f)\n",
                  d.time, step.dt, d.network.n_segments(), d.counts.collisions, d.counts.splits, step.near_evaluations,
                  step.refined_nodes, step.rejected, step.error, step.parts.size(), step.max_speed,
                  seconds_since(begin), d.topology_seconds);
      std::fflush(stdout);
      write_paradis_data(file, d.network, burgers, Vec3::Zero(), cell.lengths);
    }
  }
  d.network.clean();
  write_paradis_data(file, d.network, burgers, Vec3::Zero(), cell.lengths);
  return 0;
}

struct Choice
{
  IntegratorKind kind;
  double tolerance, max_displacement, near_distance, seconds;
};

bool read_choice(Choice &c)
{
  std::string line, name;
  if (!std::getline(std::cin, line))
    return false;
  std::istringstream in(line);
  std::getline(in, name, ';');
  for (std::size_t k = 0; k < n_integrators; ++k)
    if (name == name_of(static_cast<IntegratorKind>(k)))
      c.kind = static_cast<IntegratorKind>(k);
  char separator = 0;
  in >> c.tolerance >> separator >> c.max_displacement >> separator >> c.near_distance >> separator >> c.seconds;
  return static_cast<bool>(in);
}

int run(const std::string &file, const double duration)
{
  const Network initial = read(file);
  std::printf("%s: %zu segments, %g ns\n%-18s %9s %9s %9s %7s %7s %7s %7s %6s %10s %9s %9s %9s %s\n", file.c_str(),
              initial.n_segments(), duration, "integrator", "tol/nm", "disp/nm", "near/nm", "steps", "reject", "evals",
              "near ev", "refin", "mean dt/ns", "cpu s", "ns/s", "topology", "simulated ns, plastic strain, error");
  SymTensor reference = SymTensor::Zero();
  Choice c{};
  for (bool first = true; read_choice(c); first = false)
  {
    DislocationDriver d(settings_for(c.kind, c.tolerance, c.max_displacement, c.near_distance), fcc,
                        file == "source" ? nullptr : &cell);
    d.network = initial;
    d.applied = applied_stress();
    const auto begin = std::clock();
    std::size_t steps = 0, rejected = 0, evaluations = 0;
    double near_evaluations = 0, refined = 0;
    while (d.time < duration * (1 - 1e-12) && seconds_since(begin) < c.seconds)
    {
      const IntegratorStep step = d.step(duration - d.time);
      ++steps;
      rejected += step.rejected;
      evaluations += step.evaluations;
      near_evaluations += step.near_evaluations;
      refined += static_cast<double>(step.refined_nodes) / static_cast<double>(d.network.n_nodes());
    }
    const double spent = seconds_since(begin);
    const SymTensor strain = d.strain_volume / cell.volume();
    if (first)
      reference = strain;
    std::printf("%-18s %9.3g %9.3g %9.3g %7zu %7zu %7zu %7.0f %5.1f%% %10.2e %9.2f %9.2e %8.1f%% %.4f, %.5e, %.2e  "
                "(%zu segments, "
                "%zu collisions, %zu splits)\n",
                name_of(c.kind), c.tolerance, c.max_displacement, c.near_distance, steps, rejected, evaluations,
                near_evaluations, 100 * refined / static_cast<double>(steps), d.time / static_cast<double>(steps),
                spent, d.time / spent, 100 * d.topology_seconds / spent, d.time, to_matrix(strain).norm(),
                to_matrix(strain - reference).norm() / to_matrix(reference).norm(), d.network.n_segments(),
                d.counts.collisions, d.counts.splits);
    std::fflush(stdout);
  }
  return 0;
}
/// Positions of the nodes of the source, fine and finely divided, after @p n equal steps.
std::vector<Vec3> bowed(const IntegratorKind kind, const double duration, const int n)
{
  DriverSettings settings = settings_for(kind, 1e9, 1e9, 100);
  settings.pair_tolerance = 1e-10;
  settings.summation.method = SummationMethod::direct;
  DislocationDriver d(settings, fcc);
  d.network = read("source");
  d.applied = applied_stress();
  for (int k = 0; k < n; ++k)
  {
    d.integrator->set_suggested_step(duration / n);
    const IntegratorStep step = d.integrate(2 * duration);
    if (step.dt < 0.999 * duration / n)
      return {}; // not stable
    for (const NodeIndex i : d.network.nodes())
      d.network.set_position(i, d.network.position(i) + step.displacement[i.value]);
  }
  std::vector<Vec3> x;
  for (const NodeIndex i : d.network.nodes())
    x.push_back(d.network.position(i));
  return x;
}

int orders()
{
  constexpr double duration = 2; // ns
  const std::vector<Vec3> exact = bowed(IntegratorKind::dormand_prince, duration, 8192);
  std::printf("# step [ns]; error [nm] of: ");
  for (std::size_t k = 0; k < n_integrators; ++k)
    std::printf("%s;", name_of(static_cast<IntegratorKind>(k)));
  std::printf("\n");
  for (int n = 2; n <= 4096; n *= 2)
  {
    std::printf("%g", duration / n);
    for (std::size_t k = 0; k < n_integrators; ++k)
    {
      const std::vector<Vec3> x = bowed(static_cast<IntegratorKind>(k), duration, n);
      double error = 0;
      for (std::size_t i = 0; i < x.size(); ++i)
        error = std::max(error, (x[i] - exact[i]).norm());
      std::printf(";%g", !x.empty() && error < 100 ? error : std::nan(""));
    }
    std::printf("\n");
    std::fflush(stdout);
  }
  return 0;
}
} // namespace
} // namespace ddfem

int main(int argc, char **argv)
{
  const std::string command = argc > 1 ? argv[1] : "";
  if (command == "grow" && argc == 5)
    return ddfem::grow(static_cast<std::size_t>(std::atol(argv[2])), std::atof(argv[3]), argv[4]);
  if (command == "run" && argc == 4)
    return ddfem::run(argv[2], std::atof(argv[3]));
  if (command == "orders")
    return ddfem::orders();
  std::fprintf(stderr, "usage: %s grow SEGMENTS LIMIT FILE | run FILE DURATION < choices | orders\n", argv[0]);
  return 2;
}
