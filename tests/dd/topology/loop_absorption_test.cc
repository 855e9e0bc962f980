// A line absorbs an irradiation loop (Durocher, thesis, Bordeaux 2018, section IV.1.2.4; after Serra & Bacon, Modelling Simul.
// Mater. Sci. Eng. 21 (2013) 045007, fig. 3a): the fast approach under their mutual attraction must leave a clean jog.
#include "dd/crystal/material.h"
#include "dd/forces/nodal_forces.h"
#include "dd/mobility/linear_glide.h"
#include "dd/mobility/local_velocities.h"
#include "dd/topology/collisions/moving_lines.h"
#include "tests/dd/topology/topology_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace ddfem
{
namespace
{
/// Zirconium, b = <a> along x, c axis along z. An edge line along c glides on the prismatic plane y = 0; a rectangular loop
/// normal to b has one side in this plane, of opposite sense, and two sides on basal planes.
struct LineAndLoop : TopologyFixture
{
  static constexpr double loop_width = 10, loop_height = 10, line_half = 20, spacing = 2.5, gap = 1.5; ///< nm
  const Material &zirconium = find_material("zirconium");
  Vec3 burgers{zirconium.burgers_magnitude, 0, 0};
  IsotropicMedium medium{zirconium.mu, zirconium.nu, zirconium.burgers_magnitude};
  CandidateList candidates;

  LineAndLoop()
  {
    settings = {1.25, 5, 0.01, 0.05};
    GlidePlanes &planes = network.planes();
    const PlaneIndex prismatic = planes.find_or_insert({0, 0, 0}, Vec3::UnitY(), Vec3(0, 0, 0));
    const PlaneIndex other_prismatic = planes.find_or_insert({0, 0, 0}, Vec3::UnitY(), Vec3(0, loop_width, 0));
    std::vector<Vec3> line;
    for (double z = -line_half; z <= line_half; z += spacing)
      line.emplace_back(-gap, 0, z);
    add_line(network, line, burgers, prismatic, false, NodeConstraint::pinned);
    // The loop: down along y = 0, then out along the basal plane, up and back.
    const double h = loop_height / 2;
    const std::vector<Vec3> corners{Vec3(0, 0, h), Vec3(0, 0, -h), Vec3(0, loop_width, -h), Vec3(0, loop_width, h)};
    const std::vector<PlaneIndex> sides{prismatic, planes.find_or_insert({0, 0, 0}, Vec3::UnitZ(), Vec3(0, 0, -h)),
                                        other_prismatic,
                                        planes.find_or_insert({0, 0, 0}, Vec3::UnitZ(), Vec3(0, 0, h))};
    std::vector<NodeIndex> nodes;
    std::vector<PlaneIndex> plane_after;
    for (std::size_t side = 0; side < 4; ++side)
      for (int k = 0; k < 4; ++k)
      {
        nodes.push_back(network.insert(Node{corners[side] + 0.25 * k * (corners[(side + 1) % 4] - corners[side])}));
        plane_after.push_back(sides[side]);
      }
    for (std::size_t k = 0; k < nodes.size(); ++k)
      network.insert(Segment{nodes[k], nodes[(k + 1) % nodes.size()], burgers, plane_after[k]});
    network.check_invariants();
  }

  void euler_step(const double dt)
  {
    const ForceSettings force_settings{medium, medium.a, 1e-5, RayDirection::normal};
    const NodalForces forces = compute_nodal_forces(network, force_settings, ForceEnvironment{}, MPI_COMM_SELF);
    const LinearGlide law({zirconium.drag, zirconium.drag});
    TopologyContext c = context();
    c.remaining = glide_velocities(network, forces.total, law, nullptr);
    for (Vec3 &v : c.remaining)
      v *= dt;
    move_lines(c, candidates);
    network.check_invariants();
  }

  /// Whether the line runs in one piece from end to end round the three outer sides of the loop.
  void expect_jog() const
  {
    std::vector<NodeIndex> ends;
    for (const NodeIndex i : network.nodes())
    {
      if (network.constraint(i) == NodeConstraint::pinned)
        ends.push_back(i);
      else
        EXPECT_EQ(network.degree(i), 2U);
    }
    ASSERT_EQ(ends.size(), 2U);
    std::size_t steps = 0;
    NodeIndex i = ends[0];
    SegmentIndex s = network.connected_segments(i)[0];
    double farthest = 0;
    for (i = network.other_end(s, i); i != ends[1] && steps < 1000; ++steps)
    {
      farthest = std::max(farthest, network.position(i)[1]);
      const auto arms = network.connected_segments(i);
      s = arms[0] == s ? arms[1] : arms[0];
      i = network.other_end(s, i);
    }
    EXPECT_EQ(steps + 1, network.n_segments());
    EXPECT_EQ(farthest, loop_width);
  }

  /// Nodes left in the prismatic plane where the side of the loop was: teeth.
  std::size_t teeth() const
  {
    std::size_t n = 0;
    for (const NodeIndex i : network.nodes())
      n += std::abs(network.position(i)[1]) < 1e-9 && std::abs(network.position(i)[2]) < loop_height / 2 - 0.1 ? 1 : 0;
    return n;
  }

  double length() const
  {
    double sum = 0;
    for (const SegmentIndex s : network.segments())
      sum += network.length(s);
    return sum;
  }
};

TEST(LoopAbsorption, LeavesTheSameJogAtTenTimesTheStep)
{
  std::vector<double> lengths;
  for (const double dt : {1e-5, 1e-4})
  {
    LineAndLoop f;
    double time = 0;
    for (; f.counts.annihilations == 0 && time < 0.01; time += dt)
      f.euler_step(dt);
    for (int k = 0; k < (dt < 5e-5 ? 20 : 2); ++k)
      f.euler_step(dt);
    f.expect_jog();
    EXPECT_EQ(f.teeth(), 0U);
    lengths.push_back(f.length());
  }
  // The straight line and the two basal sides, a little bent by then.
  EXPECT_NEAR(lengths[0], lengths[1], 2e-3 * lengths[0]);
  EXPECT_NEAR(lengths[0], 2 * LineAndLoop::line_half + 2 * LineAndLoop::loop_width, 1);
}
} // namespace
} // namespace ddfem
