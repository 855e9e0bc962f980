// Nodal forces of a random network by the fast multipole method: processor time of the phases, and the error on sampled segments; the
// field at points, and the direct sum.
//
//   far_field TOLERANCE PAIR_TOLERANCE COST_FACTOR N_SAMPLES N_SEGMENTS...
#include "benchmarks/networks.h"
#include "benchmarks/processor_time.h"
#include "dd/elasticity/gauss.h"
#include "dd/forces/multipole_forces.h"
#include "samples/systems_of_lines.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sys/resource.h>

namespace
{
using namespace ddfem;

const IsotropicMedium medium{50e3, 0.34, 0.3};

Vec3 direct_force(const LineSystem &system, const std::size_t i)
{
  const StraightLine &l = system.lines()[i];
  Vec3 sum = Vec3::Zero();
  for (std::size_t j = 0; j < system.lines().size(); ++j)
    if (const StraightLine &s = system.lines()[j]; j != i)
    {
      const SegmentForces f = segment_force(medium, s.start, s.end, s.burgers, l.start, l.end, l.burgers, 1e-8);
      sum += f.start + f.end;
    }
  return sum;
}

/// Root mean square of the force of the far stress alone on a segment.
double far_force(const LineSystem &system, const MultipoleForces &forces, const double tolerance)
{
  const GaussRule rule = gauss_rule(forces.n_gauss_points());     // one panel on each segment: all are equally long
  MultipoleField field(system, forces.field().at(), {tolerance}); // with the points it has the tree of the forces
  const auto far = field.sum().stress(MPI_COMM_SELF, fmm::Part::far);
  double sum = 0;
  for (std::size_t i = 0; i < system.lines().size(); ++i)
  {
    const StraightLine &l = system.lines()[i];
    Vec3 force = Vec3::Zero();
    for (std::size_t q = 0; q < rule.points.size(); ++q)
      force += rule.weights[q] * contract(far[forces.first_point_of(i) + q], l.burgers).cross(l.end - l.start);
    sum += force.squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(system.lines().size()));
}

void print_errors(const LineSystem &system, const MultipoleForces &forces, const double tolerance,
                  const std::size_t n_samples)
{
  double error = 0, largest = 0, total = 0;
  for (std::size_t k = 0; k < n_samples; ++k)
  {
    const std::size_t i = k * system.lines().size() / n_samples;
    const SegmentForces f = forces(i);
    const Vec3 exact = direct_force(system, i);
    const double d = (f.start + f.end - exact).squaredNorm();
    error += d;
    largest = std::max(largest, d);
    total += exact.squaredNorm();
  }
  const auto n = static_cast<double>(n_samples);
  const double far = far_force(system, forces, tolerance), rms = std::sqrt(total / n);
  std::printf("  force error: rms %.2e, largest %.2e of the far force; rms %.2e, largest %.2e of the total\n",
              std::sqrt(error / n) / far, std::sqrt(largest) / far, std::sqrt(error / n) / rms,
              std::sqrt(largest) / rms);
}

/// Evaluations of a segment at a point, and translations between boxes.
std::array<double, 2> counts(const fmm::Octree &tree)
{
  double pairs = 0, translations = 0;
  for (std::size_t i = 0; i < tree.boxes().size(); ++i)
  {
    translations += static_cast<double>(tree.far_links(i).size());
    for (const fmm::NearLink &l : tree.near_links(i))
    {
      const fmm::Box &b = tree.boxes()[l.box];
      const std::size_t n_lines = (l.own_only ? b.own_lines_end : b.lines_end) - b.lines_begin;
      pairs += static_cast<double>(n_lines * tree.boxes()[i].n_points());
    }
  }
  return {pairs, translations};
}

/// All pairs in closed form by the vectorised kernels: what the expansions compete with.
void print_direct_sum(const LineSystem &system, const double pair_tolerance)
{
  std::vector<SegmentForces> result(system.lines().size());
  const LineTable &table = system.segment_table();
  const double start = seconds();
#pragma omp parallel for schedule(dynamic, 16)
  for (std::size_t i = 0; i < result.size(); ++i)
  {
    const StraightLine &l = system.lines()[i];
    result[i] = force_of_segments(medium, table, l.start, l.end, l.burgers, pair_tolerance, i);
  }
  std::printf("  direct sum %.4f s\n", seconds() - start);
}

/// The field of the segments at as many random points.
void print_field_at_points(const LineSystem &system, const double tolerance)
{
  const std::vector<Vec3> points = samples::points_among(system, system.lines().size());
  const double start = seconds();
  MultipoleField(system, points, {tolerance}).stress(MPI_COMM_SELF);
  const double time = seconds() - start;
  std::printf("  field at as many random points %.3f s, %.2f us per point\n", time,
              1e6 * time / static_cast<double>(points.size()));
}

void measure(const std::size_t n, const double tolerance, const double pair_tolerance, const double factor,
             const std::size_t n_samples)
{
  const Network network = random_loops(n);
  const LineSystem system(medium, network, nullptr, RayDirection::normal, nullptr, nullptr);
  const double start = seconds();
  const MultipoleForces forces(system, {tolerance, 0, factor}, pair_tolerance, MPI_COMM_SELF);
  const double end = seconds(), close = forces.spent().close_pairs;
  const fmm::MultipoleStress &sum = forces.field().sum();
  const fmm::PhaseTimes &t = sum.times();
  const double phases = t.upward + t.translations + t.downward + t.points + t.near;
  std::printf("%8zu segments, order %2d, %zu boxes on %zu levels: tree and rest %.3f, upward %.3f, translations %.3f, "
              "downward %.3f, "
              "far at points %.3f, near at points %.3f, close pairs %.3f s; total %.3f s, %.2f us per segment\n",
              n, sum.order(), sum.octree().boxes().size(), sum.octree().levels().size() - 1,
              end - start - phases - close, t.upward, t.translations, t.downward, t.points, t.near, close, end - start,
              1e6 * (end - start) / static_cast<double>(n));
  const auto [pairs, translations] = counts(sum.octree());
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("  %.1f ns per near pair (%.0f M), %.2f us per translation (%.0f k); largest memory so far %.0f bytes "
              "per segment\n",
              1e9 * t.near / pairs, 1e-6 * pairs, 1e6 * t.translations / translations, 1e-3 * translations,
              1024.0 * static_cast<double>(usage.ru_maxrss) / static_cast<double>(n));
  print_field_at_points(system, tolerance);
  if (constexpr std::size_t largest_direct = 20000; n <= largest_direct)
    print_direct_sum(system, pair_tolerance);
  if (n_samples > 0)
    print_errors(system, forces, tolerance, n_samples);
}
} // namespace

int main(int argc, char **argv)
{
  if (argc < 6)
  {
    std::fprintf(stderr, "usage: %s TOLERANCE PAIR_TOLERANCE COST_FACTOR N_SAMPLES N_SEGMENTS...\n", argv[0]);
    return 2;
  }
  for (int k = 5; k < argc; ++k)
    measure(std::strtoul(argv[k], nullptr, 10), std::atof(argv[1]), std::atof(argv[2]), std::atof(argv[3]),
            std::strtoul(argv[4], nullptr, 10));
  return 0;
}
