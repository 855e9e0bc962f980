// Cost of the boundary-value problem in a step of a simulation, split into its parts, and the error that the tolerance of
// the solve leaves in the stress at the segments.
//
//   mpirun -np RANKS ddfem_correction_benchmark DEGREE ELEMENTS SEGMENTS [STEPS [TOLERANCE [SOLVER [DEPTH [SUM]]]]]
//
// Cube of 1 micrometre with ELEMENTS per edge, clamped at z- and z+, filled with circular glide loops of 20 segments and
// threading lines that end at the free faces, about SEGMENTS segments in all. Loops and lines move smoothly by about 0.5 nm
// a step. TOLERANCE: of the solves of the steps, 1e-5 unless given. SOLVER: multigrid (unless
// given) or direct. DEPTH: of the analytic images under the four free faces, in elements; 0 (unless given): no images. SUM: automatic
// (unless given: fast multipoles from 2000 lines or triangles) or direct. One line
// of output per quantity; times are wall times in seconds, medians over the steps after the first six.
#include "coupling/convert.h"
#include "coupling/dislocation_tractions.h"
#include "coupling/face_displacements.h"
#include "coupling/grain_geometry.h"
#include "coupling/image_planes.h"
#include "dd/common/parallel.h"
#include "dd/elasticity/vectorised/displacement_kernels.h"
#include "dd/forces/nodal_forces.h"
#include "dd/forces/segment_points.h"
#include "dd/forces/surface_images.h"
#include "dd/geometry/grain_shape.h"
#include "dd/microstructure/sources.h"
#include "dd/network/network.h"
#include "fem/elastic_problem.h"
#include "fem/mesh.h"

#include <deal.II/base/mpi.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

using namespace ddfem;

namespace
{
constexpr double edge = 1000;
const IsotropicMedium medium{48e3, 0.34, 0.256};

/// A circle or a line along x; moves as a whole on a small circle.
struct Piece
{
  Vec3 centre, normal;
  double radius; ///< of the loop; zero: a line along x through the whole grain
  double phase;
};

std::vector<Piece> random_pieces(const int n_segments)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Piece> pieces;
  constexpr int segments_per_piece = 20;
  for (int k = 0; k < n_segments / segments_per_piece; ++k)
  {
    const double radius = k % 5 == 0 ? 0 : 20 + 60 * uniform(random);
    const double room = radius + 10;
    const auto coordinate = [&] { return room + (edge - 2 * room) * uniform(random); };
    const Vec3 normal(uniform(random) - 0.5, uniform(random) - 0.5, uniform(random) - 0.5);
    const Vec3 centre(coordinate(), coordinate(), coordinate());
    pieces.push_back({centre, normal.normalized(), radius, 2 * std::numbers::pi * uniform(random)});
  }
  return pieces;
}

Network network_at(const std::vector<Piece> &pieces, const double step)
{
  Network network;
  const Vec3 b(0, 0.256, 0);
  for (const Piece &p : pieces)
  {
    const double angle = p.phase + 0.1 * step;
    const Vec3 centre = p.centre + 5 * Vec3(0, std::cos(angle), std::sin(angle));
    std::vector<Vec3> points;
    const Vec3 u = p.normal.unitOrthogonal(), v = p.normal.cross(u);
    for (int i = 0; i < 20; ++i)
      points.push_back(
          centre + p.radius * (std::cos(0.1 * std::numbers::pi * i) * u + std::sin(0.1 * std::numbers::pi * i) * v));
    if (p.radius > 0)
    {
      add_line(network, points, b, {}, true, NodeConstraint::free);
      continue;
    }
    points.clear();
    for (int i = 0; i <= 20; ++i)
      points.emplace_back(edge * i / 20, centre[1], centre[2]);
    add_line(network, points, b, {}, false, NodeConstraint::surface);
  }
  return network;
}

std::vector<dealii::Point<3>> gauss_points(const Network &network)
{
  std::vector<dealii::Point<3>> points;
  for (const SegmentIndex s : network.segments())
    for (const double fraction : {0.1127016653792583, 0.5, 0.8872983346207417})
    {
      const Vec3 x = network.position(network.start(s)) + fraction * network.direction(s);
      points.emplace_back(x[0], x[1], x[2]);
    }
  return points;
}

double difference(const std::vector<dealii::SymmetricTensor<2, 3>> &a,
                  const std::vector<dealii::SymmetricTensor<2, 3>> &b)
{
  double sum = 0, scale = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    sum += (a[i] - b[i]) * (a[i] - b[i]);
    scale += b[i] * b[i];
  }
  return std::sqrt(sum / scale);
}

class Benchmark
{
public:
  Benchmark(const unsigned degree, const unsigned elements, const int segments, const int n_steps,
            const double tolerance, const fem::Solver solver, const double image_depth, const SummationMethod method)
      : steps(n_steps), pieces(random_pieces(segments)), shape(Vec3::Zero(), Vec3::Constant(edge))
  {
    fem::MeshParameters parameters;
    parameters.shape = fem::MeshParameters::Shape::box;
    parameters.size = {edge, edge, edge};
    parameters.subdivisions = {elements, elements, elements};
    mesh = fem::make_mesh(MPI_COMM_WORLD, parameters);
    fem::ElasticProblem::Parameters elasticity;
    elasticity.degree = degree;
    elasticity.relative_tolerance = tolerance;
    elasticity.solver = solver;
    const std::array<bool, 3> all{true, true, true};
    problem = std::make_unique<fem::ElasticProblem>(*mesh, elasticity, fem::Moduli{medium.mu, medium.nu},
                                                    std::vector<fem::DisplacementCondition>{{4, all}, {5, all}});
    none.resize(problem->boundary_points().size());
    summation.method = method;
    if (image_depth > 0)
      planes = coupling::image_planes(coupling::boundary_polygons(*mesh), {4, 5});
    image_settings.depth = image_depth * edge / elements;
    resolution = 0.05 * edge / elements;
  }

  void run()
  {
    print("unknowns", static_cast<double>(problem->n_dofs()));
    print("set-up", problem->setup_seconds());
    for (int step = 0; step < steps; ++step)
      one_step(step);
    for (const auto &[name, values] : records)
      print(name, median(values));
    cold_solves();
  }

private:
  static constexpr int first_measured = 6;

  void measure(const std::string &name, const bool count, const std::function<void()> &work)
  {
    MPI_Barrier(MPI_COMM_WORLD);
    const auto start = std::chrono::steady_clock::now();
    work();
    MPI_Barrier(MPI_COMM_WORLD);
    if (count)
      records[name].push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }

  void one_step(const int step)
  {
    const bool count = step >= first_measured;
    const Network network = network_at(pieces, step);
    const LineSystem lines(medium, network, &shape, RayDirection::normal, nullptr, nullptr);
    points = gauss_points(network);
    if (count)
      prescribed_displacement(network_at(pieces, step - 1), network);
    if (!planes.empty())
      measure("images, displacement at the boundary included", count, [&] { update_images(lines); });
    fem::TractionSummary summary;
    fem::SolveInfo info;
    measure("tractions", count,
            [&] {
              summary =
                  problem->set_tractions(coupling::DislocationTractions(lines, &images, summation, MPI_COMM_WORLD));
            });
    measure("warm solve", count, [&] { info = problem->solve(none); });
    measure("stress at segments, recovery included", count, [&] { problem->stress_at(points); });
    measure("stress at segments, again", count, [&] { problem->stress_at(points); });
    if (!count)
      return;
    if (!planes.empty())
      measure("stress of images at segments", count, [&] { stress_of_images(network); });
    measure("segment forces", count, [&] { segment_forces(network); });
    records["segments"].push_back(static_cast<double>(network.n_segments()));
    records["rays"].push_back(static_cast<double>(lines.rays().size()));
    records["pairs of source and point"].push_back(static_cast<double>(summary.n_evaluations));
    records["images"].push_back(static_cast<double>(images.n_images()));
    records["imbalance of forces"].push_back(summary.force.norm() / summary.absolute_force);
    records["warm iterations"].push_back(info.iterations);
    records["residual at the start"].push_back(info.initial_residual);
  }

  std::vector<Vec3> boundary_points() const { return coupling::to_vectors(problem->boundary_points()); }

  void update_images(const LineSystem &lines)
  {
    images = SurfaceImages(lines, planes, image_settings);
    const coupling::ImageDisplacement field(images, 2, resolution, summation);
    field.at(boundary_points());
    problem->project_on_conditions(field);
  }

  /// At the points that FiniteGrain::correction_at_segments takes.
  void stress_of_images(const Network &network) const
  {
    const SegmentPoints dense(network, coupling::smooth_length_under(planes, image_settings.depth, medium.a));
    coupling::stress_of_images(images, dense.positions(), summation, MPI_COMM_WORLD);
  }

  /// What FiniteGrain::add_swept does: two triangles per segment, of the motion in a step.
  void prescribed_displacement(const Network &before, const Network &after)
  {
    SweptArea area;
    for (const SegmentIndex s : before.segments())
    {
      const Vec3 &p = before.position(before.start(s)), &q = before.position(before.end(s));
      const Vec3 &p_new = after.position(after.start(s)), &q_new = after.position(after.end(s));
      area.add_triangle(p, p_new, q, before.burgers(s), before.plane(s));
      area.add_triangle(q, p_new, q_new, before.burgers(s), before.plane(s));
    }
    const coupling::SweptLoops loops(area);
    const coupling::SweptSummation how{summation, MPI_COMM_WORLD};
    measure("displacement by swept area on the boundary", true,
            [&] { coupling::swept_displacement(medium.nu, loops, boundary_points(), how); });
    measure("its projection on the held faces", true,
            [&] {
              problem->project_on_conditions(
                  coupling::SweptDisplacement(loops, medium.nu, 2, 1e3 * edge, resolution, how));
            });
  }

  void segment_forces(const Network &network) const
  {
    ForceSettings settings;
    settings.medium = medium;
    settings.core_cutoff_radius = medium.a;
    settings.summation = summation;
    ForceEnvironment environment;
    environment.shape = &shape;
    compute_nodal_forces(network, settings, environment, MPI_COMM_WORLD);
  }

  /// Cold references, and the error of the stress at segments for several tolerances. With the loads of the last step.
  void cold_solves()
  {
    const auto warm = problem->stress_at(points);
    solve_cold(1e-12);
    const auto exact = problem->stress_at(points);
    print("error of the stress at segments, warm", difference(warm, exact));
    for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8})
    {
      const fem::SolveInfo info = solve_cold(tolerance);
      char name[80];
      std::snprintf(name, sizeof name, "cold to %.0e: seconds, iterations, error of stress", tolerance);
      if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
        std::printf("%-50s %12.4g %4u %12.4g\n", name, info.seconds, info.iterations,
                    difference(problem->stress_at(points), exact));
      else
        problem->stress_at(points);
    }
  }

  fem::SolveInfo solve_cold(const double tolerance)
  {
    problem->set_start_vectors({});
    problem->set_relative_tolerance(tolerance);
    return problem->solve(none);
  }

  static double median(std::vector<double> values)
  {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
  }

  static void print(const std::string &name, const double value)
  {
    if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      std::printf("%-50s %12.4g\n", name.c_str(), value);
  }

  int steps;
  std::vector<Piece> pieces;
  BoxShape shape;
  fem::TriangulationPointer mesh;
  std::unique_ptr<fem::ElasticProblem> problem;
  std::vector<dealii::Tensor<1, 3>> none;
  std::vector<ImagePlane> planes;
  ImageSettings image_settings;
  SummationSettings summation;
  SurfaceImages images;
  double resolution; ///< of displacements on the held faces, nm
  std::vector<dealii::Point<3>> points;
  std::map<std::string, std::vector<double>> records;
};
} // namespace

int main(int argc, char **argv)
{
  if (argc < 4)
  {
    std::fprintf(stderr, "usage: %s DEGREE ELEMENTS SEGMENTS [STEPS [TOLERANCE [SOLVER [DEPTH [SUM]]]]]\n", argv[0]);
    return 2;
  }
  const int threads = omp_get_max_threads();
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, static_cast<unsigned>(threads));
  omp_set_num_threads(threads);
  const auto number = [&](const int i) { return static_cast<unsigned>(std::strtoul(argv[i], nullptr, 10)); };
  Benchmark(number(1), number(2), static_cast<int>(number(3)), argc > 4 ? static_cast<int>(number(4)) : 15,
            argc > 5 ? std::strtod(argv[5], nullptr) : 1e-5,
            argc > 6 && std::string(argv[6]) == "direct" ? fem::Solver::direct : fem::Solver::multigrid,
            argc > 7 ? std::strtod(argv[7], nullptr) : 0.0,
            argc > 8 && std::string(argv[8]) == "direct" ? SummationMethod::direct : SummationMethod::automatic)
      .run();
  return 0;
}
