// Which faces get images.
#include "coupling/image_planes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ddfem::coupling
{
namespace
{
using Facet = PolyhedronShape::Facet;

/// Two facets per side of the box between two corners, ids 0..5 from @p first_id on.
std::vector<Facet> box(const Vec3 &low, const Vec3 &high)
{
  std::vector<Facet> facets;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int half = 0; half < 2; ++half)
      {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const double middle = 0.5 * (low[u] + high[u]);
        Facet f;
        f.face_id = 2 * axis + side;
        for (const auto &[a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
        {
          Vec3 x;
          x[axis] = side == 0 ? low[axis] : high[axis];
          x[u] = half == 0 ? (a == 0 ? low[u] : middle) : (a == 0 ? middle : high[u]);
          x[v] = b == 0 ? low[v] : high[v];
          f.vertices.push_back(x);
        }
        facets.push_back(f);
      }
  return facets;
}

std::vector<int> ids(const std::vector<ImagePlane> &planes)
{
  std::vector<int> result;
  std::transform(planes.begin(), planes.end(), std::back_inserter(result),
                 [](const ImagePlane &p) { return p.face_id; });
  return result;
}
} // namespace

TEST(ImagePlanes, AreTheFacesOfABoxThatAreNotHeld)
{
  const auto facets = box(Vec3(0, 0, 0), Vec3(300, 200, 600));
  const auto planes = image_planes(facets, {4, 5});
  EXPECT_EQ(ids(planes), (std::vector<int>{0, 1, 2, 3}));
  for (const ImagePlane &p : planes)
  {
    EXPECT_GT(p.outward.dot(p.point - Vec3(150, 100, 300)), 0);
    EXPECT_NEAR(p.outward.cwiseAbs().maxCoeff(), 1, 1e-12);
  }
  EXPECT_DOUBLE_EQ(facet_size(facets, planes), 600); // sides are divided across, not along z
}

TEST(ImagePlanes, LeaveOutBentFaces)
{
  auto facets = box(Vec3(0, 0, 0), Vec3(300, 200, 600));
  for (Facet &f : facets)
    if (f.face_id == 1)
      f.face_id = 3; // two sides under one name
  EXPECT_EQ(ids(image_planes(facets, {})), (std::vector<int>{0, 2, 4, 5}));
}

TEST(ImagePlanes, LeaveOutFacesBeyondWhichTheGrainGoesOn)
{
  // A pillar on a base: the top of the base (id 15) has the pillar in front of it.
  auto facets = box(Vec3(-500, -500, -300), Vec3(500, 500, 0));
  for (Facet &f : facets)
    f.face_id += 10;
  const auto pillar = box(Vec3(-100, -100, 0), Vec3(100, 100, 600));
  std::copy_if(pillar.begin(), pillar.end(), std::back_inserter(facets), [](const Facet &f) { return f.face_id != 4; });
  const auto found = ids(image_planes(facets, {}));
  EXPECT_EQ(found, (std::vector<int>{5, 10, 11, 12, 13, 14}));
}

TEST(ImagePlanes, LeaveOutTwoFacesInOnePlane)
{
  auto facets = box(Vec3(0, 0, 0), Vec3(300, 200, 600));
  bool renamed = false;
  for (Facet &f : facets)
    if (f.face_id == 1 && !renamed)
    {
      f.face_id = 7;
      renamed = true;
    }
  EXPECT_EQ(ids(image_planes(facets, {})), (std::vector<int>{0, 2, 3, 4, 5}));
}
} // namespace ddfem::coupling
