// A Frank-Read source that emits one loop after the other: topology, length of the source, and plastic strain.
#include "dd/crystal/material.h"
#include "dd/forces/nodal_forces.h"
#include "dd/integrators/stabilised_runge_kutta.h"
#include "dd/mobility/linear_glide.h"
#include "dd/mobility/velocity_solver.h"
#include "dd/topology/collisions/moving_lines.h"
#include "dd/topology/node_splitting.h"
#include "dd/topology/remesh.h"
#include "tests/dd/topology/topology_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace ddfem
{
namespace
{
/// Edge source in the plane z = 0 of an aluminium grain, a cube with free faces (thesis of Durocher, 2018, table IV.1, but
/// coarser); the fields are those of an infinite body.
struct SourceInGrain : TopologyFixture
{
  static constexpr double length = 150, half_width = 200;        ///< nm
  static constexpr double section = 4 * half_width * half_width; ///< nm^2
  const Material &aluminium = find_material("aluminium");
  const double b = aluminium.burgers_magnitude;
  IsotropicMedium medium{aluminium.mu, aluminium.nu, b};
  MobilityPointer law = linear_glide(aluminium.drag, aluminium.drag);
  BoxShape box{Vec3(-half_width, -half_width, -half_width), Vec3(half_width, half_width, half_width)};
  SymTensor applied = SymTensor::Zero();
  CandidateList candidates;
  StabilisedRungeKutta integrator{{.error_tolerance = 0.2, .max_displacement = 5, .max_step = 1, .initial_step = 1e-4}};
  double swept_area = 0;    ///< by real lines, along z, nm^2
  double strain_volume = 0; ///< plastic strain xz times volume, nm^3

  explicit SourceInGrain(const double stress)
  {
    applied[4] = stress; // xz
    settings = {10, 30, 1, 1.25};
    settings.max_area = 180;
    shape = &box;
    std::vector<Vec3> points;
    for (int k = 0; k <= 8; ++k)
      points.emplace_back(0, length * (k / 8.0 - 0.5), 0);
    add_line(network, points, Vec3(b, 0, 0), horizontal(), false, NodeConstraint::pinned);
  }

  NodalForces forces(const Network &n) const
  {
    ForceEnvironment e;
    e.applied = applied;
    e.shape = &box;
    return compute_nodal_forces(n, {medium, medium.a, 1e-4, RayDirection::normal}, e, MPI_COMM_SELF);
  }

  double stiffness() const
  {
    const double tension = medium.mu * b * b * (1 + medium.nu) / (4 * std::numbers::pi * (1 - medium.nu)) *
                           std::log(2 * settings.max_segment / medium.a);
    const std::vector<double> bounds = VelocitySolver(law).stiffness(network, tension, &box);
    return *std::max_element(bounds.begin(), bounds.end());
  }

  void step()
  {
    const auto velocity = [&](const Network &n) { return glide_velocities(n, forces(n).total, *law, &box); };
    TopologyContext c = context();
    c.remaining = integrator.advance(network, velocity, stiffness(), 1).displacement;
    move_lines(c, candidates);
    SplittingModel model{medium, medium.a, law};
    model.applied = applied;
    split_nodes(c, model, [&](const Network &n) { return forces(n); });
    remesh(c);
    swept_area += inside_area(swept, Vec3(b, 0, 0))[2];
    strain_volume += plastic_strain_volume(swept)[4];
    swept.clear();
    network.check_invariants();
    if (network.node_capacity() > 2 * network.n_nodes() + 64)
      network.clean();
  }

  /// Length of the line that joins the two pinned nodes; infinite while none does.
  double source_length() const
  {
    for (const NodeIndex i : network.nodes())
      if (network.constraint(i) == NodeConstraint::pinned)
      {
        double sum = 0;
        SegmentIndex s = network.connected_segments(i)[0];
        NodeIndex k = network.other_end(s, i);
        for (sum = network.length(s); network.degree(k) == 2; sum += network.length(s))
        {
          const auto arms = network.connected_segments(k);
          s = arms[0] == s ? arms[1] : arms[0];
          k = network.other_end(s, k);
        }
        return network.constraint(k) == NodeConstraint::pinned ? sum : std::numeric_limits<double>::infinity();
      }
    return 0;
  }

  /// Where on the square contour of the cross-section, counter-clockwise from its corner (-,-), in nm.
  static double on_contour(const Vec3 &x)
  {
    const double h = half_width;
    if (x[1] <= -h + 1e-6)
      return x[0] + h;
    if (x[0] >= h - 1e-6)
      return 2 * h + x[1] + h;
    return x[1] >= h - 1e-6 ? 4 * h + h - x[0] : 6 * h + h - x[1];
  }

  /// Area that has slipped, from the present lines alone, up to multiples of the cross-section: lines are closed along
  /// the contour from their last to their first point, and the source by its straight initial position.
  double slipped_area_of_lines() const
  {
    double area = 0;
    std::vector<double> first, last; // of the lines that begin and end at the surface
    for (const SegmentIndex s : network.segments())
    {
      const double sign = network.burgers(s)[0] > 0 ? 1 : -1;
      const Vec3 &x = network.position(network.start(s)), &y = network.position(network.end(s));
      area += sign * 0.5 * (x[0] * y[1] - x[1] * y[0]);
      for (const auto &[i, is_start] : {std::pair(network.start(s), true), std::pair(network.end(s), false)})
        if (network.constraint(i) == NodeConstraint::surface)
          (is_start == (sign > 0) ? first : last).push_back(on_contour(network.position(i)));
    }
    // From each last point counter-clockwise to the next first one: 1/2 x cross dx is half_width / 2 times the way.
    std::sort(first.begin(), first.end());
    for (const double from : last)
    {
      const auto next = std::upper_bound(first.begin(), first.end(), from);
      const double to = next != first.end() ? *next : first.front() + 8 * half_width;
      area += 0.5 * half_width * (to - from);
    }
    return area;
  }

  /// Difference of the two, in parts of the section.
  double area_not_booked() const
  {
    const double difference = (swept_area - slipped_area_of_lines()) / section;
    return std::abs(difference - std::round(difference));
  }
};

/// Runs until the line between the two pinned nodes has closed behind another loop; whether it has.
bool emit_loop(SourceInGrain &f, double &worst_area)
{
  bool is_reacting = false;
  for (int k = 0; k < 1500; ++k)
  {
    f.step();
    worst_area = std::max(worst_area, f.area_not_booked());
    const bool is_closed = f.source_length() < std::numeric_limits<double>::infinity();
    if (is_closed && is_reacting)
      return true;
    is_reacting = !is_closed;
  }
  return false;
}

TEST(FrankReadSource, EmitsFiveLoopsAndComesBackToItsInitialLengthEachTime)
{
  SourceInGrain f(60);
  double worst_area = 0;
  for (int loop = 0; loop < 5; ++loop)
  {
    f.applied[4] = 60;
    ASSERT_TRUE(emit_loop(f, worst_area)) << "loop " << loop;
    f.applied[4] = 0;
    for (int k = 0; k < 400 && std::abs(f.source_length() - SourceInGrain::length) > 1e-4 * SourceInGrain::length; ++k)
      f.step();
    EXPECT_NEAR(f.source_length(), SourceInGrain::length, 1e-4 * SourceInGrain::length) << "loop " << loop;
  }
  EXPECT_LT(worst_area, 1e-10);
  EXPECT_NEAR(std::abs(f.strain_volume), 0.5 * f.b * std::abs(f.swept_area), 1e-10 * std::abs(f.strain_volume));
}

TEST(FrankReadSource, RepeatsItselfUnderConstantStressAndItsPlasticStrainHasNoNotches)
{
  SourceInGrain f(180);
  double worst_area = 0;
  std::vector<double> slipped;
  for (int loop = 0; loop < 6; ++loop)
  {
    ASSERT_TRUE(emit_loop(f, worst_area)) << "loop " << loop;
    slipped.push_back(std::abs(f.swept_area));
  }
  // After the first each loop slips the same area, that of the section, up to the position of the line when it closes.
  for (std::size_t k = 2; k < slipped.size(); ++k)
    EXPECT_NEAR(slipped[k] - slipped[k - 1], SourceInGrain::section, 0.02 * SourceInGrain::section);
  EXPECT_LT(worst_area, 1e-10);
  EXPECT_NEAR(std::abs(f.strain_volume), 0.5 * f.b * std::abs(f.swept_area), 1e-10 * std::abs(f.strain_volume));
}
} // namespace
} // namespace ddfem
