// Glide planes of products as the topological operations ask for them.
#include "dd/topology/product_plane_rule.h"

#include <gtest/gtest.h>

#include <array>

namespace ddfem
{
namespace
{
TEST(ProductPlaneRule, AScrewKeepsThePlaneOfTheLinesThatReacted)
{
  const SlipSystems fcc(Lattice::fcc, 0.405);
  const auto rule = product_plane_rule(fcc);
  const Vec3 b = fcc[0].burgers, xi = b.normalized(), point(1, 2, 3);
  const auto planes = fcc.glissile_planes(b);
  ASSERT_EQ(planes.size(), 2U);
  for (const std::size_t p : planes)
  {
    Network network;
    const Vec3 &normal = fcc.planes()[p].normal;
    const std::array<Vec3, 2> parents{Vec3::Zero(), -normal}; // a sessile line and one on this plane
    const PlaneIndex found = rule(network, xi, b, point, parents);
    ASSERT_TRUE(found.is_valid());
    EXPECT_LT(network.planes()[found].normal.cross(normal).norm(), 1e-12);
    EXPECT_TRUE(network.planes().contains(found, point));
  }
}
} // namespace
} // namespace ddfem
