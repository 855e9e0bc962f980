// The displacement that swept area leaves at the nodes of the surface, from which slip steps are drawn.
#include "coupling/face_displacements.h"
#include "coupling/finite_grain.h"
#include "loop_that_has_left.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace ddfem::coupling
{
namespace
{
const IsotropicMedium medium{26.5e3, 0.345, 0.286};
const Vec3 box_size(150, 120, 300), normal = Vec3(0.4, 0.2, 1).normalized(),
                                    burgers = 0.286 * Vec3(1, 0, -0.4).normalized();

class SweptDisplacement : public testing::Test
{
protected:
  SweptDisplacement()
  {
    GrainParameters p;
    p.mesh.size = {box_size[0], box_size[1], box_size[2]};
    p.mesh.subdivisions = {3, 3, 6};
    p.platen_motion = PlatenMotion::none; // no face held: values at the nodes are those of the field
    p.image_depth = 0;
    p.reference = ReferenceState::perfect_crystal;
    grain = std::make_unique<FiniteGrain>(p, medium, MPI_COMM_WORLD);
    grain->set_reference(network, {medium, network, &grain->shape(), RayDirection::normal, nullptr, nullptr});
  }
  std::vector<Vec3> at_nodes() const
  {
    std::vector<Vec3> u;
    for (const auto &v : grain->boundary_state().infinite)
      u.emplace_back(v[0], v[1], v[2]);
    return u;
  }

  Network network;
  std::unique_ptr<FiniteGrain> grain;
};

/// Mean over the ranks of the vectors on either side of the plane through the middle, the rest of which is then what differs from it.
struct TwoBlocks
{
  Vec3 step;     ///< mean on the side of the normal minus mean on the other
  double spread; ///< largest distance from the mean of the own side
};

TwoBlocks two_blocks(const std::vector<Vec3> &nodes, const std::vector<Vec3> &u)
{
  const auto side = [](const Vec3 &x) { return normal.dot(x - 0.5 * box_size) > 0 ? 1 : 0; };
  Vec3 mean[2];
  for (const int s : {0, 1})
  {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero(); // the last component counts
    for (std::size_t k = 0; k < nodes.size(); ++k)
      if (side(nodes[k]) == s)
        sum += Eigen::Vector4d(u[k][0], u[k][1], u[k][2], 1);
    MPI_Allreduce(MPI_IN_PLACE, sum.data(), 4, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    mean[s] = sum.head<3>() / sum[3];
  }
  double spread = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k)
    spread = std::max(spread, (u[k] - mean[side(nodes[k])]).norm());
  return {mean[1] - mean[0], spread};
}

TEST_F(SweptDisplacement, OfALoopThatHasLeftIsAStepOfTheBurgersVectorAndNothingElse)
{
  // A sum over some thousand triangles, strips and sectors: their rounding is what is left.
  grain->add_swept(test::loop_that_has_left(network, grain->shape(), normal, burgers));
  ASSERT_EQ(network.n_segments(), 0U);
  const TwoBlocks blocks = two_blocks(grain->boundary_nodes(), at_nodes());
  EXPECT_NEAR((blocks.step + burgers).norm() / burgers.norm(), 0, 1e-9);
  EXPECT_NEAR(blocks.spread / burgers.norm(), 0, 1e-9);
}

TEST_F(SweptDisplacement, TwoLoopsThatHaveLeftMakeAStepOfTwoBurgersVectors)
{
  for (int k = 0; k < 2; ++k)
    grain->add_swept(test::loop_that_has_left(network, grain->shape(), normal, burgers));
  const TwoBlocks blocks = two_blocks(grain->boundary_nodes(), at_nodes());
  EXPECT_NEAR((blocks.step + 2 * burgers).norm() / burgers.norm(), 0, 1e-9);
}

TEST_F(SweptDisplacement, OfALoopInsideIsThatOfItsPresentLineHoweverItHasMoved)
{
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u), middle = 0.5 * box_size;
  test::add_ring(network, normal, burgers, middle);
  grain->add_swept(grown_area(network, &grain->shape(), RayDirection::normal));
  for (int step = 0; step < 60; ++step)
  {
    SweptArea swept;
    // Away and back, growing all the time; remeshing divides and joins.
    const Vec3 drift = 0.8 * std::cos(0.15 * step) * u;
    test::move_and_remesh(network, grain->shape(), swept,
                          [&](const Vec3 &x)
                          { return Vec3(drift + 0.009 * (x - middle) + 0.1 * std::sin(x[0] / 9) * v); });
    grain->add_swept(swept);
  }
  ASSERT_GT(network.n_segments(), 15U);
  double reach = -grain->shape().diameter();
  for (const NodeIndex i : network.nodes())
    reach = std::max(reach, grain->shape().signed_distance(network.position(i)));
  ASSERT_LT(reach, -3); // has not left
  const auto nodes = grain->boundary_nodes(), swept = at_nodes();
  const Vec3 apex = middle + 7 * u - 11 * v; // any point of the plane
  for (std::size_t k = 0; k < nodes.size(); ++k)
  {
    Vec3 loop = Vec3::Zero();
    for (const SegmentIndex s : network.segments())
      loop += triangle_displacement(medium.nu, beside(nodes[k]), apex, network.position(network.start(s)),
                                    network.position(network.end(s)), network.burgers(s));
    EXPECT_NEAR((swept[k] - loop).norm() / burgers.norm(), 0, 1e-10) << nodes[k].transpose();
  }
}

TEST(SweptDisplacementAtNodesOfAPlane, ForthAndBackCancels)
{
  // Lines pass over nodes that lie in their glide plane, or along its rim through them, in other steps each time.
  std::mt19937 random(12);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  for (int draw = 0; draw < 200; ++draw)
  {
    const Vec3 n = vector().normalized(), u = n.unitOrthogonal(), v = n.cross(u), centre = 100 * vector();
    const auto in_plane = [&](double x, double y) { return Vec3(centre + x * u + y * v); };
    // The segment from (x, 0) to (x, 30) goes from x = -20 to 20; its first end passes through the second node.
    const std::vector<Vec3> nodes{in_plane(10 * uniform(random), 15 + 10 * uniform(random)),
                                  in_plane(10 * uniform(random), 0)};
    const auto passes = [&](const std::vector<int> &steps)
    {
      SweptArea area;
      for (std::size_t pass = 0; pass < steps.size(); ++pass)
        for (int k = 0; k < steps[pass]; ++k)
        {
          const double sign = pass % 2 == 0 ? 1 : -1;
          const double from = sign * (-20 + 40.0 * k / steps[pass]), to = sign * (-20 + 40.0 * (k + 1) / steps[pass]);
          const Vec3 q = in_plane(from, 30), p_new = in_plane(to, 0);
          area.add_triangle(in_plane(from, 0), p_new, q, 0.25 * u, {});
          area.add_triangle(q, p_new, in_plane(to, 30), 0.25 * u, {});
        }
      return swept_displacement(0.3, SweptLoops(area), nodes, {});
    };
    const std::vector<Vec3> once = passes({7}), thrice = passes({5, 6, 4});
    EXPECT_GT(once[0].norm(), 0.1) << "half the Burgers vector";
    for (const std::size_t k : {0U, 1U})
      EXPECT_LT((thrice[k] - once[k]).norm(), 1e-4)
          << draw << " " << k; // the slope of the field over 1e-9 nm near its rim
  }
}
} // namespace
} // namespace ddfem::coupling
