#include "dd/geometry/grain_shape.h"

#include <gtest/gtest.h>

#include <numbers>

namespace ddfem
{
namespace
{
std::vector<PolyhedronShape::Facet> unit_cube_facets()
{
  std::vector<PolyhedronShape::Facet> facets;
  for (int c = 0; c < 3; ++c)
    for (int side = 0; side < 2; ++side)
    {
      PolyhedronShape::Facet f;
      f.face_id = 2 * c + side;
      for (const auto &[u, v] : {std::pair(0.0, 0.0), {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})
      {
        Vec3 x;
        x[c] = side;
        x[(c + 1) % 3] = u;
        x[(c + 2) % 3] = v;
        f.vertices.push_back(x);
      }
      facets.push_back(f);
    }
  return facets;
}

TEST(GrainShape, BoxKnowsInsideFacesAndVolume)
{
  const BoxShape box(Vec3(-1, -2, 0), Vec3(1, 2, 6));
  EXPECT_DOUBLE_EQ(box.signed_distance({0, 0, 3}), -1);
  EXPECT_DOUBLE_EQ(box.signed_distance({0, 2.5, 3}), 0.5);
  EXPECT_EQ(box.face({0, 0, 5.9}), 5);
  EXPECT_EQ(box.outward_normal({-0.9, 0, 3}), Vec3(-1, 0, 0));
  EXPECT_DOUBLE_EQ(box.volume(), 48);
}

TEST(GrainShape, PolyhedronOfBoxFacetsIsTheBox)
{
  const PolyhedronShape cube(unit_cube_facets());
  const BoxShape box(Vec3::Zero(), Vec3::Ones());
  EXPECT_NEAR(cube.volume(), 1, 1e-14);
  for (const Vec3 &x : {Vec3(0.5, 0.4, 0.3), Vec3(0.9, 0.5, 0.5), Vec3(0.5, 1.2, 0.6), Vec3(0.1, 0.2, -0.3)})
  {
    EXPECT_NEAR(cube.signed_distance(x), box.signed_distance(x), 1e-14);
    EXPECT_EQ(cube.face(x), box.face(x));
  }
}

TEST(GrainShape, ReentrantBodyIsRefused)
{
  auto facets = unit_cube_facets();
  facets.push_back({{Vec3(0.2, 0.2, 0.5), Vec3(0.8, 0.2, 0.5), Vec3(0.8, 0.8, 0.5)}, 7});
  EXPECT_THROW(PolyhedronShape{facets}, std::invalid_argument);
}

TEST(GrainShape, ProjectionStaysInThePlaneAndEndsOnTheCurvedSurface)
{
  const CylinderShape cylinder(Vec3::Zero(), 100, 400);
  const Vec3 n = Vec3(1, 1, 1).normalized();
  const Vec3 x(95, 30, 210);
  const auto y = project_to_surface(cylinder, x, n);
  ASSERT_TRUE(y);
  EXPECT_NEAR(n.dot(*y - x), 0, 1e-10);
  EXPECT_NEAR(cylinder.signed_distance(*y), 0, 1e-9);
  EXPECT_EQ(cylinder.face(*y), 0);
}

TEST(GrainShape, ProjectionMovesOnToTheNextFaceAroundAnEdge)
{
  const BoxShape box(Vec3::Zero(), Vec3(100, 100, 100));
  const Vec3 n = Vec3(1, 0, 1).normalized();
  // Slid along the face x+ past the edge to y+: outside of the latter, back onto it within the plane.
  const auto y = project_to_surface(box, {100, 103, 50}, n);
  ASSERT_TRUE(y);
  EXPECT_NEAR(box.signed_distance(*y), 0, 1e-9);
  EXPECT_NEAR((*y)[1], 100, 1e-9);
  EXPECT_NEAR(n.dot(*y - Vec3(100, 103, 50)), 0, 1e-10);
}

TEST(GrainShape, PlaneParallelToTheFaceHasNoProjection)
{
  const BoxShape box(Vec3::Zero(), Vec3(100, 100, 100));
  EXPECT_FALSE(project_to_surface(box, {50, 50, 99}, Vec3::UnitZ()));
}

TEST(GrainShape, CrossingLiesOnTheSurface)
{
  const CylinderShape cylinder(Vec3::Zero(), 100, 400);
  const Vec3 x = surface_crossing(cylinder, {90, 0, 200}, {130, 10, 210});
  EXPECT_NEAR(cylinder.signed_distance(x), 0, 1e-10);
}
} // namespace
} // namespace ddfem
