#include "fem/face_section.h"
#include "support.h"

#include <gtest/gtest.h>

namespace ddfem::fem::test
{
namespace
{
constexpr double strain = 1e-3;

struct Case
{
  MeshParameters mesh;
  dealii::types::boundary_id bottom, top;
  unsigned degree;
  const char *name;
};

void PrintTo(const Case &c, std::ostream *stream)
{
  *stream << c.name << " degree " << c.degree;
}

class Bar : public testing::TestWithParam<Case>
{
};

const std::vector<Case> bars = {{box({300., 200., 700.}, {3, 2, 4}, {-50., 20., 1000.}), 4, 5, 1, "box"},
                                {box({300., 200., 700.}, {3, 2, 4}, {-50., 20., 1000.}), 4, 5, 2, "box"},
                                {mesh_file("bar.msh"), 1, 2, 1, "bar.msh"},
                                {mesh_file("bar.msh"), 1, 2, 2, "bar.msh"},
                                {mesh_file("pillar.msh"), 1, 2, 1, "pillar.msh"},
                                {mesh_file("pillar.msh"), 1, 2, 2, "pillar.msh"},
                                {cylinder(100., 300., 5, 3), 1, 2, 1, "cylinder"},
                                {cylinder(100., 300., 5, 3), 1, 2, 2, "cylinder"}};
} // namespace

TEST_P(Bar, PulledBetweenFrictionlessPlatensIsInUniaxialStress)
{
  const auto &[parameters, bottom, top, degree, name] = GetParam();
  const auto mesh = make_mesh(MPI_COMM_WORLD, parameters);
  const auto [low, high] = bounding_box(*mesh);
  ElasticProblem problem(*mesh, accurate(degree), copper,
                         {{bottom, {false, false, true}}, {top, {false, false, true}}});
  EXPECT_EQ(problem.n_free_rigid_modes(), 3u);
  const double length = high[2] - low[2];
  const auto info = problem.solve(prescribe(problem,
                                            [&, z0 = low[2]](const Point &x) {
                                              return Vector({0., 0., strain * (x[2] - z0)});
                                            }));
  EXPECT_LT(info.final_residual, 1e-12);
  const double sigma = youngs_modulus(copper) * strain, force = sigma * problem.boundary_area(top);
  EXPECT_NEAR(problem.reaction(top)[2] / force, 1., 1e-10);
  EXPECT_NEAR(problem.reaction(bottom)[2] / force, -1., 1e-10);
  EXPECT_EQ(problem.reaction(top)[0], 0.);
  EXPECT_NEAR(problem.volume() / (problem.boundary_area(top) * length), 1., 1e-12);
  const auto points = scattered_points(low + 0.2 * (high - low), high - 0.2 * (high - low), 50);
  const auto stresses = problem.stress_at(points);
  const auto displacements = problem.displacement_at(points);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    Stress expected;
    expected[2][2] = sigma;
    EXPECT_LT((stresses[i] - expected).norm(), 1e-8 * sigma);
    // Contraction about the axis, no rigid motion.
    const Vector arm = points[i] - problem.centre();
    const Vector u({-copper.nu * strain * arm[0], -copper.nu * strain * arm[1], strain * (points[i][2] - low[2])});
    EXPECT_LT((displacements[i] - u).norm(), 1e-8 * strain * length);
  }
}

INSTANTIATE_TEST_SUITE_P(Elasticity, Bar, testing::ValuesIn(bars));

TEST(Elasticity, QuadraticSolutionsAreExactWithQuadraticElements)
{
  const double k = 1e-6, nu = copper.nu;
  struct Solution
  {
    const char *name;
    std::function<Vector(const Point &)> displacement;
    std::function<dealii::Tensor<2, 3>(const Point &)> gradient;
  };
  const std::vector<Solution> solutions = {
      {"pure bending",
       [=](const Point &x) {
         return k * Vector({x[0] * x[2], -nu * x[1] * x[2], -0.5 * (x[0] * x[0] + nu * (x[2] * x[2] - x[1] * x[1]))});
       },
       [=](const Point &x) {
         return k *
                dealii::Tensor<2, 3>({{x[2], 0., x[0]}, {0., -nu * x[2], -nu * x[1]}, {-x[0], nu * x[1], -nu * x[2]}});
       }},
      {"torsion of a round bar",
       [=](const Point &x) {
         return k * Vector({-x[1] * x[2], x[0] * x[2], 0.});
       },
       [=](const Point &x) {
         return k * dealii::Tensor<2, 3>({{0., -x[2], -x[1]}, {x[2], 0., x[0]}, {0., 0., 0.}});
       }}};
  for (const auto &mesh_parameters : {box({300., 200., 400.}, {2, 2, 3}, {-120., 40., 10.}), mesh_file("bar.msh")})
  {
    const auto mesh = make_mesh(MPI_COMM_WORLD, mesh_parameters);
    std::vector<DisplacementCondition> conditions;
    for (const auto &entry : boundary_areas(*mesh))
    {
      conditions.push_back({entry.first, {true, true, true}});
    }
    ElasticProblem problem(*mesh, accurate(2), copper, conditions);
    EXPECT_EQ(problem.n_free_rigid_modes(), 0u);
    const auto [low, high] = bounding_box(*mesh);
    for (const auto &solution : solutions)
    {
      problem.solve(prescribe(problem, solution.displacement));
      const auto points = scattered_points(low, high, 60);
      const auto stresses = problem.stress_at(points);
      const auto displacements = problem.displacement_at(points);
      const double scale = k * copper.mu * high.norm();
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        EXPECT_LT((displacements[i] - solution.displacement(points[i])).norm(), 1e-10 * k * high.norm_square())
            << solution.name;
        EXPECT_LT((stresses[i] - hooke(copper, solution.gradient(points[i]))).norm(), 1e-8 * scale) << solution.name;
      }
    }
  }
}

TEST(Elasticity, RoundBarTwistedByTorquesOnItsEndsTurnsExactlyWithQuadraticElements)
{
  // sigma_theta_z = mu k r. On the curved elements too: z x and z y are products of their coordinate functions.
  const double radius = 100., length = 300., twist = 1e-5;
  const auto mesh = make_mesh(MPI_COMM_WORLD, cylinder(radius, length, 4, 3));
  ElasticProblem problem(*mesh, accurate(2), copper, {});
  const auto stress_of_twist = [&](const Point &x)
  {
    Stress s;
    s[0][2] = -copper.mu * twist * x[1];
    s[1][2] = copper.mu * twist * x[0];
    return s;
  };
  problem.set_tractions(FunctionField([&](const Point &x) { return -1. * stress_of_twist(x); }));
  problem.solve(prescribe(problem, [](const Point &) { return Vector(); }));
  const auto points = scattered_points({-60., -60., 10.}, {60., 60., 290.}, 40);
  const auto stresses = problem.stress_at(points);
  const auto displacements = problem.displacement_at(points);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    // The recovery is exact on affine cells only.
    EXPECT_LT((stresses[i] - stress_of_twist(points[i])).norm(), 1e-2 * copper.mu * twist * radius);
    const Vector u = twist * (points[i][2] - 0.5 * length) * Vector({-points[i][1], points[i][0], 0.});
    EXPECT_LT((displacements[i] - u).norm(), 1e-9 * twist * length * radius);
  }
}

TEST(Elasticity, CantileverBendsLikeATimoshenkoBeam)
{
  // Slender: the clamp, which also stops the contraction that the formula allows, stiffens by about 0.1 depth / length.
  const double length = 1600., depth = 100., width = 80., nu = copper.nu;
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({length, width, depth}, {32, 2, 4}));
  ElasticProblem problem(*mesh, {}, copper, {{0, {true, true, true}}});
  const double force = 1e5;
  problem.add_uniform_traction(1, Vector({0., 0., force / (width * depth)}));
  problem.solve(prescribe(problem, [](const Point &) { return Vector(); }));
  const double inertia = width * std::pow(depth, 3) / 12., e = youngs_modulus(copper);
  const double kappa = 10. * (1. + nu) / (12. + 11. * nu);
  const double bending = force * std::pow(length, 3) / (3. * e * inertia);
  const double expected = bending * (1. + 3. * e * inertia / (kappa * width * depth * copper.mu * length * length));
  const double tip = problem.displacement_at({Point(length, width / 2., depth / 2.)})[0][2];
  EXPECT_NEAR(tip / expected, 1., 0.01);
  EXPECT_NEAR(problem.reaction(0)[2] / force, -1., 1e-6);
  EXPECT_NEAR(problem.reaction(0)[0] / force, 0., 1e-6);
}

TEST(Elasticity, ReactionMomentOfAClampedEndHoldsTheLoad)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({300., 80., 100.}, {4, 2, 2}, {-20., 10., 30.}));
  ElasticProblem problem(*mesh, accurate(2), copper, {{0, {true, true, true}}});
  const Vector traction({3., -2., 5.});
  problem.add_uniform_traction(1, traction);
  problem.solve(prescribe(problem, [](const Point &) { return Vector(); }));
  const Vector force = 80. * 100. * traction;
  for (const Point &about : {Point(-20., 50., 80.), Point(1e3, -2e3, 5e2)})
  {
    const Vector of_load = cross_product_3d(Point(280., 50., 80.) - about, force);
    EXPECT_LT((problem.reaction_moment(0, about) + of_load).norm(), 1e-8 * of_load.norm());
  }
  EXPECT_EQ(problem.reaction_moment(1, Point()).norm(), 0.); // nothing is held there
  // Loads and reactions at the nodes are in equilibrium.
  Vector sum;
  const auto loads = problem.boundary_loads(), reactions = problem.boundary_reactions();
  for (std::size_t i = 0; i < loads.size(); ++i)
  {
    sum += loads[i] + reactions[i];
  }
  MPI_Allreduce(MPI_IN_PLACE, sum.begin_raw(), 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  EXPECT_LT(sum.norm(), 1e-8 * force.norm());
}

TEST(FaceSection, OfARectangleAndOfADisc)
{
  const auto block = make_mesh(MPI_COMM_WORLD, box({300., 80., 100.}, {4, 3, 2}, {1e5, 10., 30.}));
  const FaceSection rectangle = face_section(*block, 1);
  EXPECT_NEAR(rectangle.area, 80. * 100., 1e-6);
  EXPECT_LT(rectangle.centre.distance(Point(1e5 + 300., 50., 80.)), 1e-6);
  EXPECT_NEAR(rectangle.second[1][1] / (100. * std::pow(80., 3) / 12.), 1., 1e-9);
  EXPECT_NEAR(rectangle.second[2][2] / (80. * std::pow(100., 3) / 12.), 1., 1e-9);
  EXPECT_LT(std::abs(rectangle.second[0][0]) + std::abs(rectangle.second[0][1]) + std::abs(rectangle.second[1][2]),
            1e-3);
  const auto rod = make_mesh(MPI_COMM_WORLD, cylinder(100., 300., 5, 3));
  const FaceSection disc = face_section(*rod, 2);
  // Arcs are parabolas: an error of the fourth order in the angle of a face.
  EXPECT_NEAR(trace(disc.second) / (M_PI * std::pow(100., 4) / 2.), 1., 1e-3);
  EXPECT_EQ(face_section(*rod, 77).area, 0.);
}

TEST(Elasticity, UnloadedGrainIsExactlyAtRest)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({100., 100., 100.}, {2, 2, 2}));
  ElasticProblem problem(*mesh, {}, copper, {});
  const auto info = problem.solve(prescribe(problem, [](const Point &) { return Vector({1., 2., 3.}); }));
  EXPECT_EQ(info.iterations, 0u);
  for (const auto &u : problem.boundary_displacements())
  {
    EXPECT_EQ(u.norm(), 0.);
  }
}

TEST(Elasticity, ReactionsOfClampedEndsBalanceTheTractions)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({200., 200., 400.}, {2, 2, 4}));
  ElasticProblem problem(*mesh, accurate(2), copper, {{4, {true, true, true}}, {5, {true, true, true}}});
  const PointForce force{Point(260., 90., 150.), Vector({3e4, -2e4, 1e4}), copper};
  problem.set_tractions(field_of(force));
  problem.add_uniform_traction(1, Vector({5., 6., 7.}));
  problem.solve(prescribe(problem, [](const Point &) { return Vector(); }));
  // Only the uniform traction is not in equilibrium by itself.
  const Vector balance = problem.reaction(4) + problem.reaction(5) + 200. * 400. * Vector({5., 6., 7.});
  EXPECT_LT(balance.norm(), 1e-6 * problem.reaction(4).norm());
  EXPECT_GT(problem.reaction(4).norm(), 1e4);
}

TEST(Elasticity, ReactionIsThatOfTheTotalField)
{
  // sigma~ uniaxial between frictionless ends that do not move: no correction is needed, the ends carry sigma~.
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({200., 100., 400.}, {2, 2, 4}));
  ElasticProblem problem(*mesh, accurate(2), copper, {{4, {false, false, true}}, {5, {false, false, true}}});
  const FunctionField field(
      [](const Point &)
      {
        Stress s;
        s[2][2] = 70.;
        return s;
      });
  problem.set_tractions(field);
  problem.solve(prescribe(problem, [](const Point &) { return Vector(); }));
  EXPECT_NEAR(problem.reaction(5)[2], 70. * 200. * 100., 1e-3);
  EXPECT_NEAR(problem.reaction(4)[2], -70. * 200. * 100., 1e-3);
  for (const auto &u : problem.boundary_displacements())
  {
    EXPECT_LT(u.norm(), 1e-10);
  }
}

namespace
{
/// Linear stress in equilibrium about c: bending, torsion and a constant part.
Stress linear_stress(const Point &x, const Point &c)
{
  const Vector r = x - c;
  Stress s;
  s[0][0] = 30. + 0.5 * r[2];
  s[1][1] = -20.;
  s[0][1] = 10. - 0.2 * r[2];
  s[2][2] = 5. + 0.3 * r[0];
  return s;
}
} // namespace

TEST(Elasticity, FreeGrainDeformsWithoutRigidMotionWhereverItIs)
{
  std::vector<Vector> reference;
  for (const auto &origin : {std::array<double, 3>{0., 0., 0.}, std::array<double, 3>{1e5, -3e5, 7e4}})
  {
    const auto mesh = make_mesh(MPI_COMM_WORLD, box({200., 300., 400.}, {2, 3, 4}, origin));
    ElasticProblem problem(*mesh, accurate(2), copper, {});
    EXPECT_EQ(problem.n_free_rigid_modes(), 6u);
    const Point centre = problem.centre();
    const auto summary = problem.set_tractions(FunctionField([&](const Point &x) { return linear_stress(x, centre); }));
    EXPECT_LT(summary.force.norm(), 1e-8 * summary.absolute_force);
    EXPECT_LT(summary.moment.norm(), 1e-8 * summary.absolute_moment);
    const auto info = problem.solve(prescribe(problem, [](const Point &) { return Vector(); }));
    EXPECT_LT(info.unbalanced_load, 1e-8);
    const Point low(origin[0], origin[1], origin[2]), high = low + Vector({200., 300., 400.});
    const auto points = scattered_points(low, high, 40);
    const auto stresses = problem.stress_at(points);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      EXPECT_LT((stresses[i] + linear_stress(points[i], centre)).norm(), 1e-6);
    }
    // Volume integrals of u and of the arm x u by the eight-point rule of each cell, exact for quadratic u up to cubes.
    std::vector<Point> gauss;
    for (unsigned k = 0; k < 2 * 3 * 4 * 27; ++k)
    {
      const std::array<double, 3> place = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)};
      const unsigned cell = k / 27, q = k % 27;
      gauss.push_back(
          low + 100. * Vector({cell % 2 + place[q % 3], cell / 2 % 3 + place[q / 3 % 3], cell / 6 + place[q / 9]}));
    }
    const auto displacements = problem.displacement_at(gauss);
    Vector mean, spin;
    const std::array<double, 3> weight = {5. / 18., 8. / 18., 5. / 18.};
    for (std::size_t k = 0; k < gauss.size(); ++k)
    {
      const std::size_t q = k % 27;
      const double w = weight[q % 3] * weight[q / 3 % 3] * weight[q / 9] / 24.;
      mean += w * displacements[k];
      spin += w * cross_product_3d(gauss[k] - centre, displacements[k]);
    }
    double largest = 0.;
    for (const auto &u : displacements)
    {
      largest = std::max(largest, u.norm());
    }
    EXPECT_LT(mean.norm(), 1e-9 * largest);
    EXPECT_LT(spin.norm(), 1e-9 * largest * 200.);
    if (reference.empty())
    {
      reference = displacements;
    }
    for (std::size_t k = 0; k < gauss.size(); ++k)
    {
      EXPECT_LT((displacements[k] - reference[k]).norm(), 1e-8 * largest);
    }
  }
}

TEST(Elasticity, MistakesAreRefused)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({100., 100., 100.}, {2, 2, 2}));
  const auto make = [&](unsigned degree, Moduli moduli, dealii::types::boundary_id id)
  {
    ElasticProblem::Parameters parameters;
    parameters.degree = degree;
    ElasticProblem(*mesh, parameters, moduli, {{id, {true, true, true}}});
  };
  EXPECT_THROW(make(3, copper, 0), std::invalid_argument);
  EXPECT_THROW(make(1, {-1., 0.3}, 0), std::invalid_argument);
  EXPECT_THROW(make(1, {1., 0.5}, 0), std::invalid_argument);
  EXPECT_THROW(make(1, copper, 6), std::invalid_argument);
  ElasticProblem problem(*mesh, {}, copper, {{0, {true, true, true}}});
  EXPECT_THROW(problem.add_uniform_traction(9, Vector()), std::invalid_argument);
  EXPECT_THROW(problem.solve(std::vector<Vector>(problem.boundary_points().size() + 1)), std::invalid_argument);
  EXPECT_THROW(problem.stress_at({Point(50., 50., 103.)}), std::runtime_error);
  EXPECT_THROW(problem.stress_at({Point(50., 50., std::nan(""))}), std::runtime_error);
  EXPECT_NO_THROW(problem.stress_at({Point(50., 50., 100.5)}));
  problem.set_tractions(FunctionField([](const Point &) { return std::nan("") * dealii::unit_symmetric_tensor<3>(); }));
  EXPECT_THROW(problem.solve(prescribe(problem, [](const Point &) { return Vector(); })), std::runtime_error);
}
} // namespace ddfem::fem::test
