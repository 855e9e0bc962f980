// Integrals of the tractions of straight dislocations against brute force.
#include "coupling/dislocation_tractions.h"
#include "dd/elasticity/segment_stress.h"
#include "dd/microstructure/sources.h"
#include "fem/boundary_load.h"
#include "fem/mesh.h"

#include <deal.II/base/quadrature_lib.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace ddfem::coupling
{
namespace
{
constexpr double edge = 100;
constexpr dealii::types::boundary_id top = 5;
const IsotropicMedium medium{48e3, 0.34, 1.0};
const Vec3 burgers(0.2, 0.1, -0.15);

struct Segment
{
  Vec3 start, end;
};

LineSystem system_of(const std::vector<Segment> &segments)
{
  Network network;
  for (const Segment &s : segments)
    add_line(network, {s.start, s.end}, burgers, {}, false, NodeConstraint::pinned);
  return {medium, network, nullptr, RayDirection::normal, nullptr, nullptr};
}

/// The tractions of a field on the face z = edge alone.
class OnlyOnTop final : public fem::TractionField
{
public:
  explicit OnlyOnTop(const LineSystem &lines) : field(lines) {}
  unsigned n_sources() const override { return field.n_sources(); }
  void smooth_lengths(const dealii::Point<3> &centre, const double radius, const std::span<const unsigned> sources,
                      const std::span<double> lengths) const override
  {
    field.smooth_lengths(centre, radius, sources, lengths);
  }
  void add_stress(const std::span<const unsigned> sources, const std::span<const dealii::Point<3>> points,
                  const std::span<dealii::SymmetricTensor<2, 3>> values) const override
  {
    field.add_stress(sources, points, values);
  }
  bool vanishes_on(unsigned /*source*/, const dealii::types::boundary_id boundary) const override
  {
    return boundary != top;
  }

private:
  DislocationTractions field;
};

/// A cube of one element, and loads on it.
class Cube
{
public:
  explicit Cube(const unsigned elements = 1, const unsigned degree = 1)
      : mesh(fem::make_mesh(MPI_COMM_SELF, parameters(elements))), grid(*mesh, degree)
  {
  }
  fem::NodalVector load(const fem::TractionField &field, const double tolerance) const
  {
    fem::NodalVector result(grid.partitioner);
    const auto summary = fem::BoundaryLoad(grid, dealii::Point<3>(50., 50., 50.), tolerance).add_field(field, result);
    EXPECT_EQ(summary.n_unresolved, 0u);
    return result;
  }
  const std::vector<dealii::Point<3>> &positions() const { return grid.positions; }

private:
  static fem::MeshParameters parameters(const unsigned elements)
  {
    fem::MeshParameters p;
    p.shape = fem::MeshParameters::Shape::box;
    p.size = {edge, edge, edge};
    p.subdivisions = {elements, elements, elements};
    return p;
  }
  fem::TriangulationPointer mesh;
  fem::NodalGrid grid;
};

/// Points and weights on [0, edge]: 16 Gauss points on panels that halve towards each focus, down to 0.01 nm, a hundredth
/// of the core radius. Panels are as far from a focus as they are long: 16 points err by 4^-32.
std::vector<std::pair<double, double>> graded_rule(const std::vector<double> &foci)
{
  std::vector<double> cuts = {0, edge};
  for (const double focus : foci)
    for (double width = edge / 2; width > 0.01; width /= 2)
      cuts.insert(cuts.end(), {focus - width, focus, focus + width});
  std::erase_if(cuts, [](const double x) { return x < 0 || x > edge; });
  std::sort(cuts.begin(), cuts.end());
  const dealii::QGauss<1> rule(16);
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
    for (unsigned q = 0; q < rule.size() && cuts[i + 1] > cuts[i]; ++q)
      points.emplace_back(cuts[i] + (cuts[i + 1] - cuts[i]) * rule.point(q)[0],
                          (cuts[i + 1] - cuts[i]) * rule.weight(q));
  return points;
}

/// -int N . sigma n dS on z = edge for the nodes at the corners (0, 0), (edge, 0), (0, edge), (edge, edge).
std::array<Vec3, 4> brute_force(const Segment &s, const std::vector<double> &foci_x, const std::vector<double> &foci_y)
{
  const SegmentStressField stress(medium, s.start, s.end, burgers);
  std::array<Vec3, 4> nodal;
  nodal.fill(Vec3::Zero());
  const auto in_x = graded_rule(foci_x), in_y = graded_rule(foci_y);
  for (const auto &[y, wy] : in_y)
    for (const auto &[x, wx] : in_x)
    {
      const Vec3 t = -wx * wy * contract(stress(Vec3(x, y, edge)), Vec3::UnitZ());
      const double u = x / edge, v = y / edge;
      nodal[0] += (1 - u) * (1 - v) * t;
      nodal[1] += u * (1 - v) * t;
      nodal[2] += (1 - u) * v * t;
      nodal[3] += u * v * t;
    }
  return nodal;
}

/// Sum over the nodes of the errors of a load, over the sum of the loads.
double relative_error(const Cube &cube, const fem::NodalVector &load, const std::array<Vec3, 4> &exact)
{
  double error = 0, scale = 0;
  for (unsigned node = 0; node < cube.positions().size(); ++node)
  {
    const auto &x = cube.positions()[node];
    const Vec3 f(load.local_element(3 * node), load.local_element(3 * node + 1), load.local_element(3 * node + 2));
    const Vec3 e = x[2] < edge / 2 ? Vec3(Vec3::Zero()) : exact[(x[0] > edge / 2 ? 1 : 0) + (x[1] > edge / 2 ? 2 : 0)];
    error += (f - e).norm();
    scale += e.norm();
  }
  return error / scale;
}
} // namespace

TEST(DislocationTractions, OfALineAtAnyAngleToTheFaceMeetTheTolerance)
{
  const Cube cube;
  std::map<double, double> largest_error;        // for each tolerance
  for (const double height : {0., 0.1, 1., 10.}) // nm above the face, above or along which the line runs, or pierces it
    for (const double angle : {0., 1e-9, 1e-6, 1e-3, 0.1, 1.})
    {
      const Vec3 middle(37, 41, edge + height), direction(std::cos(angle), 0, std::sin(angle));
      const Segment s{middle - 30 * direction, middle + 30 * direction};
      const auto exact =
          brute_force(s, {37, s.start[0], s.end[0], 37 - height / std::tan(std::max(angle, 1e-3))}, {41});
      const LineSystem lines = system_of({s});
      for (const double tolerance : {1e-4, 1e-6, 1e-8})
      {
        const double error = relative_error(cube, cube.load(OnlyOnTop(lines), tolerance), exact);
        EXPECT_LT(error, tolerance) << "height " << height << " angle " << angle;
        largest_error[tolerance] = std::max(largest_error[tolerance], error);
      }
    }
  // A bound that holds for every place is judged by the worst one, which must come near it: two orders are two points per
  // direction in ten.
  for (const auto &[tolerance, error] : largest_error)
    EXPECT_GT(error, 0.01 * tolerance);
}

namespace
{
std::vector<Segment> random_segments(const int n)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.2, 1.2);
  const auto point = [&] { return Vec3(edge * uniform(random), edge * uniform(random), edge * uniform(random)); };
  std::vector<Segment> segments;
  for (int i = 0; i < n; ++i)
  {
    const Vec3 start = point();
    segments.push_back({start, start + 0.2 * (point() - start)});
  }
  return segments;
}

double difference(const fem::NodalVector &a, const fem::NodalVector &b)
{
  fem::NodalVector d = a;
  d -= b;
  return d.l2_norm() / b.l2_norm();
}
} // namespace

TEST(DislocationTractions, OfManyLinesAreTheSumOfThoseOfEach)
{
  const Cube cube(3, 2);
  const auto segments = random_segments(40);
  const LineSystem together = system_of(segments);
  const fem::NodalVector all = cube.load(DislocationTractions(together), 1e-7);
  fem::NodalVector sum = all;
  sum = 0.;
  for (const Segment &s : segments)
  {
    const LineSystem one = system_of({s});
    sum += cube.load(DislocationTractions(one), 1e-7);
  }
  EXPECT_LT(difference(all, sum), 1e-6); // forty errors of 1e-7 that do not add up in phase
}

TEST(DislocationTractions, AreTheSameBitsOnAnyNumberOfThreads)
{
  const Cube cube(3, 2);
  const LineSystem lines = system_of(random_segments(40));
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const fem::NodalVector one = cube.load(DislocationTractions(lines), 1e-5);
  omp_set_num_threads(3);
  const fem::NodalVector three = cube.load(DislocationTractions(lines), 1e-5);
  omp_set_num_threads(before);
  for (unsigned i = 0; i < one.locally_owned_size(); ++i)
    EXPECT_EQ(one.local_element(i), three.local_element(i));
}
} // namespace ddfem::coupling
