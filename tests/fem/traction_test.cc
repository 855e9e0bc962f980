// Adaptive quadrature of singular fields over the boundary.
#include "fem/boundary_load.h"
#include "fem/nodal_grid.h"
#include "support.h"

#include <deal.II/base/quadrature_lib.h>
#include <gtest/gtest.h>

namespace ddfem::fem::test
{
namespace
{
/// Screw dislocation along z through `axis` with a core of radius a: s_xz = -mu b y f, s_yz = mu b x f with f = 1 /
/// (r^2 + a^2), free of divergence whatever f. Its singularity lies at the complex distance a from the axis.
FunctionField screw(const Point &axis, double a)
{
  return FunctionField(
      [=](const Point &x)
      {
        const double dx = x[0] - axis[0], dy = x[1] - axis[1], f = 1e4 / (dx * dx + dy * dy + a * a);
        Stress s;
        s[0][2] = -dy * f;
        s[1][2] = dx * f;
        return s;
      },
      [=](const Point &x, double radius)
      {
        const double r = std::max(0., std::hypot(x[0] - axis[0], x[1] - axis[1]) - radius);
        return std::hypot(r, a);
      });
}

/// Hydrostatic field 1 / r of a line along y, not in equilibrium: its force and moment can only come out right by
/// integration.
FunctionField pressure_line(const Point &axis)
{
  const auto distance = [=](const Point &x) { return std::hypot(x[0] - axis[0], x[2] - axis[2]); };
  return FunctionField([=](const Point &x) { return (1e3 / distance(x)) * dealii::unit_symmetric_tensor<3>(); },
                       [=](const Point &x, double radius) { return distance(x) - radius; });
}

struct Integrals
{
  Vector force, moment;
  double absolute_force = 0.;
};

/// Integrals over the faces of the cube [0, 1]^3 * edge by rules of 16 points on strips that shrink towards x = foot.
Integrals brute_force(const FunctionField &field, double edge, double foot, const Point &centre)
{
  const dealii::QGauss<1> rule(16);
  std::vector<double> cuts = {0., 1.};
  for (double width = 0.5; width > 1e-5; width /= 2.)
  {
    for (const double cut : {foot - width, foot + width})
    {
      if (cut > 0. && cut < 1.)
      {
        cuts.push_back(cut);
      }
    }
  }
  cuts.push_back(foot);
  std::sort(cuts.begin(), cuts.end());
  std::vector<std::pair<double, double>> line; // points and weights
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
  {
    for (unsigned q = 0; q < rule.size(); ++q)
    {
      const double length = cuts[i + 1] - cuts[i];
      line.emplace_back(cuts[i] + length * rule.point(q)[0], length * rule.weight(q));
    }
  }
  Integrals result;
  for (unsigned face = 0; face < 6; ++face)
  {
    const unsigned axis = face / 2;
    for (const auto &[s, ws] : line)
    {
      for (const auto &[t, wt] : line)
      {
        Point x;
        x[axis] = edge * (face % 2);
        x[(axis + 1) % 3] = edge * s;
        x[(axis + 2) % 3] = edge * t;
        Vector area;
        area[axis] = (face % 2 == 0 ? -1. : 1.) * edge * edge * ws * wt;
        const Vector force = field.at(x) * area;
        result.force += force;
        result.moment += cross_product_3d(x - centre, force);
        result.absolute_force += force.norm();
      }
    }
  }
  return result;
}

/// Norm of what two nodal loads differ by, relative.
double difference(const NodalVector &a, const NodalVector &b)
{
  NodalVector d = a;
  d -= b;
  return d.l2_norm() / b.l2_norm();
}
} // namespace

TEST(Tractions, OfAPointForceInsideAreItsForceAndMoment)
{
  for (const auto &parameters : {box({300., 200., 400.}, {3, 2, 4}), cylinder(150., 400., 6, 4)})
  {
    const auto mesh = make_mesh(MPI_COMM_WORLD, parameters);
    ElasticProblem problem(*mesh, {}, copper, {});
    const Vector f({3e4, -2e4, 1e4});
    const auto [low, high] = bounding_box(*mesh);
    for (const double depth : {100., 1.})
    {
      const Point source(0.5 * (low[0] + high[0]) + 13., 0.5 * (low[1] + high[1]) - 7., high[2] - depth);
      const auto summary = problem.set_tractions(field_of(PointForce{source, f, copper}));
      EXPECT_EQ(summary.n_unresolved, 0u);
      EXPECT_LT((summary.force + f).norm(), 1e-6 * summary.absolute_force) << depth;
      const Vector moment = cross_product_3d(source - problem.centre(), f);
      EXPECT_LT((summary.moment + moment).norm(), 1e-6 * summary.absolute_moment) << depth;
    }
  }
}

TEST(Tractions, OfSourcesOutsideBalance)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({300., 200., 400.}, {3, 2, 4}));
  ElasticProblem problem(*mesh, {}, copper, {});
  for (const double distance : {50., 1.})
  {
    const PointForce force{Point(300. + distance, 120., 133.), Vector({3e4, -2e4, 1e4}), copper};
    const auto summary = problem.set_tractions(field_of(force));
    EXPECT_LT(summary.force.norm(), 1e-6 * summary.absolute_force) << distance;
    EXPECT_LT(summary.moment.norm(), 1e-6 * summary.absolute_moment) << distance;
    const auto line = problem.set_tractions(screw(Point(300. + distance, 120., 0.), 0.5));
    EXPECT_LT(line.force.norm(), 1e-6 * line.absolute_force) << distance;
    EXPECT_LT(line.moment.norm(), 1e-6 * line.absolute_moment) << distance;
  }
}

TEST(Tractions, OfALineThatPiercesTheSurfaceBalance)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({300., 200., 400.}, {3, 2, 4}));
  ElasticProblem problem(*mesh, {}, copper, {});
  // In a face, on an edge of faces, at a vertex of the mesh.
  for (const auto &axis : {Point(137., 81., 0.), Point(100., 33., 0.), Point(100., 100., 0.)})
  {
    const auto summary = problem.set_tractions(screw(axis, 0.5));
    EXPECT_EQ(summary.n_unresolved, 0u);
    EXPECT_LT(summary.force.norm(), 1e-6 * summary.absolute_force);
    EXPECT_LT(summary.moment.norm(), 1e-6 * summary.absolute_moment);
    EXPECT_LT(summary.n_points, 60000u);
  }
}

TEST(Tractions, OfALineNearAFaceAgreeWithBruteForce)
{
  const double edge = 100.;
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({edge, edge, edge}, {1, 1, 1}));
  ElasticProblem problem(*mesh, {}, copper, {});
  for (const double distance : {0.3, 0.01, 0.001})
  {
    const auto field = pressure_line(Point(0.37 * edge, 0., -distance * edge));
    const auto expected = brute_force(field, edge, 0.37, problem.centre());
    const auto summary = problem.set_tractions(field);
    EXPECT_LT((summary.force - expected.force).norm(), 1e-6 * expected.absolute_force) << distance;
    EXPECT_LT((summary.moment - expected.moment).norm(), 1e-6 * expected.absolute_force * edge) << distance;
    EXPECT_EQ(summary.n_unresolved, 0u);
  }
}

TEST(Tractions, HaveTheIntegralOfTheirMagnitudeAsScaleWhereTheyDoNotTurn)
{
  const double edge = 100.;
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({edge, edge, edge}, {1, 1, 1}));
  const NodalGrid grid(*mesh, 1);
  const Point centre(0.5 * edge, 0.5 * edge, 0.5 * edge);
  const auto field = pressure_line(Point(0.37 * edge, 0., -0.01 * edge));
  NodalVector load(grid.partitioner);
  const auto summary = BoundaryLoad(grid, centre, 1e-8).add_field(field, load);
  EXPECT_NEAR(summary.absolute_force / brute_force(field, edge, 0.37, centre).absolute_force, 1., 1e-7);
}

TEST(Tractions, NodalLoadsMeetTheRequestedTolerance)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, cylinder(150., 400., 6, 4));
  const NodalGrid grid(*mesh, 2);
  const Point centre(0., 0., 200.);
  const PointForce force{Point(20., 155., 130.), Vector({3e4, -2e4, 1e4}), copper};
  NodalVector exact(grid.partitioner);
  BoundaryLoad(grid, centre, 1e-13).add_field(field_of(force), exact);
  std::uint64_t previous = 0;
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8})
  {
    NodalVector load(grid.partitioner);
    const auto summary = BoundaryLoad(grid, centre, tolerance).add_field(field_of(force), load);
    EXPECT_LT(difference(load, exact), tolerance);
    EXPECT_GT(summary.n_points, previous);
    previous = summary.n_points;
  }
}

TEST(Tractions, ASingularityOnTheSurfaceIsReportedAndEnds)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({300., 200., 400.}, {3, 2, 4}));
  ElasticProblem problem(*mesh, {}, copper, {});
  const auto summary =
      problem.set_tractions(field_of(PointForce{Point(137., 81., 400.), Vector({1., 0., 0.}), copper}));
  EXPECT_GT(summary.n_unresolved, 0u);
}

TEST(Tractions, UniformTractionPressesWithItsAreaTimesItself)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, cylinder(150., 400., 6, 4));
  ElasticProblem problem(*mesh, accurate(2), copper, {{1, {true, true, true}}});
  problem.add_uniform_traction(2, Vector({1., 2., 3.}));
  problem.solve(prescribe(problem, [](const Point &) { return Vector(); }));
  const Vector expected = -problem.boundary_area(2) * Vector({1., 2., 3.});
  EXPECT_LT((problem.reaction(1) - expected).norm(), 1e-9 * expected.norm());
  problem.clear_uniform_tractions();
  EXPECT_EQ(problem.solve(prescribe(problem, [](const Point &) { return Vector(); })).iterations, 0u);
}
} // namespace ddfem::fem::test
