// Error that the tolerance of the elastic solve leaves in the forces of the correction on the segments, beside the error of the
// mesh.
//
//   ddfem_solver_tolerance_benchmark [DEGREE [ELEMENTS]]
//
// Aluminium pillar, 500 x 500 x 1000 nm, ELEMENTS across, with four sources that bow out under a strain rate. The networks of the last eight steps are kept; then
// the last one is solved for, cold and started from the seven before it, at several tolerances, on the same mesh, and on one with half the
// element size. Forces are compared in the rms over the segments of the Peach-Koehler force of the correction.
#include "coupling/simulation.h"

#include <deal.II/base/mpi.h>
#include <omp.h>

#include <cstdio>
#include <cstdlib>
#include <deque>
#include <string>
#include <vector>

using namespace ddfem;
using namespace ddfem::coupling;

namespace
{
struct Snapshot
{
  Network network;
  double motion; ///< of the platen
};

Parameters pillar(const std::string &degree, const unsigned elements)
{
  const std::string n = std::to_string(elements);
  InputDeck deck;
  for (const std::string &s :
       {std::string("Crystal/Direction along x=1 2 -1"), std::string("Crystal/Direction along z=-1 3 5"),
        std::string("Domain/Origin=-2.5e-7 -2.5e-7 0"), std::string("Domain/Size=5e-7 5e-7 1e-6"),
        "Domain/Subdivisions=" + n + " " + n + " " + std::to_string(2 * elements), "Domain/Element degree=" + degree,
        std::string("Domain/Traction tolerance=1e-8"), std::string("Domain/Elastic tolerance=1e-10"),
        std::string("Microstructure/Frank-Read sources=1 1 1 / -1 0 1 / 0 0 5e-7 / 2e-7 / 90;"
                    "1 -1 1 / 1 1 0 / 1e-7 5e-8 3e-7 / 1.6e-7 / 60; 1 1 -1 / 0 1 1 / -1e-7 0 7e-7 / 1.8e-7 / 0;"
                    "-1 1 1 / 1 1 0 / 0 -1e-7 6e-7 / 2e-7 / 30"),
        std::string("Discretisation/Minimum segment=1e-8"), std::string("Discretisation/Maximum segment=3e-8"),
        std::string("Loading/Type=strain rate"), std::string("Loading/Strain rate=-5e6"),
        std::string("Time stepping/Initial step=1e-12"), std::string("Time stepping/Maximum steps=250"),
        std::string("Output/Frame interval=0")})
    deck.set_from_command_line(s);
  return interpret(deck);
}

std::deque<Snapshot> last_steps(const Parameters &parameters)
{
  std::deque<Snapshot> steps;
  Simulation simulation(parameters, MPI_COMM_WORLD);
  simulation.observe_correction(
      [&](FiniteGrain &, const LineSystem &)
      {
        steps.push_back({simulation.network(), simulation.grain_solution().motion});
        if (steps.size() > 8)
          steps.pop_front();
      });
  RunOutput silent("", false);
  simulation.run(silent);
  return steps;
}

struct Solved
{
  SegmentField field;
  fem::SolveInfo info;
};

Solved solve(Parameters parameters, const std::deque<Snapshot> &steps, const double tolerance, const bool warm)
{
  parameters.grain.elasticity.relative_tolerance = tolerance;
  FiniteGrain grain(parameters.grain, parameters.medium, MPI_COMM_WORLD);
  Solved result;
  const OpenLines open = open_lines(steps.front().network, &grain.shape(), parameters.grain.ray_direction);
  for (std::size_t k = warm ? 0 : steps.size() - 1; k < steps.size(); ++k)
  {
    LineSystem lines(parameters.medium, steps[k].network, &grain.shape(), parameters.grain.ray_direction, nullptr,
                     nullptr);
    lines.close(open);
    result.info = grain.solve(lines, steps[k].motion).solve;
  }
  result.field = grain.correction_at_segments(steps.back().network);
  return result;
}

double difference(const Network &network, const SegmentField &a, const SegmentField &b)
{
  std::vector<SymTensor> d = a.stress;
  for (std::size_t k = 0; k < d.size(); ++k)
    d[k] -= b.stress[k];
  return force_norm(network, a.points, d) / force_norm(network, b.points, b.stress);
}

/// rms over the points of the difference of the stresses, over that of the stress.
double stress_difference(const SegmentField &a, const SegmentField &b)
{
  double sum = 0, scale = 0;
  for (std::size_t k = 0; k < a.stress.size(); ++k)
  {
    sum += (a.stress[k] - b.stress[k]).squaredNorm();
    scale += b.stress[k].squaredNorm();
  }
  return std::sqrt(sum / scale);
}
} // namespace

int main(int argc, char **argv)
{
  const int threads = omp_get_max_threads();
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, static_cast<unsigned>(threads));
  const std::string degree = argc > 1 ? argv[1] : "2";
  const auto elements = static_cast<unsigned>(argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 6);
  const Parameters parameters = pillar(degree, elements);
  const auto steps = last_steps(parameters);
  const Network &network = steps.back().network;
  const Solved exact = solve(parameters, steps, 1e-12, false);
  std::printf("degree %s, %zu segments, force of the correction %.4g MPa (rms)\n", degree.c_str(), network.n_segments(),
              force_norm(network, exact.field.points, exact.field.stress));
  std::printf("| tolerance | cold: iterations | stress | force | warm: iterations | stress | force "
              "|\n|---|---|---|---|---|---|---|\n");
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8})
  {
    const Solved cold = solve(parameters, steps, tolerance, false), warm = solve(parameters, steps, tolerance, true);
    std::printf("| %.0e | %u | %.1e | %.1e | %u | %.1e | %.1e |\n", tolerance, cold.info.iterations,
                stress_difference(cold.field, exact.field), difference(network, cold.field, exact.field),
                warm.info.iterations, stress_difference(warm.field, exact.field),
                difference(network, warm.field, exact.field));
  }
  // Where the images begin depends on the element size, and with it where the points lie.
  Parameters same_points = pillar(degree, 2 * elements);
  same_points.grain.image_depth = 2 * parameters.grain.image_depth;
  const Solved refined = solve(same_points, steps, 1e-10, false);
  std::printf("half the element size: stress %.1e, force %.1e\n", stress_difference(exact.field, refined.field),
              difference(network, exact.field, refined.field));
  return 0;
}
