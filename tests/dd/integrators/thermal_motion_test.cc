// Lines in a heat bath: equipartition and diffusion.
#include "dd/microstructure/sources.h"
#include "dd/mobility/linear_glide.h"
#include "samples/statistics.h"
#include "samples/thermal_run.h"
#include "tests/support/one_thread.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>

namespace ddfem
{
namespace
{
const IsotropicMedium iron{82e3, 0.29, 0.25};
constexpr double kT = boltzmann_constant * 300;
constexpr double drag_edge = 0.1, drag_screw = 0.3; ///< MPa ns
const MobilityPointer law = linear_glide(drag_edge, drag_screw);

/// Edge line of 80 nm between pins.
Network pinned_edge(const int pieces)
{
  Network n;
  const PlaneIndex plane = n.planes().find_or_insert({0, 0, 1}, Vec3::UnitZ(), Vec3(Vec3::Zero()));
  std::vector<Vec3> points;
  for (int k = 0; k <= pieces; ++k)
    points.emplace_back(0, 80.0 * k / pieces, 0);
  add_line(n, points, Vec3(0.25, 0, 0), plane, false, NodeConstraint::pinned);
  return n;
}

TEST(ThermalMotion, ModesOfAPinnedLineHaveHalfKtEachAtThreeDiscretisations)
{
  const OneThread guard;
  // Nodes that move across the chord of their neighbours migrate along the line in time, proportional to the square of the
  // amplitudes. At 3 K they stay where they are, and the modes are those of the beginning.
  constexpr double cold = boltzmann_constant * 3;
  for (const int pieces : {4, 8, 16})
  {
    const auto force = samples::core_forces(iron, 0.02);
    samples::ThermalRun run(pinned_edge(pieces), force, law, {cold, 5, 0});
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(
        samples::stiffness_of_line(run.network, force, Vec3::UnitX()));
    const double rate = samples::largest_rate(run);
    const int steps = 60000;
    std::vector<std::vector<double>> energy(static_cast<std::size_t>(pieces - 1));
    for (int k = 0; k < steps; ++k)
    {
      run.step(rate);
      Eigen::VectorXd x(pieces - 1);
      for (Eigen::Index i = 0; i < pieces - 1; ++i)
        x[i] = run.network.position(NodeIndex{static_cast<std::uint32_t>(i + 1)})[0];
      const Eigen::VectorXd amplitude = modes.eigenvectors().transpose() * x;
      for (Eigen::Index i = 0; i < pieces - 1; ++i)
        energy[static_cast<std::size_t>(i)].push_back(modes.eigenvalues()[i] * amplitude[i] * amplitude[i] / cold);
    }
    for (std::size_t i = 0; i < energy.size(); ++i)
    {
      // The step may raise the stiffest mode by 1.3 %.
      const Estimate e = estimate_by_blocks(energy[i], 50);
      EXPECT_NEAR(e.mean, 1, 4 * e.error + 0.013) << "mode " << i << " of " << energy.size();
      EXPECT_LT(e.error, 0.04);
    }
  }
}

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

TEST(ThermalMotion, PrismaticLoopIsARandomWalkerAlongItsBurgersVector)
{
  const OneThread guard;
  const Network loop = samples::prismatic_loop(4, 0);
  double perimeter = 0;
  for (const SegmentIndex s : loop.segments())
  {
    EXPECT_TRUE(loop.plane(s).is_valid());
    perimeter += loop.length(s);
  }
  EXPECT_EQ(loop.n_segments(), 12U);
  const double diffusivity = kT / (drag_edge * perimeter);
  const auto force = samples::elastic_forces(iron, 0.1);
  const double rate = samples::largest_rate({loop, force, law, {kT, 0, 0}});
  std::vector<double> squares, positions;
  for (std::uint64_t run_number = 0; run_number < 200; ++run_number)
  {
    samples::ThermalRun run(loop, force, law, {kT, run_number, 0});
    double time = 0;
    while (time < 30 / rate * (1 - 1e-12))
      time += run.step(rate, 30 / rate - time).dt;
    const double z = mean_height(run.network);
    positions.push_back(z / std::sqrt(2 * diffusivity * time));
    squares.push_back(z * z / (2 * diffusivity * time));
    for (const NodeIndex i : run.network.nodes()) // on its glide cylinder
    {
      EXPECT_NEAR((run.network.position(i) - loop.position(i)).head<2>().norm(), 0, 1e-9);
    }
  }
  // Of squares of a normal variable the mean of 200 has the standard error sqrt(2/200).
  EXPECT_NEAR(estimate(squares).mean, 1, 4 * std::sqrt(2.0 / 200));
  EXPECT_NEAR(estimate(positions).mean, 0, 4 / std::sqrt(200.0));
}

TEST(ThermalMotion, TrajectoryIsTheSameOnAnyNumberOfThreads)
{
  std::vector<std::uint64_t> checksums;
  const int before = omp_get_max_threads();
  for (const int threads : {1, 2, 3})
  {
    omp_set_num_threads(threads);
    samples::ThermalRun run(samples::prismatic_loop(4, 0), samples::elastic_forces(iron, 0.1), law, {kT, 3, 0});
    for (int k = 0; k < 5; ++k)
      run.step(1e4);
    checksums.push_back(run.network.checksum());
  }
  omp_set_num_threads(before);
  EXPECT_EQ(checksums[0], checksums[1]);
  EXPECT_EQ(checksums[0], checksums[2]);
}
} // namespace
} // namespace ddfem
