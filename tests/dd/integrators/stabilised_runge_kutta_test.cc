#include "dd/integrators/stabilised_runge_kutta.h"
#include "dd/microstructure/sources.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ddfem
{
namespace
{
constexpr int n_pieces = 20;

/// Line of length 200 nm along x, pinned at its ends, displaced by a half sine wave of 10 nm.
Network bowed_line()
{
  Network n;
  const PlaneIndex plane = n.planes().find_or_insert({0, 0, 1}, Vec3::UnitZ(), Vec3(Vec3::Zero()));
  std::vector<Vec3> points;
  for (int k = 0; k <= n_pieces; ++k)
    points.emplace_back(200.0 * k / n_pieces, 10 * std::sin(M_PI * k / n_pieces), 0);
  add_line(n, points, Vec3(0.25, 0, 0), plane, false, NodeConstraint::pinned);
  return n;
}

constexpr double tension_over_drag = 2000.0; ///< T/B, nm^2/ns

/// String model: v = (T/B) d^2y/dx^2 by differences. The sine wave is an eigenvector with eigenvalue -lambda.
std::vector<Vec3> string_velocity(const Network &n)
{
  std::vector<Vec3> v(n.node_capacity(), Vec3::Zero());
  const double h = 200.0 / n_pieces;
  for (const NodeIndex i : n.nodes())
    if (n.constraint(i) == NodeConstraint::free)
      for (const SegmentIndex s : n.connected_segments(i))
        v[i.value][1] += tension_over_drag / (h * h) * (n.position(n.other_end(s, i)) - n.position(i))[1];
  return v;
}

double lambda()
{
  const double h = 200.0 / n_pieces, s = std::sin(M_PI / (2 * n_pieces));
  return 4 * tension_over_drag / (h * h) * s * s;
}

double stiffness()
{
  const double h = 200.0 / n_pieces;
  return 4 * tension_over_drag / (h * h);
}

double middle_displacement(const IntegratorStep &step)
{
  return step.displacement[n_pieces / 2][1];
}

TEST(StabilisedRungeKutta, LocalErrorFallsWithTheCubeOfTheStep)
{
  std::vector<double> errors;
  for (const double dt : {0.4, 0.2, 0.1})
  {
    Network n = bowed_line();
    StabilisedRungeKutta method({1e3, 1e3, 1e9, dt, 100});
    const IntegratorStep step = method.advance(n, string_velocity, stiffness(), dt);
    EXPECT_DOUBLE_EQ(step.dt, dt);
    errors.push_back(std::abs(middle_displacement(step) - 10 * (std::exp(-lambda() * dt) - 1)));
  }
  for (std::size_t k = 0; k + 1 < errors.size(); ++k)
    EXPECT_NEAR(std::log2(errors[k] / errors[k + 1]), 3.0, 0.35); // higher-order terms are not yet negligible at 0.4
}

TEST(StabilisedRungeKutta, HeldNodesDoNotMoveNotEvenByRounding)
{
  // A source may be held on the surface of the grain, where a displacement by rounding lets its end leave.
  Network n = bowed_line();
  for (const NodeIndex i : n.nodes())
    n.set_position(i, n.position(i) + Vec3(-400.0 / 3, 0.1, 1.0 / 7));
  StabilisedRungeKutta method({1e3, 1e3, 1e9, 5.0, 100});
  const IntegratorStep step = method.advance(n, string_velocity, stiffness(), 5.0);
  EXPECT_GT(step.stages, 5U);
  for (const NodeIndex i : n.nodes())
    if (n.constraint(i) == NodeConstraint::pinned)
    {
      EXPECT_TRUE(step.displacement[i.value].isZero(0));
    }
}

TEST(StabilisedRungeKutta, StepsFarBeyondTheEulerLimitStayStable)
{
  Network n = bowed_line();
  n.set_position(NodeIndex{7}, n.position(NodeIndex{7}) + Vec3(0, 2, 0)); // a kink excites the stiff modes
  const double euler = 2 / stiffness();
  StabilisedRungeKutta method({1e9, 1e9, 1e9, 50 * euler, 100});
  for (int k = 0; k < 40; ++k)
  {
    method.set_suggested_step(50 * euler);
    const IntegratorStep step = method.advance(n, string_velocity, stiffness(), 1e9);
    EXPECT_LT(step.stages, 15U);
    for (const NodeIndex i : n.nodes())
      n.set_position(i, n.position(i) + step.displacement[i.value]);
  }
  for (const NodeIndex i : n.nodes())
    EXPECT_LT(std::abs(n.position(i)[1]), 12);
}

TEST(StabilisedRungeKutta, NetworkIsLeftInPlaceAndLimitsAreRespected)
{
  Network n = bowed_line();
  const std::uint64_t before = n.checksum();
  StabilisedRungeKutta method({0.01, 0.5, 1e9, 10.0, 50});
  const IntegratorStep step = method.advance(n, string_velocity, stiffness(), 1e9);
  EXPECT_EQ(n.checksum(), before);
  EXPECT_LE(step.error, 0.01);
  for (const Vec3 &d : step.displacement)
    EXPECT_LE(d.norm(), 0.55);
  StabilisedRungeKutta second({0.01, 0.5, 1e9, 10.0, 50});
  EXPECT_DOUBLE_EQ(second.advance(n, string_velocity, stiffness(), 1e-3).dt, 1e-3);
}

TEST(StabilisedRungeKutta, NonFiniteVelocityNamesTheNode)
{
  Network n = bowed_line();
  StabilisedRungeKutta method({0.01, 0.5, 1e9, 1.0, 50});
  const auto velocity = [](const Network &net)
  {
    std::vector<Vec3> v(net.node_capacity(), Vec3::Zero());
    v[3][0] = std::numeric_limits<double>::quiet_NaN();
    return v;
  };
  try
  {
    method.advance(n, velocity, 1, 1);
    FAIL();
  }
  catch (const std::runtime_error &e)
  {
    EXPECT_NE(std::string(e.what()).find("node 3"), std::string::npos);
  }
}
} // namespace
} // namespace ddfem
