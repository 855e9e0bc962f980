// The re-entrant mesh of meshes/: what is inside, and lines that cross its re-entrant edge.
#include "coupling/grain_geometry.h"
#include "coupling/simulation.h"
#include "tests/support/history.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <unistd.h>

namespace ddfem::coupling
{
namespace
{
const std::string step_file = std::string(DDFEM_SOURCE_DIR) + "/meshes/step.msh";

/// The profile of the step in x and z, nm, counter-clockwise; y runs from 0 to @p width.
const std::vector<Eigen::Vector2d> profile{{0, 0}, {1200, 0}, {1200, 400}, {600, 400}, {600, 800}, {0, 800}};
constexpr double width = 600;

double distance_to_piece(const Eigen::Vector2d &x, const Eigen::Vector2d &p, const Eigen::Vector2d &q)
{
  const double t = std::clamp((x - p).dot(q - p) / (q - p).squaredNorm(), 0.0, 1.0);
  return (x - p - t * (q - p)).norm();
}

/// Signed distance to the prism over the profile: the union of two blocks tells the side.
double exact_distance(const Vec3 &x)
{
  const Eigen::Vector2d flat(x[0], x[2]);
  double across = 1e300;
  for (std::size_t k = 0; k < profile.size(); ++k)
    across = std::min(across, distance_to_piece(flat, profile[k], profile[(k + 1) % profile.size()]));
  const bool low = x[0] > 0 && x[0] < 1200 && x[2] > 0 && x[2] < 400;
  const bool raised = x[0] > 0 && x[0] < 600 && x[2] > 0 && x[2] < 800;
  if (low || raised)
    across = -across;
  const double along = std::max(-x[1], x[1] - width);
  return across > 0 && along > 0 ? std::hypot(across, along) : std::max(across, along);
}

TEST(ReentrantMesh, InsideAndOutsideAndDistanceAreThoseOfTheStep)
{
  fem::MeshParameters p;
  p.shape = fem::MeshParameters::Shape::gmsh;
  p.file = step_file;
  p.length_unit_nm = 1000;
  const auto mesh = fem::make_mesh(MPI_COMM_WORLD, p);
  const auto shape = make_grain_shape(p, *mesh);
  EXPECT_FALSE(shape->is_convex());
  EXPECT_NEAR(shape->volume() / (1200.0 * 600 * 400 + 600.0 * 600 * 400), 1, 1e-12);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> u(-0.2, 1.2);
  for (int k = 0; k < 3000; ++k)
  {
    const Vec3 x(1200 * u(random), 600 * u(random), 800 * u(random));
    ASSERT_NEAR(shape->signed_distance(x), exact_distance(x), 1e-9) << x.transpose();
  }
  EXPECT_EQ(shape->face(Vec3(900, 300, 410)), 3); // tread
  EXPECT_EQ(shape->face(Vec3(610, 300, 700)), 4); // the wall above it
}

/// A run on the step with one loop on (111)[-101] at @p loop ("centre / radius / corners", m).
class StepRun
{
public:
  StepRun(const std::string &loop, const std::vector<std::string> &more)
  {
    InputDeck deck;
    for (const std::string &s :
         {std::string("Domain/Shape=mesh"), "Domain/Mesh file=" + step_file, std::string("Domain/Mesh unit=1e-6"),
          std::string("Boundary conditions/Fixed face=bottom"), std::string("Boundary conditions/Platen face=top"),
          "Microstructure/Loops=1 1 1 / -1 0 1 / " + loop, std::string("Discretisation/Minimum segment=1.2e-8"),
          std::string("Discretisation/Maximum segment=3e-8"), std::string("Domain/Traction tolerance=1e-5"),
          std::string("Domain/Elastic tolerance=1e-7"), // its residual is what the forces of both faces differ by
          std::string("Time stepping/Initial step=1e-12"), std::string("Output/Frame interval=0")})
      deck.set_from_command_line(s);
    for (const std::string &s : more)
      deck.set_from_command_line(s);
    const std::string directory =
        (std::filesystem::temp_directory_path() / ("ddfem_step_" + std::to_string(getpid()))).string();
    simulation = std::make_unique<Simulation>(interpret(deck), MPI_COMM_SELF);
    initial = ends_on_faces();
    {
      RunOutput output(directory, true);
      simulation->run(output);
    }
    history = test::read_history(directory + "/history.csv");
    std::filesystem::remove_all(directory);
  }

  /// Surface nodes on the tread and on the wall above it; everything must be in the grain or, for these, on it.
  std::array<int, 2> ends_on_faces() const
  {
    std::array<int, 2> n{};
    const Network &network = simulation->network();
    for (const NodeIndex i : network.nodes())
    {
      const Vec3 x = network.position(i);
      const bool surface = network.constraint(i) == NodeConstraint::surface;
      EXPECT_LT(exact_distance(x), 1e-6) << x.transpose();
      EXPECT_EQ(std::abs(exact_distance(x)) < 1e-6, surface) << x.transpose();
      n[0] += surface && std::abs(x[2] - 400) < 1e-6 ? 1 : 0;
      n[1] += surface && std::abs(x[0] - 600) < 1e-6 && x[2] > 400 ? 1 : 0;
    }
    EXPECT_TRUE(network.violations().empty());
    return n;
  }

  /// Tractions over the closed surface and forces of bottom and top balance in every row.
  void expect_balance() const
  {
    for (std::size_t i = 0; i < history.at("step").size(); ++i)
    {
      // Integrals to 1e-5 of each source, whose errors average out.
      EXPECT_LT(history.at("force imbalance [-]")[i], 1e-6);
      EXPECT_LT(history.at("moment imbalance [-]")[i], 1e-6);
      for (const char *const axis : {"x", "y", "z"})
      {
        const double top = history.at(std::string("platen force ") + axis + " [N]")[i],
                     bottom = history.at(std::string("fixed face force ") + axis + " [N]")[i];
        EXPECT_NEAR(top + bottom, 0, 1e-5 * std::abs(history.at("reaction platen [N]").back())) << axis;
      }
    }
  }

  std::unique_ptr<Simulation> simulation;
  std::array<int, 2> initial{};
  test::Columns history;
};

TEST(ReentrantMesh, ALoopAcrossTheEdgeIsCutAndItsTwoEndsSlideOnTreadAndWall)
{
  const StepRun run("6e-7 3e-7 4e-7 / 1.2e-7 / 24",
                    {"Microstructure/Cut at surface=true", "Loading/Type=none", "Time stepping/Maximum steps=6"});
  EXPECT_EQ(run.initial, (std::array<int, 2>{1, 1}));
  EXPECT_EQ(run.ends_on_faces(), (std::array<int, 2>{1, 1}));
  // Without load the line pulls itself together.
  EXPECT_LT(run.history.at("line length [m]").back(), 0.999 * run.history.at("line length [m]").front());
  run.expect_balance();
}

TEST(ReentrantMesh, ALoopThatGrowsOverTheEdgeFromInsideIsCutThere)
{
  const StepRun run("5.6e-7 3e-7 3.6e-7 / 8.5e-8 / 20",
                    {"Loading/Type=stages", "Loading/Stages=constant stress -6e8 until duration 1e-6",
                     "Time stepping/Maximum steps=12"});
  EXPECT_EQ(run.initial, (std::array<int, 2>{0, 0}));
  EXPECT_EQ(run.ends_on_faces(), (std::array<int, 2>{1, 1}));
  run.expect_balance();
}
} // namespace
} // namespace ddfem::coupling
