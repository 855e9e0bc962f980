// Error of the stress inside and near the surface: gradient of the elements, its L2 projection onto the elements' continuous
// functions, averages at nodes, patch recovery. One process, no arguments.
//
// Cube of 1 with n elements per edge under a point force at a height of 0.4 above its upper face, which gets Kelvin's tractions; the other faces get
// his displacements. Each number is the rms error over 400 points over the rms stress there.
#include "fem/elastic_problem.h"
#include "fem/element.h"
#include "fem/mesh.h"
#include "fem/nodal_grid.h"
#include "fem/point_locator.h"
#include "tests/fem/support.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

using namespace ddfem::fem;
using namespace ddfem::fem::test;

namespace
{
using Values = std::vector<double>; // six numbers for each node or point

/// Continuous field of the elements' degree that is nearest to the stress of the elements in the mean square over the volume; cells
/// are equal cubes.
class Projection
{
public:
  Projection(const NodalGrid &nodal_grid, const std::vector<double> &displacement) : grid(nodal_grid), u(displacement)
  {
    const CubeRule rule = gauss_cube(grid.degree + 1);
    const unsigned n = grid.nodes_per_cell;
    mass.assign(n * n, 0.);
    right.assign(6 * grid.positions.size(), 0.);
    for (std::size_t q = 0; q < rule.points.size(); ++q)
    {
      const LagrangeCell shape = lagrange_cell(grid.degree, rule.points[q]);
      for (unsigned a = 0; a < n; ++a)
        for (unsigned b = 0; b < n; ++b)
          mass[a * n + b] += rule.weights[q] * shape.value[a] * shape.value[b];
      for (unsigned cell = 0; cell < grid.n_cells(); ++cell)
      {
        const Stress s = element_stress(cell, rule.points[q]);
        for (unsigned a = 0; a < n; ++a)
          for (unsigned k = 0; k < 6; ++k)
            right[6 * grid.nodes_of(cell)[a] + k] += rule.weights[q] * shape.value[a] * s.access_raw_entry(k);
      }
    }
  }

  Stress element_stress(const unsigned cell, const Point &xi) const
  {
    const LagrangeCell shape = lagrange_cell(grid.degree, xi);
    const auto position = [&](unsigned a) -> const Point & { return grid.positions[grid.nodes_of(cell)[a]]; };
    const auto inverse = invert(jacobian(shape, grid.nodes_per_cell, position));
    dealii::Tensor<2, 3> gradient;
    for (unsigned a = 0; a < grid.nodes_per_cell; ++a)
      for (unsigned c = 0; c < 3; ++c)
        for (unsigned j = 0; j < 3; ++j)
          for (unsigned d = 0; d < 3; ++d)
            gradient[c][d] += u[3 * grid.nodes_of(cell)[a] + c] * shape.gradient[a][j] * inverse[j][d];
    return hooke(copper, gradient);
  }

  /// Conjugate gradients on the mass matrix, whose condition does not depend on the mesh.
  Values solve() const
  {
    Values x(right.size(), 0.), r = right, p(right.size(), 0.);
    double old = 1.;
    for (unsigned i = 0; i < 200; ++i)
    {
      const double rr = product(r, r);
      if (rr < 1e-24 * product(right, right))
        break;
      for (std::size_t k = 0; k < p.size(); ++k)
        p[k] = r[k] + (i == 0 ? 0. : rr / old) * p[k];
      const Values mp = multiply(p);
      const double step = rr / product(p, mp);
      for (std::size_t k = 0; k < x.size(); ++k)
      {
        x[k] += step * p[k];
        r[k] -= step * mp[k];
      }
      old = rr;
    }
    return x;
  }

private:
  static double product(const Values &a, const Values &b)
  {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
      sum += a[k] * b[k];
    return sum;
  }
  Values multiply(const Values &x) const
  {
    Values y(x.size(), 0.);
    const unsigned n = grid.nodes_per_cell;
    for (unsigned cell = 0; cell < grid.n_cells(); ++cell)
      for (unsigned a = 0; a < n; ++a)
        for (unsigned b = 0; b < n; ++b)
          for (unsigned k = 0; k < 6; ++k)
            y[6 * grid.nodes_of(cell)[a] + k] += mass[a * n + b] * x[6 * grid.nodes_of(cell)[b] + k];
    return y;
  }

  const NodalGrid &grid;
  const std::vector<double> &u;
  Values mass, right;
};

const PointForce force{Point(0.45, 0.55, 1.4), Vector({1., -0.7, 1.3}), copper};

double error(const std::vector<Point> &points, const std::vector<Stress> &values)
{
  double sum = 0, scale = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const Stress exact = force.stress(points[i]);
    sum += std::pow((values[i] - exact).norm(), 2);
    scale += std::pow(exact.norm(), 2);
  }
  return std::sqrt(sum / scale);
}

std::vector<Stress> stresses(const Values &values)
{
  std::vector<Stress> result(values.size() / 6);
  for (std::size_t i = 0; i < values.size(); ++i)
    result[i / 6].access_raw_entry(static_cast<unsigned>(i % 6)) = values[i];
  return result;
}

std::vector<Stress> raw(const Projection &projection, const NodalGrid &grid, const std::vector<Point> &points)
{
  std::vector<Stress> result;
  for (const Point &x : points)
    for (unsigned cell = 0; cell < grid.n_cells(); ++cell)
    {
      const Point &low = grid.positions[grid.nodes_of(cell)[0]];
      const Point &high = grid.positions[grid.nodes_of(cell)[grid.nodes_per_cell - 1]];
      Point xi;
      bool inside = true;
      for (unsigned d = 0; d < 3; ++d)
      {
        xi[d] = (x[d] - low[d]) / (high[d] - low[d]);
        inside = inside && xi[d] >= 0 && xi[d] < 1;
      }
      if (inside)
      {
        result.push_back(projection.element_stress(cell, xi));
        break;
      }
    }
  return result;
}

/// The problem on one mesh.
class Cube
{
public:
  Cube(const unsigned degree, const unsigned n, const ElasticProblem::Recovery recovery)
      : mesh(make_mesh(MPI_COMM_WORLD, box({1., 1., 1.}, {n, n, n}))), grid(*mesh, degree)
  {
    auto parameters = accurate(degree);
    parameters.recovery = recovery;
    parameters.traction_tolerance = 1e-10;
    const std::array<bool, 3> all{true, true, true};
    problem = std::make_unique<ElasticProblem>(
        *mesh, parameters, copper,
        std::vector<DisplacementCondition>{{0, all}, {1, all}, {2, all}, {3, all}, {4, all}});
    // The load of a field is minus its traction: that of the opposite force.
    PointForce opposite = force;
    opposite.force *= -1.;
    problem->set_tractions(field_of(opposite));
    problem->solve(prescribe(*problem, [](const Point &x) { return force.displacement(x); }));
  }
  TriangulationPointer mesh;
  NodalGrid grid;
  std::unique_ptr<ElasticProblem> problem;
};

void row(const unsigned degree, const unsigned n)
{
  const Cube patches(degree, n, ElasticProblem::Recovery::patches),
      averages(degree, n, ElasticProblem::Recovery::averages);
  const auto solution = patches.problem->solution();
  const Projection projection(patches.grid, solution);
  const Values projected = projection.solve();
  PointLocator locator(patches.grid, 0.02);
  const double h = 1. / n;
  const auto layer = [&](const double low, const double high)
  { return scattered_points(Point(0.2, 0.2, 1 - high * h), Point(0.8, 0.8, 1 - low * h), 400); };
  const std::vector<std::pair<std::string, std::vector<Point>>> places{
      {"inside", scattered_points(Point(0.26, 0.26, 0.26), Point(0.74, 0.74, 0.74), 400)},
      {"1 to 2 elements deep", layer(1, 2)},
      {"0.5 to 1 elements deep", layer(0.5, 1)},
      {"0 to 0.5 elements deep", layer(0, 0.5)}};
  for (const auto &[name, points] : places)
    std::printf("| Q%u | %2u | %-22s | %8.2e | %8.2e | %8.2e | %8.2e |\n", degree, n, name.c_str(),
                error(points, raw(projection, patches.grid, points)),
                error(points, stresses(locator.evaluate(points, 6, projected))),
                error(points, averages.problem->stress_at(points)), error(points, patches.problem->stress_at(points)));
}
} // namespace

int main(int argc, char **argv)
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  std::printf("| element | n | points | element gradient | L2 projection | averages | patches "
              "|\n|---|---|---|---|---|---|---|\n");
  for (const unsigned degree : {1U, 2U})
    for (const unsigned n : {4U, 8U, 16U})
      row(degree, n);
  return 0;
}
