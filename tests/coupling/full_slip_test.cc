#include "coupling/finite_grain.h"
#include "loop_that_has_left.h"

#include <gtest/gtest.h>

namespace ddfem::coupling
{
namespace
{
const IsotropicMedium medium{26.5e3, 0.345, 0.286};
const Vec3 box_size(150, 120, 300);

class FullSlip : public testing::Test
{
protected:
  FullSlip()
  {
    GrainParameters p;
    p.mesh.size = {box_size[0], box_size[1], box_size[2]};
    p.mesh.subdivisions = {3, 3, 6};
    p.clamped = false;
    p.reference = ReferenceState::perfect_crystal;
    grain = std::make_unique<FiniteGrain>(p, medium, MPI_COMM_WORLD);
    grain->set_reference(network, lines());
    const SweptArea swept = test::loop_that_has_left(network, grain->shape(), n, b);
    grain->add_swept(swept);
    solution = grain->solve(lines(), 0.0);
  }
  LineSystem lines() const { return {medium, network, &grain->shape(), RayDirection::normal, nullptr, nullptr}; }

  const Vec3 n = Vec3(0.4, 0.2, 1).normalized(), b = 0.286 * Vec3(1, 0, -0.4).normalized();
  Network network;
  std::unique_ptr<FiniteGrain> grain;
  GrainSolution solution;
};

TEST_F(FullSlip, LoopThatHasLeftIsForgotten)
{
  EXPECT_EQ(network.n_nodes(), 0U);
  EXPECT_EQ(network.n_segments(), 0U);
  EXPECT_TRUE(lines().lines().empty());
  EXPECT_TRUE(lines().rays().empty());
}

TEST_F(FullSlip, UnloadsTheBarByOneBurgersVectorAndLeavesNoStress)
{
  // Reciprocity: F = - E strain_zz S with the mean plastic strain; the whole section has slipped by b.
  const double exact = medium.youngs_modulus() * b[2] * box_size[0] * box_size[1] / box_size[2];
  EXPECT_NEAR(solution.platen_reaction / exact, 1, 1e-3);
  EXPECT_NEAR(solution.fixed_reaction / solution.platen_reaction, 1, 1e-6);
  // The stress is the uniform one of the force: nothing of the loop is left.
  for (const SymTensor &s : grain->correction_stress({Vec3(30, 40, 150), Vec3(75, 60, 160), Vec3(120, 20, 260)}))
  {
    SymTensor uniform = SymTensor::Zero();
    uniform[2] = solution.platen_reaction / grain->section();
    EXPECT_NEAR((s - uniform).norm() / std::abs(uniform[2]), 0, 1e-3);
  }
}

TEST_F(FullSlip, WhateverPlaceAndPlaneAndBurgersVectorOnlyTheForceOfTheStepIsLeft)
{
  const double magnitude = 0.286;
  struct Slip
  {
    Vec3 centre, normal, burgers;
  };
  const std::vector<Slip> cases{
      {Vec3(30, 100, 90), Vec3(0.5, 0, 1), Vec3(1, 0, -0.5)},           // glide, off the middle, parallel to an edge
      {Vec3(20, 15, 180), Vec3(-0.2, 0.3, 1), Vec3(0.9, 0.6, 0)},       // begins in a corner, almost no force
      {Vec3(75, 60, 150), Vec3(0, 0, 1), Vec3(0, 0, 1)},                // prismatic: a layer less
      {Vec3(130, 60, 200), Vec3(0.1, -0.6, 1), Vec3(0.3, 0.5, 0.8)},    // neither in its plane nor normal to it
      {Vec3(75, 110, 110), Vec3(-0.4, -0.4, 1), Vec3(-0.7, -0.1, -0.6)} // the other way round
  };
  for (const Slip &slip : cases)
  {
    const Vec3 normal = slip.normal.normalized(), burgers = magnitude * slip.burgers.normalized();
    Network empty;
    grain->set_reference(empty, lines());
    grain->add_swept(test::loop_that_has_left(empty, grain->shape(), normal, burgers, slip.centre));
    ASSERT_EQ(empty.n_segments(), 0U);
    const GrainSolution after = grain->solve(lines(), 0.0);
    // The section seen along the axis is that of the bar, whatever the plane.
    const double unit = medium.youngs_modulus() * magnitude / box_size[2];
    SymTensor uniform = SymTensor::Zero();
    uniform[2] = unit * burgers[2] / magnitude;
    EXPECT_NEAR(after.platen_reaction / grain->section() / unit, uniform[2] / unit, 1e-3);
    for (const double x : {5.0, 75.0, 145.0})
      for (const double y : {5.0, 60.0, 115.0})
        for (const double z : {5.0, 90.0, 150.0, 210.0, 295.0})
          EXPECT_NEAR((grain->correction_stress({Vec3(x, y, z)})[0] - uniform).norm() / unit, 0, 1e-3);
  }
}

TEST_F(FullSlip, DisplacementOfTheSurfaceJumpsByTheBurgersVectorAcrossThePlane)
{
  // What is left besides the uniform strain of the platen force is two rigid blocks. Side towards which n points minus the
  // other: -b (FS/RH, see PolygonLoop).
  const double strain = solution.platen_reaction / grain->section() / medium.youngs_modulus();
  const auto nodes = grain->boundary_nodes(), u = grain->boundary_displacement();
  Vec3 sum[2] = {Vec3::Zero(), Vec3::Zero()};
  double count[2] = {0, 0};
  const auto side = [&](const Vec3 &x) { return n.dot(x - 0.5 * box_size) > 0 ? 1 : 0; };
  const auto rest = [&](const std::size_t k)
  { return Vec3(u[k] - strain * Vec3(-medium.nu * nodes[k][0], -medium.nu * nodes[k][1], nodes[k][2])); };
  for (std::size_t k = 0; k < nodes.size(); ++k)
  {
    sum[side(nodes[k])] += rest(k);
    count[side(nodes[k])] += 1;
  }
  MPI_Allreduce(MPI_IN_PLACE, sum[0].data(), 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  MPI_Allreduce(MPI_IN_PLACE, sum[1].data(), 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  MPI_Allreduce(MPI_IN_PLACE, count, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  const Vec3 mean[2] = {sum[0] / count[0], sum[1] / count[1]};
  EXPECT_NEAR((mean[1] - mean[0] + b).norm() / b.norm(), 0, 1e-3);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    EXPECT_NEAR((rest(k) - mean[side(nodes[k])]).norm() / b.norm(), 0, 1e-3);
}
} // namespace
} // namespace ddfem::coupling
