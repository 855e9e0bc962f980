#include "coupling/energy_balance.h"
#include "dd/microstructure/sources.h"
#include "dd/topology/growth.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ddfem::coupling
{
namespace
{
const IsotropicMedium medium{26.5e3, 0.345, 0.286};
const Vec3 burgers = -0.286 * Vec3(0.6, 0.2, 0.5).normalized();

/// Positions of a loop of twelve corners about @p centre.
std::vector<Vec3> loop_points(const Vec3 &centre, const double radius)
{
  const Vec3 n = Vec3(0.4, -0.3, 1).normalized(), u = n.unitOrthogonal(), v = n.cross(u);
  std::vector<Vec3> points;
  for (int k = 0; k < 12; ++k)
    points.push_back(centre + radius * (std::cos(M_PI * k / 6) * u + std::sin(M_PI * k / 6) * v));
  return points;
}

/// The area between two positions of the loop: new line minus old line.
SweptArea area_between(const std::vector<Vec3> &from, const std::vector<Vec3> &to)
{
  SweptArea area;
  for (std::size_t k = 0; k < from.size(); ++k)
  {
    const std::size_t next = (k + 1) % from.size();
    area.add_triangle(from[k], to[k], to[next], burgers, {});
    area.add_triangle(from[k], to[next], from[next], burgers, {});
  }
  return area;
}

class LoopThatMoves
{
public:
  LoopThatMoves(const bool clamped, const std::array<unsigned, 3> &cells, const double image_depth)
      : grain(parameters(clamped, cells, image_depth), medium, MPI_COMM_WORLD)
  {
    place(loop_points(Vec3(72, 66, 140), 30));
    grain.set_reference(network, lines());
    solution = grain.solve(lines(), 0.2);
    balance.start(grain.boundary_state());
  }

  /// Moves the loop and the platen in @p steps; the work on the swept area is taken with the mean of the stresses before and after.
  void move(const int steps)
  {
    for (int k = 1; k <= steps; ++k)
    {
      const double s = double(k) / steps;
      const std::vector<Vec3> to = loop_points(Vec3(72 + 14 * s, 66, 140 + 20 * s), 30 + 10 * s);
      const SweptArea area = area_between(points, to);
      const std::vector<Vec3> centres = swept_centres(area, &grain.shape());
      const double before = work_on_area(area, grain.stress_of_elements(centres));
      grain.add_swept(area);
      place(to);
      grain.solve(lines(), 0.2 + 0.1 * s);
      const double mean = 0.5 * (before + work_on_area(area, grain.stress_of_elements(centres)));
      balance.add(grain.boundary_state(), {.total = mean, .external = mean}, MPI_COMM_WORLD);
    }
  }

  EnergyBalance balance;

private:
  static GrainParameters parameters(const bool clamped, const std::array<unsigned, 3> &cells, const double image_depth)
  {
    GrainParameters p;
    p.mesh.size = {150, 120, 300};
    p.mesh.subdivisions = cells;
    p.clamped = clamped;
    p.image_depth = image_depth;
    p.elasticity.relative_tolerance = 1e-10;
    p.reference = ReferenceState::perfect_crystal;
    return p;
  }
  void place(const std::vector<Vec3> &at)
  {
    points = at;
    network = Network();
    add_line(network, points, burgers, {}, true, NodeConstraint::free);
  }
  LineSystem lines() const { return {medium, network, &grain.shape(), RayDirection::normal, nullptr, nullptr}; }

  FiniteGrain grain;
  Network network;
  std::vector<Vec3> points;
  GrainSolution solution;
};

TEST(EnergyBalance, WorkOfThePlatensIsStoredOrDoneOnTheLines)
{
  for (const bool clamped : {true, false})
  {
    LoopThatMoves coarse(clamped, {4, 4, 8}, 0), fine(clamped, {6, 6, 12}, 0), with_images(clamped, {4, 4, 8}, 4);
    coarse.move(4);
    fine.move(4);
    with_images.move(4);
    const Energies &e = fine.balance.energies();
    EXPECT_GT(e.dissipated, 0.05 * std::abs(e.work));
    // The loop passes the surface at 1.2 elements of the fine mesh. The error falls with the square of the element size at least.
    const double order_two = std::pow(4.0 / 6.0, 2);
    EXPECT_LT(std::abs(e.mismatch()), order_two * std::abs(coarse.balance.energies().mismatch()));
    EXPECT_LT(std::abs(e.mismatch()), 0.05 * e.dissipated);
    EXPECT_LT(std::abs(e.mismatch()), 0.005 * std::abs(e.work));
    // Images leave the elements what they resolve; the rest is the mid-point rule on the swept triangles and the trapezoid rule of
    // four steps, of the order of (step / depth)^2 / 12 = 1e-3 of what is done on the lines.
    EXPECT_LT(std::abs(with_images.balance.energies().mismatch()), 1e-3 * e.dissipated);
  }
}
} // namespace
} // namespace ddfem::coupling
