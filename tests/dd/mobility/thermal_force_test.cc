#include "dd/microstructure/sources.h"
#include "dd/mobility/linear_glide.h"
#include "dd/mobility/local_velocities.h"
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
const LinearGlide law({0.02, 0.01});
constexpr double dt = 0.125, kT = 4.1;

/// A closed line with arms of different lengths and characters.
TopologyFixture uneven_loop()
{
  TopologyFixture f;
  add_line(f.network, {{0, 0, 0}, {30, 0, 0}, {50, 20, 0}, {20, 70, 0}, {-10, 30, 0}}, Vec3(0.25, 0, 0), f.horizontal(),
           true, NodeConstraint::free);
  return f;
}

SegmentDrag drag_of(const Network &n, const double sliding = 1)
{
  return [&n, sliding](const SegmentIndex s)
  {
    const double across = n.length(s) * law.drag(line_state(n, s));
    return LineDrag{across, sliding * across};
  };
}

std::vector<Vec3> forces(const Network &n, const std::uint64_t step, const std::uint64_t seed = 9)
{
  return thermal_forces(n, drag_of(n), DragMatrix::lumped, {kT, seed, step}, dt);
}

using Matrix15 = Eigen::Matrix<double, 15, 15>;

/// The drag matrix of a network of five nodes.
Matrix15 drag_matrix(const Network &n, const DragMatrix form, const double sliding)
{
  Matrix15 a = Matrix15::Zero();
  for (const SegmentIndex s : n.segments())
  {
    const Vec3 t = n.direction(s).normalized();
    const LineDrag d = drag_of(n, sliding)(s);
    const Mat3 c = d.across * (Mat3::Identity() - t * t.transpose()) + d.along * t * t.transpose();
    const double same = form == DragMatrix::lumped ? 1.0 / 2 : 1.0 / 3,
                 other = form == DragMatrix::lumped ? 0 : 1.0 / 6;
    const auto i = static_cast<Eigen::Index>(3 * n.start(s).value), k = static_cast<Eigen::Index>(3 * n.end(s).value);
    a.block<3, 3>(i, i) += same * c;
    a.block<3, 3>(k, k) += same * c;
    a.block<3, 3>(i, k) += other * c;
    a.block<3, 3>(k, i) += other * c;
  }
  return a;
}

TEST(ThermalForce, BoltzmannConstantIsThatOfTheSi)
{
  // 1.380649e-23 J/K; 1 J = 1e-6 MPa 1e27 nm^3. At 300 K it is 1/38.68 eV, as every table says.
  constexpr double electronvolt = 1.602176634e-19 * 1e21;
  EXPECT_NEAR(boltzmann_constant * 300 / electronvolt, 0.025852, 1e-6);
}

TEST(ThermalForce, CovarianceIsTwiceKtTimesTheDragMatrixOverTheStep)
{
  const OneThread guard;
  const TopologyFixture f = uneven_loop();
  const Network &n = f.network;
  constexpr unsigned samples = 20000;
  for (const auto &[form, sliding] :
       {std::pair(DragMatrix::lumped, 1.0), {DragMatrix::lumped, 0.1}, {DragMatrix::consistent, 0.1}})
  {
    Matrix15 covariance = Matrix15::Zero();
    for (unsigned step = 0; step < samples; ++step)
    {
      const std::vector<Vec3> r = thermal_forces(n, drag_of(n, sliding), form, {kT, 9, step}, dt);
      Eigen::Matrix<double, 15, 1> all;
      for (Eigen::Index i = 0; i < 5; ++i)
        all.segment<3>(3 * i) = r[static_cast<std::size_t>(i)];
      covariance += all * all.transpose() / samples;
    }
    const Matrix15 expected = 2 * kT / dt * drag_matrix(n, form, sliding);
    // The mean of x_i x_k of normal variables has the variance (C_ii C_kk + C_ik^2)/samples. 360 elements: five deviations.
    for (Eigen::Index i = 0; i < 15; ++i)
      for (Eigen::Index k = 0; k <= i; ++k)
      {
        const double variance = expected(i, i) * expected(k, k) + expected(i, k) * expected(i, k);
        EXPECT_NEAR(covariance(i, k), expected(i, k), 5 * std::sqrt(variance / samples)) << i << " " << k;
      }
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
