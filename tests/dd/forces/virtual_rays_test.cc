// Rays leave the grain for good, whatever its shape.
#include "dd/forces/virtual_rays.h"
#include "dd/geometry/reentrant_shapes.h"
#include "dd/geometry/surface_mesh_shape.h"
#include "samples/values.h"
#include "tests/dd/geometry/facetted_bodies.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <stdexcept>

namespace ddfem
{
namespace
{
/// Surface points of the shape, by projecting random points.
std::vector<Vec3> surface_points(const GrainShape &shape, const std::size_t n)
{
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<Vec3> points;
  while (points.size() < n)
  {
    const Vec3 x = shape.lower_corner() +
                   Vec3(u(random), u(random), u(random)).cwiseProduct(shape.upper_corner() - shape.lower_corner());
    if (const auto y = project_to_surface(shape, x, Vec3::Zero()))
      points.push_back(*y);
  }
  return points;
}

/// Whether the ray meets the inside of the grain, looked at every thousandth of the diameter.
bool reenters(const GrainShape &shape, const Vec3 &x, const Vec3 &d)
{
  for (int k = 1; k < 1500; ++k)
    if (shape.signed_distance(x + 1e-3 * k * shape.diameter() * d) < -1e-9 * shape.diameter())
      return true;
  return false;
}

/// @p least_blocked: of a thousand points, from how many the normal meets the grain again.
void check_rays(const GrainShape &shape, const std::size_t least_blocked)
{
  const std::size_t n = samples::sanitized ? 200 : 1000;
  std::size_t blocked = 0;
  for (const Vec3 &x : surface_points(shape, n))
  {
    blocked += reenters(shape, x, shape.outward_normal(x)) ? 1 : 0;
    for (const RayDirection rule : {RayDirection::normal, RayDirection::radial})
    {
      const Vec3 d = ray_direction(shape, rule, x);
      ASSERT_NEAR(d.norm(), 1, 1e-12);
      ASSERT_FALSE(reenters(shape, x, d)) << x.transpose() << " along " << d.transpose();
      ASSERT_EQ(d, ray_direction(shape, rule, x));
    }
  }
  EXPECT_GE(1000 * blocked, least_blocked * n);
}

TEST(VirtualRays, NeverReenterAPillarOnItsBase)
{
  check_rays(PillarShape(Vec3(0, 0, 0), {100, 300, 0.06, 40, 400, 120}), 0);
  check_rays(PillarShape(Vec3(0, 0, 0), {100, 300, 0, 0, 400, 120}), 0);
}

TEST(VirtualRays, NeverReenterACantilever)
{
  check_rays(CantileverShape(Vec3(0, 0, 0), Vec3(400, 80, 60), Vec3(150, 200, 180)), 0);
}

TEST(VirtualRays, LeaveAPitAndAGapBetweenTwoWalls)
{
  const std::array<std::vector<double>, 3> x{std::vector<double>{0, 50, 120, 160}, {0, 60, 110, 200}, {0, 50, 100}};
  // The walls of a pit face each other: their normals hit the opposite one.
  check_rays(SurfaceMeshShape(facetted_voxels(x, [](int i, int j, int k) { return k == 0 || i != 1 || j != 1; })), 60);
  check_rays(SurfaceMeshShape(facetted_voxels(x, [](int i, int, int k) { return k == 0 || i != 1; })), 200);
}

TEST(VirtualRays, FollowTheNormalWhereNothingIsInTheWay)
{
  const PillarShape shape(Vec3(0, 0, 0), {100, 300, 0.06, 40, 400, 120});
  for (const Vec3 &x : surface_points(shape, 1000))
  {
    EXPECT_EQ(ray_direction(shape, RayDirection::normal, x), shape.outward_normal(x)) << x.transpose();
  }
}

TEST(VirtualRays, ACavityHasNoWayOutAndSaysSo)
{
  const std::array<std::vector<double>, 3> x{
      std::vector<double>{0, 50, 100, 150}, {0, 50, 100, 150}, {0, 50, 100, 150}};
  const SurfaceMeshShape shape(facetted_voxels(x, [](int i, int j, int k) { return i != 1 || j != 1 || k != 1; }));
  EXPECT_NEAR(shape.signed_distance(Vec3(75, 75, 75)), 25, 1e-9); // the hollow is outside
  EXPECT_THROW(ray_direction(shape, RayDirection::normal, Vec3(75, 70, 50)), std::runtime_error);
  EXPECT_NO_THROW(ray_direction(shape, RayDirection::normal, Vec3(75, 70, 0)));
}
} // namespace
} // namespace ddfem
