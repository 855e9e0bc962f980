// The fields of many lines on the surface and at the segments, summed together, against sums over every source.
#include "coupling/convert.h"
#include "coupling/dislocation_tractions.h"
#include "coupling/face_displacements.h"
#include "coupling/grain_geometry.h"
#include "coupling/image_planes.h"
#include "dd/geometry/grain_shape.h"
#include "dd/microstructure/sources.h"
#include "fem/boundary_load.h"
#include "fem/elastic_problem.h"
#include "fem/mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace ddfem::coupling
{
namespace
{
constexpr double edge = 400;
const IsotropicMedium medium{48e3, 0.34, 0.25};

/// Loops of 12 segments all over a cube, near its faces too, and lines from side to side, each bent a little by @p shift (nm).
Network random_network(const double shift)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto vector = [&] { return Vec3(uniform(random) - 0.5, uniform(random) - 0.5, uniform(random) - 0.5); };
  Network network;
  for (int k = 0; k < 60; ++k)
  {
    const double radius = 5 + 20 * uniform(random);
    const Vec3 centre = Vec3::Constant(0.5 * edge) + (edge - 2 * radius - 6) * vector(), normal = vector().normalized();
    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u), motion = shift * vector();
    std::vector<Vec3> points;
    for (int i = 0; i < 12; ++i)
    {
      const double angle = std::numbers::pi * i / 6;
      points.push_back(centre + motion + radius * (std::cos(angle) * u + std::sin(angle) * v));
    }
    add_line(network, points, 0.25 * vector().normalized(), {}, true, NodeConstraint::free);
  }
  for (int k = 0; k < 6; ++k)
  {
    std::vector<Vec3> points;
    const double y = edge * (0.1 + 0.8 * uniform(random)), z = edge * (0.1 + 0.8 * uniform(random));
    for (int i = 0; i <= 10; ++i)
      points.emplace_back(edge * i / 10, y + shift * std::sin(0.3 * i), z);
    add_line(network, points, Vec3(0.1, 0.2, 0.1), {}, false, NodeConstraint::surface);
  }
  return network;
}

/// Tolerance of the sums: a tenth of the setting.
SummationSettings together(const double tolerance)
{
  return {SummationMethod::multipole, 10 * tolerance};
}

template <class Vectors> double relative_difference(const Vectors &a, const Vectors &b)
{
  double sum = 0, scale = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    sum += std::pow((a[i] - b[i]).norm(), 2);
    scale += std::pow(b[i].norm(), 2);
  }
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  MPI_Allreduce(MPI_IN_PLACE, &scale, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return std::sqrt(sum / scale);
}

class SummedFields : public testing::TestWithParam<double>
{
protected:
  SummedFields()
  {
    fem::MeshParameters parameters;
    parameters.shape = fem::MeshParameters::Shape::box;
    parameters.size = {edge, edge, edge};
    parameters.subdivisions = {8, 8, 8};
    mesh = fem::make_mesh(MPI_COMM_WORLD, parameters);
    const std::array<bool, 3> all{true, true, true};
    problem = std::make_unique<fem::ElasticProblem>(*mesh, fem::ElasticProblem::Parameters{}, fem::Moduli{48e3, 0.34},
                                                    std::vector<fem::DisplacementCondition>{{4, all}, {5, all}});
    images = SurfaceImages(lines, image_planes(boundary_polygons(*mesh), {4, 5}), {100, 1e-8});
  }
  std::vector<dealii::Tensor<1, 3>> load(const SummationSettings &how)
  {
    const auto summary = problem->set_tractions(DislocationTractions(lines, &images, how, MPI_COMM_WORLD));
    EXPECT_EQ(summary.n_unresolved, 0U);
    n_evaluations = summary.n_evaluations;
    return problem->boundary_loads();
  }
  std::vector<Vec3> boundary_nodes() const { return to_vectors(problem->boundary_points()); }

  BoxShape shape{Vec3::Zero(), Vec3::Constant(edge)};
  Network network = random_network(0);
  LineSystem lines{medium, network, &shape, RayDirection::normal, nullptr, nullptr};
  fem::TriangulationPointer mesh;
  std::unique_ptr<fem::ElasticProblem> problem;
  SurfaceImages images;
  std::uint64_t n_evaluations = 0;
};

TEST_P(SummedFields, TractionsAreThoseOfEveryLineRayAndImage)
{
  const double tolerance = GetParam();
  const auto direct = load({SummationMethod::direct});
  const std::uint64_t pairs = n_evaluations;
  EXPECT_LT(relative_difference(load(together(tolerance)), direct), tolerance);
  EXPECT_LT(4 * n_evaluations, pairs) << "most pairs should be far";
}

TEST_P(SummedFields, ImagesAtSegmentsAndNodesAreThoseOfEveryImage)
{
  const double tolerance = GetParam();
  std::vector<Vec3> points;
  for (const SegmentIndex s : network.segments())
    for (const double fraction : {0.2, 0.5, 0.8})
      points.push_back(network.position(network.start(s)) + fraction * network.direction(s));
  const auto stress = stress_of_images(images, points, {SummationMethod::multipole, tolerance}, MPI_COMM_WORLD);
  EXPECT_LT(relative_difference(stress, images.stress(points)), tolerance);
  const ImageDisplacement displacement(images, 2, 1.0, together(tolerance));
  EXPECT_LT(relative_difference(displacement.at(boundary_nodes()), images.displacement(boundary_nodes())), tolerance);
}

TEST_P(SummedFields, PrescribedDisplacementsAreThoseOfEveryTriangleAndImage)
{
  const double tolerance = GetParam();
  const Network after = random_network(6);
  SweptArea area;
  for (const SegmentIndex s : network.segments())
  {
    const Vec3 &p = network.position(network.start(s)), &q = network.position(network.end(s));
    const Vec3 &p_new = after.position(after.start(s)), &q_new = after.position(after.end(s));
    area.add_triangle(p, p_new, q, network.burgers(s), network.plane(s));
    area.add_triangle(q, p_new, q_new, network.burgers(s), network.plane(s));
  }
  const SweptLoops swept(area);
  const SweptSummation fast{together(tolerance), MPI_COMM_WORLD};
  EXPECT_LT(relative_difference(swept_displacement(medium.nu, swept, boundary_nodes(), fast),
                                swept_displacement(medium.nu, swept, boundary_nodes(), {})),
            tolerance);
  const double bound = std::max(tolerance, fem::ElasticProblem::projection_tolerance);
  const auto project = [&](const fem::TractionField &field) { return problem->project_on_conditions(field); };
  EXPECT_LT(relative_difference(project(SweptDisplacement(swept, medium.nu, 2, 1e5, 2.0, fast)),
                                project(SweptDisplacement(swept, medium.nu, 2, 1e5, 2.0))),
            bound);
  EXPECT_LT(relative_difference(project(ImageDisplacement(images, 2, 2.0, together(tolerance))),
                                project(ImageDisplacement(images, 2, 2.0))),
            bound);
}

INSTANTIATE_TEST_SUITE_P(Tolerances, SummedFields, testing::Values(1e-3, 1e-4, 1e-6),
                         [](const auto &tolerance) { return "number" + std::to_string(tolerance.index); });
} // namespace
} // namespace ddfem::coupling
