#include "dd/microstructure/sources.h"
#include "dd/mobility/linear_glide.h"
#include "dd/mobility/thermal_force.h"
#include "dd/topology/line_operations.h"
#include "tests/dd/topology/topology_fixture.h"
#include "tests/support/one_thread.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ddfem
{
namespace
{
const LinearGlide law{0.02, 0.01};
constexpr double dt = 0.125, kT = 4.1;

/// A closed line with arms of different lengths and characters.
TopologyFixture uneven_loop()
{
  TopologyFixture f;
  add_line(f.network, {{0, 0, 0}, {30, 0, 0}, {50, 20, 0}, {20, 70, 0}, {-10, 30, 0}}, Vec3(0.25, 0, 0), f.horizontal(),
           true, NodeConstraint::free);
  return f;
}

std::vector<Vec3> forces(const Network &n, const std::uint64_t step, const std::uint64_t seed = 9)
{
  return thermal_forces(
      n,
      [&](const SegmentIndex s) {
        return drag_of_arms(n, {&s, 1}, law);
      },
      {kT, seed, step}, dt);
}

TEST(ThermalForce, BoltzmannConstantIsThatOfTheSi)
{
  // 1.380649e-23 J/K; 1 J = 1e-6 MPa 1e27 nm^3. At 300 K it is 1/38.68 eV, as every table says.
  constexpr double electronvolt = 1.602176634e-19 * 1e21;
  EXPECT_NEAR(boltzmann_constant * 300 / electronvolt, 0.025852, 1e-6);
}

TEST(ThermalForce, CovarianceIsTwiceKtTimesDragOverTheStep)
{
  const OneThread guard;
  const TopologyFixture f = uneven_loop();
  const Network &n = f.network;
  constexpr unsigned samples = 20000;
  Eigen::Matrix<double, 15, 15> covariance = Eigen::Matrix<double, 15, 15>::Zero();
  for (unsigned step = 0; step < samples; ++step)
  {
    const std::vector<Vec3> r = forces(n, step);
    Eigen::Matrix<double, 15, 1> all;
    for (Eigen::Index i = 0; i < 5; ++i)
      all.segment<3>(3 * i) = r[static_cast<std::size_t>(i)];
    covariance += all * all.transpose() / samples;
  }
  // In units of the expected deviations; of an element the estimator has the deviation 1/sqrt(samples), on the diagonal sqrt(2)
  // times that.
  const double sigma = 1 / std::sqrt(double(samples));
  for (Eigen::Index i = 0; i < 15; ++i)
    for (Eigen::Index k = 0; k < 15; ++k)
    {
      const auto drag = [&](const Eigen::Index c)
      { return nodal_drag(n, NodeIndex{static_cast<std::uint32_t>(c / 3)}, law); };
      const double unit = 2 * kT / dt * std::sqrt(drag(i) * drag(k));
      EXPECT_NEAR(covariance(i, k) / unit, i == k ? 1 : 0, (i == k ? 4 * std::sqrt(2) : 4) * sigma) << i << " " << k;
    }
}

TEST(ThermalForce, LineOfManySegmentsFeelsTheForceThatItFeelsWithFew)
{
  // The force on the whole line, which moves it as a whole, has the variance 2 kT B L / dt however the line is divided.
  const OneThread guard;
  TopologyFixture f = uneven_loop();
  TopologyContext context = f.context();
  constexpr unsigned samples = 4000;
  for (const bool divided : {false, true})
  {
    if (divided)
      for (const SegmentIndex s : std::vector<SegmentIndex>(f.network.segments().begin(), f.network.segments().end()))
        split_segment(context, s, f.network.position(f.network.start(s)) + 0.3 * f.network.direction(s), Vec3::Zero());
    double drag = 0, variance = 0;
    for (const NodeIndex i : f.network.nodes())
      drag += nodal_drag(f.network, i, law);
    for (unsigned step = 0; step < samples; ++step)
    {
      Vec3 sum = Vec3::Zero();
      for (const Vec3 &r : forces(f.network, step))
        sum += r;
      variance += sum.squaredNorm() / (3 * samples);
    }
    EXPECT_NEAR(variance / (2 * kT * drag / dt), 1, 4 * std::sqrt(2.0 / (3 * samples))) << divided;
  }
}

TEST(ThermalForce, DependsOnPersistentIdsSeedAndStepOnly)
{
  TopologyFixture f = uneven_loop();
  const std::vector<Vec3> r = forces(f.network, 3);
  EXPECT_EQ(r[2], forces(f.network, 3)[2]);
  EXPECT_NE(r[2], forces(f.network, 4)[2]);
  EXPECT_NE(r[2], forces(f.network, 3, 10)[2]);
  const ObjectId id = f.network.id(NodeIndex{2});
  f.network.clean();
  const std::vector<Vec3> renumbered = forces(f.network, 3);
  EXPECT_NEAR((renumbered[f.network.find_node(id)->value] - r[2]).norm(), 0, 1e-12 * r[2].norm());
}
} // namespace
} // namespace ddfem
