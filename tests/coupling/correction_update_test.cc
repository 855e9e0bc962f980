// Steps without an elastic solve.
#include "coupling/correction_update.h"
#include "coupling/simulation.h"
#include "dd/topology/growth.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ddfem::coupling
{
namespace
{
const IsotropicMedium medium{26.5e3, 0.345, 0.286};

GrainParameters pillar()
{
  GrainParameters p;
  p.mesh.size = {200, 200, 400};
  p.mesh.subdivisions = {4, 4, 8};
  p.elasticity.relative_tolerance = 1e-10;
  p.reference = ReferenceState::perfect_crystal;
  return p;
}

Network loop(const Vec3 &centre, const double radius)
{
  const Vec3 n = Vec3(0.4, -0.3, 1).normalized(), u = n.unitOrthogonal(), v = n.cross(u);
  std::vector<Vec3> points;
  for (int k = 0; k < 12; ++k)
    points.push_back(centre + radius * (std::cos(M_PI * k / 6) * u + std::sin(M_PI * k / 6) * v));
  Network network;
  add_line(network, points, 0.286 * Vec3(0.6, 0.2, 0.5).normalized(), {}, true, NodeConstraint::free);
  return network;
}

LineSystem lines_of(const Network &network, const FiniteGrain &grain)
{
  return {medium, network, &grain.shape(), RayDirection::normal, nullptr, nullptr};
}

TEST(CorrectionUpdate, LoadOfSweptAreaIsThatOfASolve)
{
  // Betti's theorem, exact for the continuum; elements of degree 2 with the loop two elements from everything err by some 1e-3.
  for (const bool clamped : {true, false})
  {
    GrainParameters parameters = pillar();
    parameters.clamped = clamped;
    FiniteGrain grain(parameters, medium, MPI_COMM_WORLD);
    const Network network = loop(Vec3(95, 104, 190), 30);
    const LineSystem lines = lines_of(network, grain);
    const SweptArea area = grown_area(network, &grain.shape(), RayDirection::normal);
    const double predicted = grain.load_of_swept_area(area);
    grain.set_reference(network, lines);
    const double solved = grain.solve_at_rest(lines).load_at_rest;
    EXPECT_NEAR(predicted / solved, 1, 3e-3) << clamped;
  }
}

TEST(CorrectionUpdate, LinesThatRestNeedNoSolve)
{
  FiniteGrain grain(pillar(), medium, MPI_COMM_WORLD);
  CorrectionUpdate update(grain, medium, 1e-6);
  const Network network = loop(Vec3(95, 104, 190), 30);
  const LineSystem lines = lines_of(network, grain);
  grain.set_reference(network, lines);
  GrainSolution first = update.solve_at_rest(lines, network);
  EXPECT_TRUE(first.solved);
  grain.move_platen(first, 0);
  const SegmentField solved = grain.correction_at_segments(network);
  update.set_scale(network, solved);
  GrainSolution second = update.solve_at_rest(lines, network);
  EXPECT_FALSE(second.solved);
  EXPECT_EQ(update.estimate(), 0);
  grain.move_platen(second, 0);
  EXPECT_NEAR(second.load, first.load, 1e-12 * std::abs(first.load));
  const SegmentField kept = grain.correction_at_segments(network);
  for (std::size_t k = 0; k < solved.stress.size(); ++k)
    EXPECT_LT((kept.stress[k] - solved.stress[k]).norm(), 1e-12 * solved.stress[k].norm());
  // After forget() the state is that of a run that begins here.
  update.forget();
  EXPECT_TRUE(update.solve_at_rest(lines, network).solved);
}

TEST(CorrectionUpdate, SourcesInOneCubeAreMergedInTheirCentre)
{
  ChangeSources sources(10);
  const Mat3 m = Vec3::UnitX() * Vec3::UnitZ().transpose();
  sources.add(Vec3(1, 1, 1), m);
  sources.add(Vec3(5, 1, 1), 3 * m);
  sources.add(Vec3(-1, 1, 1), m);
  const auto merged = sources.sources();
  ASSERT_EQ(merged.size(), 2u);
  EXPECT_EQ(merged[0].position, Vec3(-1, 1, 1));
  EXPECT_EQ(merged[1].position, Vec3(4, 1, 1));
  EXPECT_EQ(merged[1].moment, Mat3(4 * m));
}

TEST(CorrectionUpdate, ALoopThatGrowsSteadilyIsExtrapolated)
{
  // Area grows by the same amount in each step: what the last two solves saw, continued, is the correction up to the
  // curvature, and the estimate knows.
  FiniteGrain grain(pillar(), medium, MPI_COMM_WORLD);
  CorrectionUpdate update(grain, medium, 2e-3);
  const auto radius = [](const int step) { return std::sqrt(900. + 10 * step); };
  Network network = loop(Vec3(95, 104, 190), radius(0));
  grain.set_reference(network, lines_of(network, grain));
  unsigned skips = 0;
  for (int step = 0; step < 12; ++step)
  {
    Network next = loop(Vec3(95, 104, 190), radius(step));
    if (step > 0)
    {
      SweptArea area;
      for (const SegmentIndex s : network.segments())
      {
        // Both networks number their nodes in the same order.
        const Vec3 p = network.position(network.start(s)), q = network.position(network.end(s));
        const Vec3 p_new = next.position(network.start(s)), q_new = next.position(network.end(s));
        area.add_triangle(p_new, q_new, q, network.burgers(s), PlaneIndex{});
        area.add_triangle(p_new, q, p, network.burgers(s), PlaneIndex{});
      }
      grain.add_swept(area);
      update.add_swept(area);
    }
    network = next;
    const LineSystem lines = lines_of(network, grain);
    GrainSolution given = update.solve_at_rest(lines, network);
    grain.move_platen(given, 0);
    const SegmentField extrapolated = grain.correction_at_segments(network);
    update.set_scale(network, extrapolated);
    if (given.solved)
      continue;
    ++skips;
    const FiniteGrain::ElementState state = grain.element_state();
    const GrainSolution exact = grain.solve(lines, 0);
    std::vector<SymTensor> error = grain.correction_at_segments(network).stress;
    for (std::size_t k = 0; k < error.size(); ++k)
      error[k] -= extrapolated.stress[k];
    EXPECT_LT(force_norm(network, extrapolated.points, error), 2e-3 * update.force_scale()) << step;
    EXPECT_NEAR(given.load / exact.load, 1, 2e-3) << step;
    EXPECT_LT((given.platen_force + given.fixed_force).norm(), 1e-6 * given.platen_force.norm()) << step;
    grain.extrapolate_to(lines, state, given.load_at_rest, given);
  }
  EXPECT_GE(skips, 6u);
}
} // namespace
} // namespace ddfem::coupling
