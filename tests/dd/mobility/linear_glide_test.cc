#include "dd/microstructure/sources.h"
#include "dd/mobility/linear_glide.h"
#include "dd/mobility/local_velocities.h"

#include <gtest/gtest.h>

namespace ddfem
{
namespace
{
const CharacterDrag drag{0.02, 0.01};
const LinearGlide law(drag);

/// Three nodes along @p t with b = 0.25 ex in the plane z = 0.
Network straight_line(const Vec3 &t)
{
  Network n;
  const PlaneIndex plane = n.planes().find_or_insert({0, 0, 1}, Vec3::UnitZ(), Vec3(Vec3::Zero()));
  add_line(n, {-10 * t, Vec3::Zero(), 10 * t}, Vec3(0.25, 0, 0), plane, false, NodeConstraint::pinned);
  return n;
}

NodeIndex middle(const Network &n)
{
  return *n.find_node(1);
}

TEST(LinearGlide, StraightLineGlidesAtStressTimesBurgersOverDrag)
{
  for (const bool edge : {true, false})
  {
    const Network n = straight_line(edge ? Vec3::UnitY() : Vec3::UnitX());
    // Peach-Koehler force per length tau b on arms of 10 nm each: half of each belongs to the middle node.
    const double tau = 40, b = 0.25;
    std::vector<Vec3> force(n.node_capacity(), Vec3::Zero());
    const Vec3 direction = edge ? Vec3::UnitX() : Vec3::UnitY();
    force[middle(n).value] = tau * b * 10 * direction;
    const auto v = glide_velocities(n, force, law, nullptr);
    const double expected = tau * b / (edge ? drag.edge : drag.screw);
    EXPECT_NEAR((v[middle(n).value] - expected * direction).norm(), 0, 1e-12 * expected);
  }
}

TEST(LinearGlide, ForceOutOfTheGlidePlaneAndPinnedNodesDoNotMove)
{
  const Network n = straight_line(Vec3::UnitY());
  std::vector<Vec3> force(n.node_capacity(), Vec3(0, 0, 5));
  for (const Vec3 &v : glide_velocities(n, force, law, nullptr))
    EXPECT_EQ(v.norm(), 0);
  force.assign(n.node_capacity(), Vec3(3, 0, 0));
  const auto v = glide_velocities(n, force, law, nullptr);
  EXPECT_EQ(v[n.find_node(0)->value].norm(), 0);
  EXPECT_GT(v[middle(n).value].norm(), 0);
}

TEST(LinearGlide, NodeOnTwoPlanesMovesAlongTheirIntersectionAndOnThreeNotAtAll)
{
  Network n;
  const Vec3 b(0, 0.25, 0);
  const auto plane = [&](const std::array<int, 3> &m)
  { return n.planes().find_or_insert(m, Vec3(m[0], m[1], m[2]).normalized(), Vec3(Vec3::Zero())); };
  const NodeIndex o = n.insert(Node{}), p = n.insert(Node{Vec3(10, 0, 0), NodeConstraint::pinned}),
                  q = n.insert(Node{Vec3(0, 0, 10), NodeConstraint::pinned}),
                  r = n.insert(Node{Vec3(0, 10, 0), NodeConstraint::pinned});
  n.insert(Segment{p, o, b, plane({0, 0, 1})});
  n.insert(Segment{o, q, b, plane({1, 0, 0})});
  EXPECT_NEAR((glide_projector(n, o, nullptr) - Mat3(Vec3::UnitY() * Vec3::UnitY().transpose())).norm(), 0, 1e-14);
  n.insert(Segment{o, r, Vec3(0.25, 0, 0), plane({0, 1, 0})}); // any third plane
  EXPECT_EQ(glide_projector(n, o, nullptr).norm(), 0);
}

TEST(LinearGlide, SurfaceNodeSlidesAlongItsFaceAndPlane)
{
  Network n;
  const Vec3 normal = Vec3(1, 1, 1).normalized();
  const PlaneIndex plane = n.planes().find_or_insert({1, 1, 1}, normal, Vec3(100, 50, 50));
  const NodeIndex s = n.insert(Node{Vec3(100, 50, 50), NodeConstraint::surface}),
                  p = n.insert(Node{Vec3(50, 75, 75), NodeConstraint::pinned});
  n.insert(Segment{s, p, Vec3(0.2, -0.2, 0), plane});
  const BoxShape box(Vec3::Zero(), Vec3(100, 100, 100));
  const Mat3 projector = glide_projector(n, s, &box);
  const Vec3 e = Vec3::UnitX().cross(normal).normalized();
  EXPECT_NEAR((projector - e * e.transpose()).norm(), 0, 1e-14);
}
} // namespace
} // namespace ddfem
