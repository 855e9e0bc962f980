#include "coupling/finite_grain.h"
#include "dd/microstructure/sources.h"
#include "dd/topology/growth.h"
#include "dd/topology/motion.h"
#include "dd/topology/remesh.h"

#include <gtest/gtest.h>

namespace ddfem::coupling
{
namespace
{
const IsotropicMedium medium{26.5e3, 0.345, 0.286};
const Vec3 box_size(150, 120, 300);

/// Triangles swept by a loop of Burgers vector @p b that grows on the plane of normal @p n until it has left the box.
SweptArea loop_that_has_left(const GrainShape &shape, const Vec3 &n, const Vec3 &b)
{
  Network network;
  const Vec3 centre = 0.5 * box_size;
  const PlaneIndex plane = network.planes().find_or_insert({0, 0, 0}, n, centre);
  const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
  std::vector<Vec3> points;
  for (int k = 0; k < 12; ++k)
    points.push_back(centre + 20 * (std::cos(M_PI * k / 6) * u + std::sin(M_PI * k / 6) * v));
  add_line(network, points, b, plane, true, NodeConstraint::free);
  SweptArea swept = grown_area(network, &shape, RayDirection::normal);
  TopologyCounts counts;
  const TopologySettings settings{6, 15, 0.3, 0.7};
  for (int step = 0; step < 400 && network.n_segments() > 0; ++step)
  {
    TopologyContext c{network,
                      settings,
                      &shape,
                      RayDirection::normal,
                      [](Network &, const Vec3 &, const Vec3 &, const Vec3 &, std::span<const Vec3>)
                      { return PlaneIndex{}; },
                      swept,
                      counts,
                      std::vector<Vec3>(network.node_capacity(), Vec3::Zero())};
    for (const NodeIndex i : network.nodes())
      c.remaining[i.value] = 2 * (network.position(i) - centre).normalized();
    move_nodes(c, 1.0);
    remesh(c);
  }
  EXPECT_EQ(network.n_nodes(), 0U);
  return swept;
}

TEST(FullSlip, LoopThatHasLeftUnloadsTheBarByOneBurgersVectorAndLeavesNoStress)
{
  GrainParameters p;
  p.mesh.size = {box_size[0], box_size[1], box_size[2]};
  p.mesh.subdivisions = {3, 3, 6};
  p.clamped = false;
  p.reference = ReferenceState::perfect_crystal;
  FiniteGrain grain(p, medium, MPI_COMM_WORLD);
  const Vec3 n = Vec3(0.4, 0.2, 1).normalized(), b = 0.286 * Vec3(1, 0, -0.4).normalized();
  const Network nothing;
  const LineSystem no_lines(medium, nothing, &grain.shape(), RayDirection::normal, nullptr, nullptr);
  grain.set_reference(nothing, no_lines);
  const SweptArea swept = loop_that_has_left(grain.shape(), n, b);
  grain.add_swept(swept);
  const GrainSolution solution = grain.solve(no_lines, 0.0);
  // Reciprocity: F = - E strain_zz S with the mean plastic strain; the whole section has slipped by b.
  const double exact = medium.youngs_modulus() * b[2] * box_size[0] * box_size[1] / box_size[2];
  EXPECT_NEAR(solution.platen_reaction / exact, 1, 1e-3);
  EXPECT_NEAR(solution.fixed_reaction / solution.platen_reaction, 1, 1e-6);
  // The stress is the uniform one of the force: nothing of the loop is left.
  for (const SymTensor &s : grain.correction_stress({Vec3(30, 40, 150), Vec3(75, 60, 160), Vec3(120, 20, 260)}))
  {
    SymTensor uniform = SymTensor::Zero();
    uniform[2] = solution.platen_reaction / grain.section();
    EXPECT_NEAR((s - uniform).norm() / std::abs(uniform[2]), 0, 2e-3);
  }
}
} // namespace
} // namespace ddfem::coupling
