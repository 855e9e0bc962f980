#include "dd/crystal/material.h"
#include "dd/microstructure/sources.h"
#include "dd/mobility/friction_glide.h"
#include "dd/mobility/linear_glide.h"
#include "dd/mobility/velocity_solver.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace ddfem
{
namespace
{
const Vec3 b(0.25, 0, 0);

PlaneIndex ground(Network &n)
{
  return n.planes().find_or_insert({0, 0, 1}, Vec3::UnitZ(), Vec3(Vec3::Zero()));
}

/// Nodal forces of a uniform force per length tau b in the plane z = 0, normal to the lines.
std::vector<Vec3> uniform_force(const Network &n, const double tau)
{
  std::vector<Vec3> f(n.node_capacity(), Vec3::Zero());
  for (const SegmentIndex s : n.segments())
    for (const NodeIndex i : {n.start(s), n.end(s)})
      f[i.value] += 0.5 * tau * b.norm() * Vec3::UnitZ().cross(n.direction(s));
  return f;
}

/// A closed loop of @p corners nodes and radius @p radius in the plane z = 0.
Network loop(const int corners, const double radius)
{
  Network n;
  std::vector<Vec3> points;
  for (int k = 0; k < corners; ++k)
  {
    const double phi = 2 * std::numbers::pi * k / corners;
    points.emplace_back(radius * std::cos(phi), radius * std::sin(phi), 0);
  }
  add_line(n, points, b, ground(n), true, NodeConstraint::free);
  return n;
}

/// A line across a periodic cell of 100 nm, at angle @p theta from b, with unequal segments.
Network endless_line(const double theta)
{
  Network n;
  const Vec3 t(std::cos(theta), std::sin(theta), 0);
  n.set_period(t.cwiseAbs() * 100 + Vec3(0, 0, 100));
  std::vector<NodeIndex> nodes;
  for (const double at : {0.0, 0.13, 0.31, 0.42, 0.64, 0.75, 0.9})
    nodes.push_back(n.insert(Node{100 * at * t}));
  for (std::size_t k = 0; k < nodes.size(); ++k)
    n.insert(Segment{nodes[k], nodes[(k + 1) % nodes.size()], b, ground(n)});
  return n;
}

TEST(Velocities, EndlessLinesGlideAtStressTimesBurgersOverDragByBothMethods)
{
  for (const double theta : {0.0, 0.6, std::numbers::pi / 2})
    for (const VelocityMethod method : {VelocityMethod::local, VelocityMethod::consistent})
      for (const bool friction : {false, true})
      {
        const Network n = endless_line(theta);
        MobilityPointer law = linear_glide(0.02, 0.07);
        if (friction)
          law = std::make_shared<FrictionGlide>(law, FrictionSettings{.stress = 15});
        const double drag = 0.02 * std::pow(std::sin(theta), 2) + 0.07 * std::pow(std::cos(theta), 2),
                     expected = (40 - (friction ? 15 : 0)) * b.norm() / drag;
        VelocitySolver solver(law, {.method = method});
        const auto v = solver.velocities(n, uniform_force(n, 40), nullptr);
        for (const NodeIndex i : n.nodes())
        {
          const Vec3 across(-std::sin(theta), std::cos(theta), 0);
          EXPECT_LT((v[i.value] - expected * across).norm(), 1e-6 * expected);
        }
      }
}

TEST(Velocities, ALoopExpandsWithTheDragAnisotropyOfTheLaw)
{
  const double edge = 0.02, screw = 0.07;
  const int corners = 256;
  const Network n = loop(corners, 100);
  for (const VelocityMethod method : {VelocityMethod::local, VelocityMethod::consistent})
  {
    VelocitySolver solver(linear_glide(edge, screw), {.method = method});
    const auto v = solver.velocities(n, uniform_force(n, 40), nullptr);
    // Node 0 is at (R, 0): the line along y there is an edge; node N/4 is a screw.
    const double ratio = v[0].norm() / v[corners / 4].norm();
    EXPECT_NEAR(ratio, screw / edge, 2e-3 * screw / edge);
    EXPECT_NEAR(v[corners / 4].norm(), 40 * b.norm() / screw, 2e-3 * 40 * b.norm() / screw);
  }
}

/// Three arms on two planes that meet in a free node, pinned at the far ends, with nodes between: the end of a junction.
Network three_arms()
{
  Network n;
  const Vec3 n1 = Vec3(1, 1, 1).normalized(), n2 = Vec3(1, 1, -1).normalized(), e = n1.cross(n2).normalized();
  const PlaneIndex p1 = n.planes().find_or_insert({1, 1, 1}, n1, Vec3(Vec3::Zero())),
                   p2 = n.planes().find_or_insert({1, 1, -1}, n2, Vec3(Vec3::Zero()));
  const NodeIndex o = n.insert(Node{});
  const auto arm = [&](const Vec3 &t, const Vec3 &burgers, const PlaneIndex plane)
  {
    NodeIndex last = o;
    for (const double at : {4.0, 11.0, 17.0, 25.0})
    {
      const NodeIndex next = n.insert(Node{at * t, at == 25.0 ? NodeConstraint::pinned : NodeConstraint::free});
      n.insert(Segment{last, next, burgers, plane});
      last = next;
    }
  };
  const Vec3 b1 = Vec3(0.2, -0.2, 0) + 0.1 * e, b2(0, 0.2, 0.2);
  arm((e + 0.8 * n1.cross(e)).normalized(), b1, p1);
  arm((e + 0.5 * n2.cross(e)).normalized(), b2, p2);
  arm(-e, -b1 - b2, PlaneIndex{});
  return n;
}

TEST(Velocities, ConsistentOnesSolveTheWeakFormOfTheWholeNetwork)
{
  const Network n = three_arms();
  const MobilityPointer law = linear_glide(0.02, 0.07);
  constexpr double beta = 0.1;
  std::vector<Vec3> force(n.node_capacity());
  for (const NodeIndex i : n.nodes())
    force[i.value] = Vec3(std::sin(3.0 * i.value), std::cos(5.0 * i.value), std::sin(1.0 + i.value));
  VelocitySolver solver(law, {.method = VelocityMethod::consistent, .sliding_drag = beta});
  const auto v = solver.velocities(n, force, nullptr);
  EXPECT_GT(v[0].norm(), 0); // the end of the junction
  // Weak form by brute force: mid-point rule with many points; its residual must vanish in all directions in which nodes move.
  std::vector<Vec3> rest = force;
  for (const SegmentIndex s : n.segments())
  {
    const LineState line = line_state(n, s);
    constexpr int points = 2000;
    for (int k = 0; k < points; ++k)
    {
      const double x = (k + 0.5) / points, w = n.length(s) / points;
      const Vec3 here = (1 - x) * v[n.start(s).value] + x * v[n.end(s).value];
      const double along = here.dot(line.direction);
      const Vec3 f = law->drag(line) * (here - (1 - beta) * along * line.direction);
      rest[n.start(s).value] -= w * (1 - x) * f;
      rest[n.end(s).value] -= w * x * f;
    }
  }
  for (const NodeIndex i : n.nodes())
  {
    const Mat3 directions = directions_of_motion(n, i, *law, nullptr);
    EXPECT_LT((directions * rest[i.value]).norm(), 1e-6) << i.value;
    EXPECT_LT((v[i.value] - directions * v[i.value]).norm(), 1e-12 * v[i.value].norm() + 1e-300) << i.value;
  }
}

TEST(Velocities, ARotatingLineIsFoundExactlyByTheConsistentOnesOnly)
{
  // Force per length B omega x on a straight line with free ends: it turns about its middle. Nodal forces int N_i f ds of a linear f are exact by Simpson's rule.
  Network n;
  std::vector<Vec3> points;
  for (const double y : {-50.0, -30.0, -10.0, -5.0, 20.0, 50.0})
    points.emplace_back(0, y, 0);
  add_line(n, points, b, ground(n), false, NodeConstraint::surface);
  const double drag = 0.02, omega = 0.3;
  std::vector<Vec3> force(n.node_capacity(), Vec3::Zero());
  for (const SegmentIndex s : n.segments())
  {
    const double y0 = n.position(n.start(s))[1], y1 = n.position(n.end(s))[1], w = n.length(s) * drag * omega / 6;
    force[n.start(s).value][0] += w * (2 * y0 + y1);
    force[n.end(s).value][0] += w * (y0 + 2 * y1);
  }
  double error[2] = {0, 0};
  for (const VelocityMethod method : {VelocityMethod::local, VelocityMethod::consistent})
  {
    VelocitySolver solver(linear_glide(drag, drag), {.method = method});
    const auto v = solver.velocities(n, force, nullptr);
    for (const NodeIndex i : n.nodes())
      error[method == VelocityMethod::local ? 0 : 1] =
          std::max(error[method == VelocityMethod::local ? 0 : 1], std::abs(v[i.value][0] - omega * n.position(i)[1]));
  }
  EXPECT_GT(error[0], 0.1);
  EXPECT_LT(error[1], 1e-7);
}

TEST(Velocities, TheEndOfAJunctionIsNotHeldBackByTheJunction)
{
  // Far longer than the arms next to the node, and at rest: only the sliding drag knows of it.
  const Network n = three_arms();
  const MobilityPointer law = linear_glide(0.02, 0.02);
  std::vector<Vec3> force(n.node_capacity(), Vec3::Zero());
  const Vec3 e = only_direction(directions_of_motion(n, NodeIndex{0}, *law, nullptr));
  ASSERT_NEAR(e.norm(), 1, 1e-12);
  force[0] = 5 * e;
  double across = 0, along = 0;
  for (const NodalArm &a : arms_of(n, NodeIndex{0}))
  {
    const double c = std::pow(a.line.direction.dot(e), 2);
    across += 0.5 * a.length * 0.02 * (1 - c);
    along += 0.5 * a.length * 0.02 * c;
  }
  for (const double beta : {1.0, 0.1, 0.01})
  {
    const auto v = glide_velocities(n, force, *law, nullptr, beta);
    EXPECT_NEAR(v[0].dot(e), 5 / (across + beta * along), 1e-9);
  }
  EXPECT_GT(along, across); // otherwise this shows nothing
}

TEST(Velocities, ConsistentOnesAreTheSameBitsOnAnyNumberOfThreadsAndStartWarm)
{
  const int corners = 5000;
  const Network n = loop(corners, 5000);
  std::vector<Vec3> force = uniform_force(n, 40), later;
  for (const NodeIndex i : n.nodes())
    force[i.value] *= 1 + 0.5 * std::sin(0.7 * i.value);
  for (const Vec3 &f : force)
    later.push_back((1 + 1e-4) * f);
  std::vector<std::vector<Vec3>> found;
  const int before = omp_get_max_threads();
  for (const int threads : {1, 4})
  {
    omp_set_num_threads(threads);
    VelocitySolver solver(linear_glide(0.02, 0.07), {.method = VelocityMethod::consistent});
    solver.velocities(n, force, nullptr);
    const unsigned cold = solver.iterations().gradients;
    found.push_back(solver.velocities(n, later, nullptr));
    EXPECT_LT(cold, 40U);
    EXPECT_LT(solver.iterations().gradients, 0.75 * cold);
  }
  omp_set_num_threads(before);
  for (const NodeIndex i : n.nodes())
    ASSERT_EQ(found[0][i.value], found[1][i.value]);
}

TEST(Velocities, StiffnessBoundsTheRateOfTheFastestMode)
{
  // A line with segments of 2 to 25 nm, straight: K and A of its transverse motion as dense matrices, pinned ends left out.
  Network n;
  const std::vector<double> at{0, 20, 22, 30, 55, 60, 62.5, 90};
  std::vector<Vec3> points;
  for (const double y : at)
    points.emplace_back(0, y, 0);
  add_line(n, points, b, ground(n), false, NodeConstraint::pinned);
  const double drag = 0.02, tension = 700;
  const auto m = static_cast<Eigen::Index>(at.size());
  for (const bool consistent : {false, true})
  {
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(m, m), a = k;
    for (Eigen::Index s = 0; s + 1 < m; ++s)
    {
      const double length = at[static_cast<std::size_t>(s) + 1] - at[static_cast<std::size_t>(s)];
      Eigen::Matrix2d mass;
      mass << 2, 1, 1, 2;
      if (!consistent)
        mass << 3, 0, 0, 3;
      k.block<2, 2>(s, s) += tension / length * (Eigen::Matrix2d() << 1, -1, -1, 1).finished();
      a.block<2, 2>(s, s) += drag * length / 6 * mass;
    }
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(k.block(1, 1, m - 2, m - 2),
                                                                          a.block(1, 1, m - 2, m - 2));
    const double fastest = modes.eigenvalues().maxCoeff();
    const VelocitySolver solver(linear_glide(drag, drag),
                                {.method = consistent ? VelocityMethod::consistent : VelocityMethod::local});
    const std::vector<double> bounds = solver.stiffness(n, tension, nullptr);
    const double bound = *std::max_element(bounds.begin(), bounds.end());
    EXPECT_GE(bound, fastest);
    EXPECT_LE(bound, 4 * fastest); // stages grow with its root
  }
}
} // namespace
} // namespace ddfem
