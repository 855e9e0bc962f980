// Thermal motion measured against what statistical mechanics predicts: random walk of a prismatic loop, drift of a loop under a free
// surface, equipartition of a pinned line.
//
// Usage: ddfem_thermal_benchmark walk|drift|modes. Prints tables; columns in nm, ns, MPa.
#include "dd/common/random.h"
#include "dd/microstructure/sources.h"
#include "dd/mobility/linear_glide.h"
#include "samples/statistics.h"
#include "samples/thermal_run.h"

#include <Eigen/Eigenvalues>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

namespace
{
using namespace ddfem;

constexpr IsotropicMedium iron{86.8e3, 0.28, 0.248};
constexpr double kT = boltzmann_constant * 300;
constexpr double drag_edge = 0.1;
const MobilityPointer law = linear_glide(drag_edge, drag_edge); // 1e-4 Pa s
constexpr double core_cutoff = 0.1;
constexpr int n_runs = 200;

double perimeter(const Network &n)
{
  double sum = 0;
  for (const SegmentIndex s : n.segments())
    sum += n.length(s);
  return sum;
}

/// Mean of z over the line, weighted with the drag of the nodes.
double mean_height(const Network &n)
{
  double sum = 0, drag = 0;
  for (const NodeIndex i : n.nodes())
  {
    const double d = nodal_drag(n, i, *law);
    sum += d * n.position(i)[2];
    drag += d;
  }
  return sum / drag;
}

/// Heights of 200 loops, each with noise of its own, at multiples of @p interval; heights[k][run].
std::vector<std::vector<double>> heights_of_loops(const Network &loop, const samples::ThermalRun::Force &force,
                                                  const double interval, const int n_times)
{
  const double rate = samples::largest_rate({loop, force, law, {kT, 0, 0}});
  std::vector<std::vector<double>> heights(static_cast<std::size_t>(n_times), std::vector<double>(n_runs));
#pragma omp parallel for schedule(dynamic)
  for (int r = 0; r < n_runs; ++r)
  {
    samples::ThermalRun run(loop, force, law, {kT, static_cast<std::uint64_t>(r), 0});
    double time = 0;
    for (int k = 0; k < n_times; ++k)
    {
      const double end = (k + 1) * interval;
      while (end - time > 1e-12 * end)
        time += run.step(rate, end - time).dt;
      heights[static_cast<std::size_t>(k)][static_cast<std::size_t>(r)] = mean_height(run.network);
    }
  }
  return heights;
}

/// Mean square displacement of loops in an infinite body over 2 D t, D = kT/(B perimeter).
void measure_walk()
{
  for (const double radius : {3.0, 6.0})
  {
    const Network loop = samples::prismatic_loop(radius, 0);
    const double diffusivity = kT / (drag_edge * perimeter(loop)), interval = 0.02;
    const auto heights = heights_of_loops(loop, samples::elastic_forces(iron, core_cutoff, 1e-4), interval, 10);
    std::printf("loop of radius %g nm, perimeter %.3f nm, D = kT/(B perimeter) = %.4f nm^2/ns, %d runs\n"
                "  t [ns]   <z^2> [nm^2]   2 D t [nm^2]   ratio   standard error\n",
                radius, perimeter(loop), diffusivity, n_runs);
    for (std::size_t k = 0; k < heights.size(); ++k)
    {
      const double time = static_cast<double>(k + 1) * interval;
      std::vector<double> squares;
      for (const double z : heights[k])
        squares.push_back(z * z);
      const Estimate e = estimate(squares);
      std::printf("%8.3f %14.5f %14.5f %7.3f %16.3f\n", time, e.mean, 2 * diffusivity * time,
                  e.mean / (2 * diffusivity * time), e.error / (2 * diffusivity * time));
    }
  }
}

/// Force towards the surface of a circular loop at depth d, MPa nm^2 (Bastecka, Czech. J. Phys. B 14 (1964) 430).
double image_force(const double radius, const double b, const double depth)
{
  constexpr int n = 4000;
  const double largest = 20 / depth, step = largest / n;
  double sum = 0;
  for (int i = 1; i < n; ++i)
  {
    const double k = i * step, bessel = std::cyl_bessel_j(1.0, k * radius);
    sum += (i % 2 == 1 ? 4 : 2) * k * k * k * std::exp(-2 * k * depth) * bessel * bessel;
  }
  return 2 * std::numbers::pi * iron.mu * b * b * radius * radius * depth * depth / (1 - iron.nu) * sum * step / 3;
}

/// Mean height of loops under a free surface z = 0, started at a depth, against mean heights of random walkers in the image force, which
/// are averaged over many more runs.
void measure_drift()
{
  constexpr double radius = 4, depth = 24, interval = 0.05;
  constexpr int n_times = 8;
  const Network loop = samples::prismatic_loop(radius, depth);
  const double b = loop.burgers(loop.segments()[0]).norm(), length = perimeter(loop);
  // The circle of the polygon's area 12 tan(15 degrees) r^2.
  const double circle = radius * std::sqrt(12 * std::tan(std::numbers::pi / 12) / std::numbers::pi);
  const auto force = samples::elastic_forces_under_surface(iron, core_cutoff, {0, Vec3::Zero(), -Vec3::UnitZ()});
  double total = 0;
  for (const Vec3 &f : force(loop))
    total -= f[2];
  const double expected = image_force(circle, b, depth);
  std::printf(
      "loop of radius %g nm at depth %g nm: image force %.4f MPa nm^2, closed form for the circle of its area %.4f\n",
      radius, depth, total, expected);
  const auto heights = heights_of_loops(loop, force, interval, n_times);
  // The same drift and diffusion for a point.
  constexpr int n_walkers = 20000;
  std::vector<double> walkers(n_walkers, depth);
  std::printf("  t [ns]  <z> - d [nm]  predicted [nm]  without noise [nm]  standard error [nm]  variance/(2 D t)\n");
  double still = depth;
  const double drag = drag_edge * length, diffusivity = kT / drag, dt = interval / 50;
  for (int k = 0; k < n_times; ++k)
  {
    for (int m = 0; m < 50; ++m)
    {
      still -= image_force(circle, b, still) / drag * dt;
#pragma omp parallel for
      for (int w = 0; w < n_walkers; ++w)
      {
        double &z = walkers[static_cast<std::size_t>(w)];
        // d^4 times the force varies little: no integral for each walker.
        const double f = expected * std::pow(depth / z, 4);
        const CounterRandom random(99, static_cast<ObjectId>(w), static_cast<std::uint64_t>(50 * k + m),
                                   RandomPurpose::thermal_force);
        z += -f / drag * dt + std::sqrt(2 * diffusivity * dt) * random.normal_pair()[0];
      }
    }
    std::vector<double> moved;
    for (const double z : heights[static_cast<std::size_t>(k)])
      moved.push_back(z - depth);
    const Estimate measured = estimate(moved), predicted = estimate(walkers);
    const double time = (k + 1) * interval;
    std::printf("%8.2f %13.4f %15.4f %19.4f %20.4f %17.3f\n", time, measured.mean, predicted.mean - depth,
                still - depth, measured.error, measured.error * measured.error * n_runs / (2 * diffusivity * time));
  }
}

/// Mean energies of the modes of a pinned line at three discretisations.
void measure_modes(const std::string &kind)
{
  constexpr double cold = boltzmann_constant * 3; // so that nodes do not migrate along the line
  for (const int pieces : {8, 16, 32})
  {
    Network line;
    const PlaneIndex plane = line.planes().find_or_insert({0, 0, 1}, Vec3::UnitZ(), Vec3(Vec3::Zero()));
    std::vector<Vec3> points;
    for (int k = 0; k <= pieces; ++k)
      points.emplace_back(0, 80.0 * k / pieces, 0);
    add_line(line, points, Vec3(0.248, 0, 0), plane, false, NodeConstraint::pinned);
    const auto force =
        kind == "elastic" ? samples::elastic_forces(iron, core_cutoff) : samples::core_forces(iron, 0.02);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(samples::stiffness_of_line(line, force, Vec3::UnitX()));
    const double rate = samples::largest_rate({line, force, law, {cold, 0, 0}});
    const auto n = static_cast<Eigen::Index>(pieces - 1);
    // Slowest mode: its correlation lasts 1/lambda, a sample of its energy is independent after as long.
    const double slowest = modes.eigenvalues()[0] / modes.eigenvalues()[n - 1];
    constexpr double wanted = 16000;
    const int chains = 64, steps = std::max(8000, static_cast<int>(wanted / chains / (3.6 * slowest)));
    std::vector<std::vector<double>> energies(static_cast<std::size_t>(n),
                                              std::vector<double>(static_cast<std::size_t>(chains)));
#pragma omp parallel for schedule(dynamic)
    for (int c = 0; c < chains; ++c)
    {
      samples::ThermalRun run(line, force, law, {cold, static_cast<std::uint64_t>(c), 0});
      const int warm_up = static_cast<int>(2 / (3.6 * slowest));
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(n), x(n);
      for (int k = 0; k < warm_up + steps; ++k)
      {
        run.step(rate);
        for (Eigen::Index i = 0; i < n; ++i)
          x[i] = run.network.position(NodeIndex{static_cast<std::uint32_t>(i + 1)})[0];
        if (k >= warm_up)
          sum += (modes.eigenvectors().transpose() * x).cwiseAbs2();
      }
      for (Eigen::Index i = 0; i < n; ++i)
        energies[static_cast<std::size_t>(i)][static_cast<std::size_t>(c)] =
            modes.eigenvalues()[i] * sum[i] / steps / cold;
    }
    std::vector<double> of_line(static_cast<std::size_t>(chains), 0.0);
    std::printf("%s forces, %d segments, %d x %d steps: K <a^2>/kT of the modes, slowest first (standard error)\n",
                kind.c_str(), pieces, chains, steps);
    double farthest = 0;
    for (const auto &mode : energies)
    {
      const Estimate e = estimate(mode);
      std::printf(" %.3f(%.3f)", e.mean, e.error);
      farthest = std::max(farthest, std::abs(e.mean - 1));
      for (std::size_t c = 0; c < of_line.size(); ++c)
        of_line[c] += mode[c] / static_cast<double>(n);
    }
    const Estimate all = estimate(of_line);
    std::printf("\n  mean over the modes %.4f +- %.4f, farthest from 1: %.4f\n", all.mean, all.error, farthest);
    std::fflush(stdout);
  }
}
} // namespace

int main(int argc, char **argv)
{
  const std::string what = argc == 2 ? argv[1] : "";
  if (what == "walk")
    measure_walk();
  else if (what == "drift")
    measure_drift();
  else if (what == "modes")
    for (const char *kind : {"core", "elastic"})
      measure_modes(kind);
  else
  {
    std::fprintf(stderr, "usage: %s walk|drift|modes\n", argv[0]);
    return 2;
  }
  return 0;
}
