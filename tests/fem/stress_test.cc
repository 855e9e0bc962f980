// Recovered stress, point location, agreement between ranks, surface output.
#include "support.h"

#include <deal.II/distributed/tria_base.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace ddfem::fem::test
{
namespace
{
std::vector<DisplacementCondition> everywhere(const Triangulation &mesh)
{
  std::vector<DisplacementCondition> conditions;
  for (const auto &entry : boundary_areas(mesh))
  {
    conditions.push_back({entry.first, {true, true, true}});
  }
  return conditions;
}

/// Stress from central differences of the displacement, which within a quadratic cell are its own gradient.
Stress raw_stress(const ElasticProblem &problem, const Point &x)
{
  constexpr double step = 1e-3;
  std::vector<Point> points;
  for (unsigned d = 0; d < 3; ++d)
  {
    for (const double sign : {-1., 1.})
    {
      points.push_back(x);
      points.back()[d] += sign * step;
    }
  }
  const auto u = problem.displacement_at(points);
  dealii::Tensor<2, 3> gradient;
  for (unsigned d = 0; d < 3; ++d)
  {
    for (unsigned c = 0; c < 3; ++c)
    {
      gradient[c][d] = (u[2 * d + 1][c] - u[2 * d][c]) / (2. * step);
    }
  }
  return hooke(copper, gradient);
}

struct Errors
{
  double recovered = 0., raw = 0.;
};

/// Root-mean-square errors of the stress inside a box whose surface follows a point force outside. Very near the
/// surface nodal averages rule and the order is that of the gradient.
Errors stress_errors(unsigned degree, unsigned n, ElasticProblem::Recovery method)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({100., 100., 100.}, {n, n, n}));
  auto parameters = accurate(degree);
  parameters.recovery = method;
  ElasticProblem problem(*mesh, parameters, copper, everywhere(*mesh));
  const PointForce force{Point(50., 40., 180.), Vector({3e5, -2e5, 4e5}), copper};
  problem.solve(prescribe(problem, [&](const Point &x) { return force.displacement(x); }));
  const auto points = scattered_points(Point(6., 6., 6.), Point(94., 94., 94.), 200);
  const auto recovered = problem.stress_at(points);
  Errors errors;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const Stress exact = force.stress(points[i]);
    errors.recovered += std::pow((recovered[i] - exact).norm(), 2);
    errors.raw += std::pow((raw_stress(problem, points[i]) - exact).norm(), 2);
  }
  const auto count = static_cast<double>(points.size());
  return {std::sqrt(errors.recovered / count), std::sqrt(errors.raw / count)};
}
} // namespace

TEST(Stress, PatchRecoveryConvergesFasterThanTheElementGradient)
{
  for (const unsigned degree : {1u, 2u})
  {
    const auto method = ElasticProblem::Recovery::patches;
    const Errors coarse = stress_errors(degree, 4, method), fine = stress_errors(degree, 8, method);
    EXPECT_GT(std::log2(coarse.recovered / fine.recovered), degree == 1 ? 1.6 : 2.8) << degree;
    EXPECT_GT(std::log2(coarse.recovered / fine.recovered), std::log2(coarse.raw / fine.raw) + 0.3) << degree;
    EXPECT_LT(fine.recovered, 0.6 * fine.raw) << degree;
  }
}

TEST(Stress, AveragedRecoveryIsMoreAccurateThanTheElementGradient)
{
  for (const unsigned degree : {1u, 2u})
  {
    const auto method = ElasticProblem::Recovery::averages;
    const Errors coarse = stress_errors(degree, 4, method), fine = stress_errors(degree, 8, method);
    EXPECT_GT(std::log2(coarse.recovered / fine.recovered), degree == 1 ? 1.3 : 1.8) << degree;
    EXPECT_LT(fine.recovered, fine.raw) << degree;
  }
}

TEST(Stress, IsContinuousAcrossCells)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, cylinder(100., 300., 5, 4));
  ElasticProblem problem(*mesh, {}, copper, everywhere(*mesh));
  const PointForce force{Point(50., 140., 180.), Vector({3e5, -2e5, 4e5}), copper};
  problem.solve(prescribe(problem, [&](const Point &x) { return force.displacement(x); }));
  // A ray through many cells: jumps would show as differences that do not shrink with the distance.
  const Point start(-60., -50., 10.);
  const Vector ray({1.1, 0.9, 2.7});
  std::vector<Point> points;
  constexpr double tiny = 1e-7;
  for (unsigned i = 0; i < 2000; ++i)
  {
    points.push_back(start + 0.05 * i * ray);
    points.push_back(points.back() + tiny * ray);
  }
  const auto stresses = problem.stress_at(points);
  for (std::size_t i = 0; i < points.size(); i += 2)
  {
    EXPECT_LT((stresses[i] - stresses[i + 1]).norm(), 1e-5);
    EXPECT_GT(stresses[i].norm(), 1e-2);
  }
}

TEST(Stress, IsTheSameOnAllRanksAndDoesNotDependOnEarlierCalls)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, cylinder(100., 300., 5, 4));
  ElasticProblem problem(*mesh, {}, copper, everywhere(*mesh));
  const PointForce force{Point(50., 140., 180.), Vector({3e5, -2e5, 4e5}), copper};
  problem.solve(prescribe(problem, [&](const Point &x) { return force.displacement(x); }));
  auto points = scattered_points(Point(-70., -70., 0.), Point(70., 70., 300.), 500);
  for (const auto &facet : boundary_facets(*mesh))
  {
    points.push_back(facet.vertices[0]);
  }
  const auto fresh = problem.stress_at(points);
  auto shifted = points;
  for (auto &x : shifted)
  {
    x[2] = std::min(x[2] + 5., 300.);
  }
  problem.stress_at(shifted);
  const auto again = problem.stress_at(points);
  std::vector<double> bits;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    EXPECT_EQ(fresh[i], again[i]);
    for (unsigned k = 0; k < 6; ++k)
    {
      bits.push_back(fresh[i].access_raw_entry(k));
    }
  }
  std::vector<double> largest(bits.size()), smallest(bits.size());
  const int n = static_cast<int>(bits.size());
  MPI_Allreduce(bits.data(), largest.data(), n, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  MPI_Allreduce(bits.data(), smallest.data(), n, MPI_DOUBLE, MPI_MIN, MPI_COMM_WORLD);
  EXPECT_EQ(largest, smallest);
}

TEST(Stress, PointsThatMoveOrAreRenumberedGetTheirCells)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, cylinder(100., 300., 5, 4));
  ElasticProblem problem(*mesh, {}, copper, everywhere(*mesh)), other(*mesh, {}, copper, everywhere(*mesh));
  const PointForce force{Point(50., 140., 180.), Vector({3e5, -2e5, 4e5}), copper};
  for (ElasticProblem *const p : {&problem, &other})
  {
    p->solve(prescribe(*p, [&](const Point &x) { return force.displacement(x); }));
  }
  auto points = scattered_points(Point(-60., -60., 20.), Point(60., 60., 200.), 400);
  for (unsigned step = 0; step < 12; ++step)
  {
    // From less than a cell to several cells a step; every third step the list is turned round, every fourth only its
    // first part is asked for.
    for (auto &x : points)
    {
      x[2] += 1.5 * step;
      x[0] = -x[0] * 0.97;
    }
    if (step % 3 == 2)
    {
      std::reverse(points.begin(), points.end());
    }
    if (step % 4 == 3)
    {
      problem.stress_at({points.begin(), points.begin() + 37});
    }
    const auto cached = problem.stress_at(points);
    // Another list in between: the other object remembers nothing of these points.
    other.stress_at(scattered_points(Point(-60., -60., 20. * step), Point(60., 60., 20. * step + 10.), 400));
    EXPECT_EQ(cached, other.stress_at(points)) << step;
  }
}

TEST(Stress, DoesNotDependOnTheNumberOfRanks)
{
  for (const unsigned degree : {1u, 2u})
  {
    const std::vector<DisplacementCondition> conditions = {{1, {false, false, true}}, {2, {false, false, true}}};
    const PointForce force{Point(50., 140., 180.), Vector({3e5, -2e5, 4e5}), copper};
    const auto points = scattered_points(Point(-70., -70., 0.), Point(70., 70., 300.), 100);
    std::array<std::vector<Stress>, 2> stresses;
    std::array<std::vector<Vector>, 2> displacements;
    std::array<Vector, 2> reactions;
    for (const unsigned k : {0u, 1u})
    {
      const auto mesh = make_mesh(k == 0 ? MPI_COMM_SELF : MPI_COMM_WORLD, cylinder(100., 300., 5, 4));
      ElasticProblem problem(*mesh, accurate(degree), copper, conditions);
      problem.set_tractions(field_of(force));
      problem.solve(prescribe(problem, [&](const Point &x) { return Vector({0., 0., 1e-3 * x[2]}); }));
      stresses[k] = problem.stress_at(points);
      displacements[k] = problem.displacement_at(points);
      reactions[k] = problem.reaction(2);
    }
    EXPECT_LT((reactions[0] - reactions[1]).norm(), 1e-10 * reactions[0].norm());
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      EXPECT_LT((stresses[0][i] - stresses[1][i]).norm(), 1e-10 * stresses[0][i].norm());
      EXPECT_LT((displacements[0][i] - displacements[1][i]).norm(), 1e-10 * displacements[0][i].norm());
    }
  }
}

TEST(Stress, BoundaryPointsAreEachOwnedOnceAndOnTheirBoundaries)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({300., 200., 400.}, {3, 2, 4}));
  ElasticProblem problem(*mesh, {}, copper, {{4, {true, false, true}}});
  const std::array<double, 6> planes = {0., 300., 0., 200., 0., 400.};
  for (std::size_t i = 0; i < problem.boundary_points().size(); ++i)
  {
    const Point &x = problem.boundary_points()[i];
    std::vector<dealii::types::boundary_id> expected;
    for (unsigned id = 0; id < 6; ++id)
    {
      if (std::abs(x[id / 2] - planes[id]) < 1e-9)
      {
        expected.push_back(id);
      }
    }
    EXPECT_EQ(problem.boundary_ids()[i], expected);
    const bool bottom = x[2] < 1e-9;
    EXPECT_EQ(problem.prescribed_components()[i], (std::array<bool, 3>{bottom, false, bottom}));
  }
  unsigned long count = problem.boundary_points().size();
  MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_UNSIGNED_LONG, MPI_SUM, MPI_COMM_WORLD);
  EXPECT_EQ(count, 7ul * 5 * 9 - 5ul * 3 * 7);
}

TEST(Stress, NodesOnAReentrantEdgeKnowTheBoundariesOfOtherRanks)
{
  // Three cubes in an L, surfaces 1 (top and bottom), 2 (the two faces that meet in the re-entrant edge), 3 (the rest).
  // On that edge a cell of the corner cube has no boundary face, though its nodes lie on surface 2.
  const auto path = std::filesystem::temp_directory_path() / ("ddfem_l_" + std::to_string(getpid()) + ".msh");
  std::ofstream(path) << R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
16
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
7 0 2 0
8 1 2 0
9 0 0 1
10 1 0 1
11 2 0 1
12 0 1 1
13 1 1 1
14 2 1 1
15 0 2 1
16 1 2 1
$EndNodes
$Elements
17
1 3 2 1 1 1 2 5 4
2 3 2 1 1 2 3 6 5
3 3 2 1 1 4 5 8 7
4 3 2 1 1 9 10 13 12
5 3 2 1 1 10 11 14 13
6 3 2 1 1 12 13 16 15
7 3 2 2 1 5 6 14 13
8 3 2 2 1 5 8 16 13
9 3 2 3 1 1 2 10 9
10 3 2 3 1 2 3 11 10
11 3 2 3 1 3 6 14 11
12 3 2 3 1 7 8 16 15
13 3 2 3 1 4 7 15 12
14 3 2 3 1 1 4 12 9
15 5 2 1 1 1 2 5 4 9 10 13 12
16 5 2 1 1 2 3 6 5 10 11 14 13
17 5 2 1 1 4 5 8 7 12 13 16 15
$EndElements
)";
  MeshParameters parameters;
  parameters.shape = MeshParameters::Shape::gmsh;
  parameters.file = path.string();
  parameters.length_unit_nm = 100.;
  parameters.refinements = 1;
  const auto mesh = make_mesh(MPI_COMM_WORLD, parameters);
  ElasticProblem problem(*mesh, {}, copper, {{2, {true, true, true}}});
  int n_on_edge = 0;
  for (std::size_t i = 0; i < problem.boundary_points().size(); ++i)
  {
    const Point &x = problem.boundary_points()[i];
    if (std::abs(x[0] - 100.) < 1e-9 && std::abs(x[1] - 100.) < 1e-9)
    {
      ++n_on_edge;
      EXPECT_EQ(problem.boundary_ids()[i].back(), 2u) << x;
      EXPECT_TRUE(problem.prescribed_components()[i][0]) << x;
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, &n_on_edge, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  EXPECT_EQ(n_on_edge, 5);
  std::filesystem::remove(path);
}

TEST(Stress, SurfaceIsWrittenWholeAndInMetres)
{
  int rank = 0, n_ranks = 1, id = getpid();
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  MPI_Bcast(&id, 1, MPI_INT, 0, MPI_COMM_WORLD);
  const auto directory = std::filesystem::temp_directory_path() / ("ddfem_surface_" + std::to_string(id));
  std::filesystem::create_directories(directory);
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({300., 200., 400.}, {3, 2, 4}));
  ElasticProblem problem(*mesh, {}, copper, {{4, {true, true, true}}, {5, {true, true, true}}});
  problem.solve(prescribe(problem, [](const Point &x) { return Vector({0., 0., 1e-3 * x[2]}); }));
  const auto path = problem.write_surface(directory.string(), "grain_000",
                                          prescribe(problem, [](const Point &) { return Vector(); }));
  EXPECT_EQ(path, (directory / "grain_000.pvtu").string());
  std::size_t n_files = 0;
  for (const auto &entry : std::filesystem::directory_iterator(directory))
  {
    ++n_files;
    EXPECT_NE(entry.path().extension(), ".tmp");
  }
  EXPECT_EQ(n_files, static_cast<std::size_t>(n_ranks) + 1);
  std::ifstream stream(path);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  for (const char *const name :
       {"displacement_m", "correction_displacement_m", "correction_von_mises_Pa", "boundary_id"})
  {
    EXPECT_NE(text.find(name), std::string::npos) << name;
  }
  // Every face of a quadratic cell is four quadrilaterals: 4 x 2 (3x2 + 3x4 + 2x4), shared among the ranks.
  std::ifstream own((directory / ("grain_000." + std::to_string(rank) + ".vtu")).string());
  const std::string piece{std::istreambuf_iterator<char>(own), {}};
  const auto at = piece.find("NumberOfCells=\"");
  ASSERT_NE(at, std::string::npos);
  int n_cells = std::stoi(piece.substr(at + 15));
  MPI_Allreduce(MPI_IN_PLACE, &n_cells, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  EXPECT_EQ(n_cells, 208);
  EXPECT_THROW(problem.write_surface("/nowhere", "x", prescribe(problem, [](const Point &) { return Vector(); })),
               std::runtime_error);
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank == 0)
  {
    std::filesystem::remove_all(directory);
  }
}
} // namespace ddfem::fem::test
