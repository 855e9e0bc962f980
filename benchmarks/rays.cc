// What virtual rays cost: their share of the forces on segments and of the tractions, by the number of lines that end at the surface.
//
//   ddfem_rays_benchmark [SURFACE_NODES ...]        (100 300 1000 unless given)
//
// Pillar of 500 x 500 x 1500 nm, 6 x 6 x 18 quadratic elements; straight lines from side to side in ten segments each, at random
// places and directions. Wall times in seconds with and without the rays, each the shorter one of two; the difference is what rays cost.
#include "coupling/dislocation_tractions.h"
#include "dd/forces/nodal_forces.h"
#include "dd/geometry/grain_shape.h"
#include "dd/microstructure/sources.h"
#include "fem/elastic_problem.h"
#include "fem/mesh.h"

#include <deal.II/base/mpi.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <random>
#include <vector>

using namespace ddfem;

namespace
{
constexpr double width = 500, height = 1500; // nm
const IsotropicMedium medium{48e3, 0.34, 0.256};

Network threading_lines(const int n_surface_nodes)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> across(20, width - 20), along(100, height - 100);
  Network network;
  constexpr int n_segments = 10;
  for (int line = 0; line < n_surface_nodes / 2; ++line)
  {
    const double y = across(random), y_end = across(random), z = along(random);
    std::vector<Vec3> points;
    for (int k = 0; k <= n_segments; ++k)
      points.emplace_back(width * k / n_segments, y + (y_end - y) * k / n_segments, z);
    add_line(network, points, Vec3(0, 0.256, 0), {}, false, NodeConstraint::surface);
  }
  return network;
}

double seconds(const std::function<void()> &work)
{
  double shortest = 1e30;
  for (int repetition = 0; repetition < 2; ++repetition)
  {
    const auto start = std::chrono::steady_clock::now();
    work();
    shortest = std::min(shortest, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return shortest;
}

class Benchmark
{
public:
  Benchmark() : shape(Vec3::Zero(), Vec3(width, width, height))
  {
    fem::MeshParameters parameters;
    parameters.shape = fem::MeshParameters::Shape::box;
    parameters.size = {width, width, height};
    parameters.subdivisions = {6, 6, 18};
    mesh = fem::make_mesh(MPI_COMM_WORLD, parameters);
    fem::ElasticProblem::Parameters elasticity;
    elasticity.degree = 2;
    const std::array<bool, 3> all{true, true, true};
    problem = std::make_unique<fem::ElasticProblem>(*mesh, elasticity, fem::Moduli{medium.mu, medium.nu},
                                                    std::vector<fem::DisplacementCondition>{{4, all}, {5, all}});
  }

  void run(const int n_surface_nodes)
  {
    const Network network = threading_lines(n_surface_nodes);
    std::printf("%5d surface nodes, %5zu segments\n", n_surface_nodes, network.n_segments());
    print("forces on segments", [&](const GrainShape *rays) { forces(network, rays); });
    print("tractions", [&](const GrainShape *rays) { tractions(network, rays); });
    std::printf("  million pairs of source and point of the tractions: %.1f with rays, %.1f without\n",
                tractions(network, &shape), tractions(network, nullptr));
  }

private:
  /// @p rays: the shape of the grain, or null for no rays.
  static void forces(const Network &network, const GrainShape *rays)
  {
    ForceEnvironment environment;
    environment.shape = rays;
    compute_nodal_forces(network, {medium, medium.a, 1e-5}, environment, MPI_COMM_SELF);
  }

  double tractions(const Network &network, const GrainShape *rays)
  {
    const LineSystem lines(medium, network, rays, RayDirection::normal, nullptr, nullptr);
    return 1e-6 * static_cast<double>(problem->set_tractions(coupling::DislocationTractions(lines)).n_evaluations);
  }

  void print(const char *name, const std::function<void(const GrainShape *)> &work) const
  {
    const double with = seconds([&] { work(&shape); }), without = seconds([&] { work(nullptr); });
    std::printf("  %-20s %9.4f with rays, %9.4f without: share of the rays %5.1f %%\n", name, with, without,
                100 * (1 - without / with));
  }

  BoxShape shape;
  fem::TriangulationPointer mesh;
  std::unique_ptr<fem::ElasticProblem> problem;
};
} // namespace

int main(int argc, char **argv)
{
  const int threads = omp_get_max_threads();
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, static_cast<unsigned>(threads));
  omp_set_num_threads(threads);
  std::vector<int> counts{100, 300, 1000};
  if (argc > 1)
    counts.clear();
  for (int i = 1; i < argc; ++i)
    counts.push_back(static_cast<int>(std::strtol(argv[i], nullptr, 10)));
  Benchmark benchmark;
  for (const int n : counts)
    benchmark.run(n);
  return 0;
}
