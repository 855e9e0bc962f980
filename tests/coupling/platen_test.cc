#include "coupling/convert.h"
#include "coupling/dislocation_tractions.h"
#include "coupling/finite_grain.h"
#include "dd/microstructure/sources.h"
#include "dd/topology/growth.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ddfem::coupling
{
namespace
{
const IsotropicMedium medium{26.5e3, 0.345, 0.286};

GrainParameters box(const std::array<double, 3> &size, const std::array<unsigned, 3> &cells, const PlatenMotion motion)
{
  GrainParameters p;
  p.mesh.origin = {40, -30, 100};
  p.mesh.size = size;
  p.mesh.subdivisions = cells;
  p.elasticity.relative_tolerance = 1e-11;
  p.platen_motion = motion;
  p.reference = ReferenceState::perfect_crystal;
  p.image_depth = 0; // the finite elements alone are compared
  return p;
}

void add_loop(Network &network, const Vec3 &centre, const Vec3 &n, const double radius, const Vec3 &b)
{
  const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
  std::vector<Vec3> points;
  for (int k = 0; k < 10; ++k)
    points.push_back(centre + radius * (std::cos(M_PI * k / 5) * u + std::sin(M_PI * k / 5) * v));
  add_line(network, points, b, {}, true, NodeConstraint::free);
}

/// A grain that holds one loop, grown from nothing.
struct LoopInGrain
{
  explicit LoopInGrain(const GrainParameters &p)
      : grain(p, medium, MPI_COMM_WORLD), network(loop(grain.shape())),
        lines(medium, network, &grain.shape(), RayDirection::normal, nullptr, nullptr)
  {
    grain.set_reference(network, lines);
  }
  static Network loop(const GrainShape &shape)
  {
    Network network;
    add_loop(network, 0.55 * shape.lower_corner() + 0.45 * shape.upper_corner(), Vec3(0.4, -0.3, 1).normalized(), 30,
             0.286 * Vec3(0.6, 0.2, 0.5).normalized());
    return network;
  }
  FiniteGrain grain;
  Network network;
  LineSystem lines;
};

class EveryMotion : public testing::TestWithParam<PlatenMotion>
{
};

TEST_P(EveryMotion, ScaledUnitResponseEqualsADirectSolve)
{
  const GrainParameters p = box({150, 120, 300}, {2, 2, 3}, GetParam());
  LoopInGrain body(p);
  const double q = 0.01 / body.grain.platen().displacement(Vec3(190, 90, 400)).norm();
  const GrainSolution solution = body.grain.solve(body.lines, q);

  // The same problem once more, with everything prescribed at once.
  const auto mesh = fem::make_mesh(MPI_COMM_WORLD, p.mesh);
  fem::ElasticProblem direct(
      *mesh, p.elasticity, {medium.mu, medium.nu},
      {{4, body.grain.platen().held_by_fixed_face(p.clamped)}, {5, body.grain.platen().held_by_platen(p.clamped)}});
  direct.set_tractions(DislocationTractions(body.lines));
  const auto infinite = body.grain.boundary_state().infinite;
  std::vector<dealii::Tensor<1, 3>> prescribed;
  for (std::size_t i = 0; i < infinite.size(); ++i)
  {
    const auto &x = direct.boundary_points()[i];
    const Vec3 u = std::abs(x[2] - 400) < 1e-6 ? Vec3(q * body.grain.platen().displacement(to_vec3(x))) : Vec3::Zero();
    prescribed.push_back(to_tensor(u) - infinite[i]);
  }
  direct.solve(prescribed);
  const std::vector<Vec3> points{{60, 20, 130}, {115, 30, 250}, {170, 80, 380}};
  const auto superposed = body.grain.correction_stress(points);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const SymTensor expected = to_sym_tensor(direct.stress_at({to_point(points[i])})[0]);
    EXPECT_LT((superposed[i] - expected).norm(), 1e-8 * expected.norm());
  }
  EXPECT_LT((solution.platen_force - to_vec3(direct.reaction(5))).norm(), 1e-8 * solution.platen_force.norm() + 1e-6);
}

TEST_P(EveryMotion, ForcesAndMomentsOfTheTwoFacesBalance)
{
  LoopInGrain body(box({150, 120, 300}, {2, 2, 3}, GetParam()));
  const double q = 0.1 / body.grain.platen().displacement(Vec3(190, 90, 400)).norm();
  const GrainSolution s = body.grain.solve(body.lines, q);
  // Both moments about the centre of the platen; the fixed face lies 300 nm below. The scale is that of the load. What is left is the
  // error of the traction integrals (1e-6 of the magnitude of the tractions).
  const double force = s.platen_force.norm(), moment = s.platen_moment.norm() + 300 * force;
  EXPECT_GT(moment, 1e3);
  EXPECT_LT((s.platen_force + s.fixed_force).norm(), 1e-5 * moment / 300);
  EXPECT_LT((s.platen_moment + s.fixed_moment + Vec3(0, 0, -300).cross(s.fixed_force)).norm(), 1e-5 * moment);
}

INSTANTIATE_TEST_SUITE_P(Platen, EveryMotion,
                         testing::Values(PlatenMotion::axial, PlatenMotion::transverse, PlatenMotion::twist,
                                         PlatenMotion::bending));

TEST(Platen, LoadIsWhatDoesWorkOnTheMotion)
{
  // The elastic energy of a grain without lines is q Q / 2, for every motion: checked with the work of the nodal reactions.
  for (const PlatenMotion motion :
       {PlatenMotion::axial, PlatenMotion::transverse, PlatenMotion::twist, PlatenMotion::bending})
  {
    FiniteGrain grain(box({150, 120, 300}, {2, 2, 3}, motion), medium, MPI_COMM_WORLD);
    const Network nothing;
    const LineSystem no_lines(medium, nothing, &grain.shape(), RayDirection::normal, nullptr, nullptr);
    grain.set_reference(nothing, no_lines);
    const double q = 1e-3;
    const GrainSolution s = grain.solve(no_lines, q);
    const double expected = motion == PlatenMotion::axial        ? s.platen_force[2]
                            : motion == PlatenMotion::transverse ? s.platen_force[0]
                            : motion == PlatenMotion::twist      ? s.platen_moment[2]
                                                                 : -s.platen_moment[1];
    EXPECT_NEAR(s.load / expected, 1, 1e-9);
    EXPECT_GT(s.load, 0);
    const BoundaryState b = grain.boundary_state();
    double twice_energy = 0;
    for (std::size_t i = 0; i < b.reaction.size(); ++i)
      twice_energy += b.reaction[i] * b.correction[i];
    MPI_Allreduce(MPI_IN_PLACE, &twice_energy, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    EXPECT_NEAR(twice_energy / (q * s.load), 1, 1e-9);
    EXPECT_NEAR(s.load * grain.platen().stress_per_load() / (q * grain.platen().strain_per_motion()) /
                    grain.unit_load_modulus(),
                1, 1e-9);
  }
}

TEST(Platen, TwistOfARoundBarFollowsTheTorsionFormula)
{
  for (const bool clamped : {true, false}) // a round section does not warp: the axial displacement may be held or free
  {
    GrainParameters p;
    p.mesh.shape = fem::MeshParameters::Shape::cylinder;
    p.mesh.radius = 100;
    p.mesh.height = 350;
    p.mesh.subdivisions = {4, 4, 3};
    p.clamped = clamped;
    p.elasticity.relative_tolerance = 1e-11;
    p.platen_motion = PlatenMotion::twist;
    FiniteGrain grain(p, medium, MPI_COMM_WORLD);
    const Network nothing;
    const LineSystem no_lines(medium, nothing, &grain.shape(), RayDirection::normal, nullptr, nullptr);
    const double theta = 2e-3;
    const GrainSolution s = grain.solve(no_lines, theta);
    // The displacement theta z (-y, x, 0)/L is in the space of quadratic elements: exact for the section of the mesh, but for the
    // rule of three points of the stiffness, which integrates degree 5, while r^2 dA has degree 7 on curved cells (3e-6) ...
    EXPECT_NEAR(grain.unit_load_modulus() / medium.mu, 1, 1e-5);
    // ... whose boundary is made of eight parabolas: polar moment = sum of int r^2 (x y' - y x')/4 dt.
    double polar = 0;
    for (int k = 0; k < 2000; ++k)
    {
      const double t = -1 + (k + 0.5) / 1000, bulge = 1 - std::cos(M_PI / 8), x = 1 - bulge * t * t,
                   y = std::sin(M_PI / 8) * t;
      polar += 8 * (x * x + y * y) * (x * std::sin(M_PI / 8) + 2 * y * bulge * t) / 4 * std::pow(100.0, 4) / 1000;
    }
    EXPECT_NEAR(polar / (M_PI * std::pow(100.0, 4) / 2), 1, 2e-3);
    EXPECT_NEAR(s.platen_moment[2] / (medium.mu * polar * theta / 350), 1, 1e-5);
    EXPECT_NEAR(s.fixed_moment[2] / s.platen_moment[2], -1, 1e-8);
    EXPECT_LT(s.platen_force.norm(), 1e-8 * s.platen_moment[2] / 100);
  }
}

TEST(Platen, FrictionlessBendingIsPureBending)
{
  for (const int across : {0, 1})
  {
    GrainParameters p = box({150, 120, 300}, {2, 3, 3}, PlatenMotion::bending);
    p.clamped = false;
    p.across_axis = across;
    FiniteGrain grain(p, medium, MPI_COMM_WORLD);
    EXPECT_NEAR(grain.unit_load_modulus() / medium.youngs_modulus(), 1, 1e-8);
    const Network nothing;
    const LineSystem no_lines(medium, nothing, &grain.shape(), RayDirection::normal, nullptr, nullptr);
    const double theta = 1e-3;
    const GrainSolution s = grain.solve(no_lines, theta);
    // Linear in the distance from the neutral plane, everywhere.
    for (const Vec3 &x : {Vec3(60, 20, 130), Vec3(150, -10, 250), Vec3(180, 80, 380)})
    {
      SymTensor expected = SymTensor::Zero();
      expected[2] = medium.youngs_modulus() * theta / 300 * (x - Vec3(115, 30, 0))[across];
      EXPECT_LT((grain.correction_stress({x})[0] - expected).norm(), 1e-7 * medium.youngs_modulus() * theta);
    }
    EXPECT_LT(s.platen_force.norm(), 1e-8 * s.platen_moment.norm() / 100);
  }
}

TEST(Platen, EndLoadOfACantileverFollowsTimoshenko)
{
  const double length = 1600, depth = 100, width = 80, nu = medium.nu, e = medium.youngs_modulus();
  GrainParameters p = box({length, width, depth}, {32, 2, 4}, PlatenMotion::transverse);
  p.fixed_face = "x-";
  p.platen_face = "x+";
  p.across_axis = 2;
  p.elasticity.relative_tolerance = 1e-8;
  FiniteGrain grain(p, medium, MPI_COMM_WORLD);
  const Network nothing;
  const LineSystem no_lines(medium, nothing, &grain.shape(), RayDirection::normal, nullptr, nullptr);
  const double w = 3;
  const GrainSolution s = grain.solve(no_lines, w);
  // Cowper, J. Appl. Mech. 33 (1966) 335: shear coefficient of a rectangle.
  const double inertia = width * std::pow(depth, 3) / 12, kappa = 10 * (1 + nu) / (12 + 11 * nu);
  const double bending = 3 * e * inertia / std::pow(length, 3);
  const double shear = kappa * width * depth * medium.mu / length;
  EXPECT_NEAR(s.platen_force[2] / (w / (1 / bending + 1 / shear)), 1, 0.01);
  EXPECT_NEAR(s.fixed_moment[1] / (length * s.platen_force[2]), 1, 1e-3);
  EXPECT_EQ(s.platen_force[0], 0); // only the transverse displacement is held
}

TEST(Platen, AGrainThatIsNotHeldFeelsNoLoad)
{
  LoopInGrain body(box({150, 120, 300}, {2, 2, 3}, PlatenMotion::none));
  const GrainSolution s = body.grain.solve(body.lines, 0);
  EXPECT_EQ(body.grain.unit_load_modulus(), 0);
  EXPECT_EQ(s.load, 0);
  EXPECT_EQ(s.platen_force.norm() + s.fixed_force.norm() + s.platen_moment.norm() + s.fixed_moment.norm(), 0);
  EXPECT_LT(s.solve.unbalanced_load, 1e-5); // tractions of a closed loop, integrated to 1e-6
  EXPECT_GT(body.grain.correction_stress({Vec3(115, 30, 250)})[0].norm(), 1e-3);
}

TEST(Platen, TransverseAxisMustLieAcrossTheGrain)
{
  GrainParameters p = box({150, 120, 300}, {2, 2, 3}, PlatenMotion::bending);
  p.across_axis = 2;
  EXPECT_THROW(FiniteGrain(p, medium, MPI_COMM_WORLD), std::runtime_error);
}
} // namespace
} // namespace ddfem::coupling
