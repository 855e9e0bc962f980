// Best approximation of functions on faces.
#include "fem/nodal_grid.h"
#include "fem/trace_projection.h"
#include "support.h"

#include <gtest/gtest.h>

namespace ddfem::fem::test
{
namespace
{
/// A "stress" whose product with +z is the given vector.
FunctionField on_z_faces(const std::function<Vector(const Point &)> &value, const FunctionField::LengthFunction &length)
{
  return FunctionField(
      [=](const Point &x)
      {
        Stress s;
        const Vector v = value(x);
        for (unsigned c = 0; c < 3; ++c)
        {
          s[2][c] = v[c];
        }
        return s;
      },
      length);
}
} // namespace

TEST(TraceProjection, ReproducesWhatTheElementsHoldOnTheFacesAndIsZeroElsewhere)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, mesh_file("bar.msh")); // cells of unequal width; bottom 1, top 2
  const double height = bounding_box(*mesh).second[2];
  for (const unsigned degree : {1U, 2U})
  {
    const auto value = [&](const Point &x)
    {
      Vector v;
      v[0] = 1. + x[0] - 2. * x[1];
      v[1] = degree == 2 ? 1e-2 * x[0] * x[1] + 3e-3 * x[1] * x[1] : 1e-2 * x[0] * x[1];
      v[2] = -0.5 * x[0];
      return v;
    };
    ElasticProblem problem(*mesh, accurate(degree), copper, {{1, {true, true, true}}, {2, {true, true, true}}});
    const auto projected =
        problem.project_on_conditions(on_z_faces(value, [](const Point &, double) { return 1e300; }));
    for (std::size_t i = 0; i < projected.size(); ++i)
    {
      const Point &x = problem.boundary_points()[i];
      const bool bottom = x[2]<1e-6, top = x[2]> height - 1e-6;
      const Vector expected = top ? value(x) : bottom ? -1. * value(x) : Vector();
      EXPECT_LT((projected[i] - expected).norm(), 1e-8 * 1e3);
    }
  }
}

TEST(TraceProjection, HasTheMeanAndTheFirstMomentOfAFunctionThatElementsDoNotResolve)
{
  // f = 1/((x - x0)^2 + d^2), d a twentieth of an element: the values at the nodes know nothing of its peak.
  const double length = 300., width = 200., x0 = 110., d = 2.5;
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({length, width, 100.}, {6, 2, 2}));
  const auto f = on_z_faces(
      [&](const Point &x)
      {
        Vector v;
        v[2] = 1. / ((x[0] - x0) * (x[0] - x0) + d * d);
        return v;
      },
      [&](const Point &x, double radius) { return std::hypot(std::max(0., std::abs(x[0] - x0) - radius), d); });
  const double mean = width / d * (std::atan((length - x0) / d) + std::atan(x0 / d));
  const double moment = 0.5 * width * std::log(((length - x0) * (length - x0) + d * d) / (x0 * x0 + d * d)) + x0 * mean;
  for (const unsigned degree : {1U, 2U})
  {
    const NodalGrid grid(*mesh, degree);
    const double tolerance = 1e-6;
    const NodalVector projected = TraceProjection(grid, {5}, tolerance).project(f);
    projected.update_ghost_values();
    const BoundaryLoad integrals(grid, {}, tolerance);
    double sums[2] = {0., 0.};
    for (unsigned face = 0; face < grid.faces.size(); ++face)
    {
      const auto &nodes = integrals.nodes(face);
      const std::vector<double> mass = integrals.mass(face);
      for (std::size_t k = 0; k < mass.size(); ++k)
      {
        const double part = mass[k] * projected.local_element(3 * nodes[k % nodes.size()] + 2);
        sums[0] += grid.faces[face].boundary == 5 ? part : 0.;
        sums[1] += grid.faces[face].boundary == 5 ? part * grid.positions[nodes[k / nodes.size()]][0] : 0.;
      }
    }
    MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    EXPECT_NEAR(sums[0] / mean, 1., tolerance);
    EXPECT_NEAR(sums[1] / moment, 1., tolerance);
  }
}
} // namespace ddfem::fem::test
