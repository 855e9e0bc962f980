#include "dd/io/paradis_data.h"
#include "dd/microstructure/adopt_slip_planes.h"
#include "dd/microstructure/sources.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <unistd.h>

namespace
{
using namespace ddfem;

class HexagonalFile : public testing::Test
{
protected:
  HexagonalFile()
  {
    path_ = std::filesystem::temp_directory_path() / ("hexagonal_" + std::to_string(getpid()) + ".data");
  }
  ~HexagonalFile() override { std::filesystem::remove(path_); }

  /// Writes @p network and reads it back, as the program does for an hcp crystal: without indices of planes.
  Network through_file(const Network &network) const
  {
    write_paradis_data(path_, network, systems_.burgers_magnitude(), Vec3::Constant(-500), Vec3::Constant(500));
    ParadisReadOptions options;
    options.burgers_magnitude = systems_.burgers_magnitude();
    options.strict = true;
    return read_paradis_data(path_, options).network;
  }

  const SlipSystems systems_{
      Lattice::hcp, 0.32316,
      Orientation::from_axes(SampleAxis::z, {1, 0, 1}, SampleAxis::x, {1, 2, 0}, UnitCell::hexagonal(1.5929))};
  std::filesystem::path path_;
};

TEST_F(HexagonalFile, PlanesOfSlipSystemsGetTheirIndicesBack)
{
  for (const SlipSystem &s : systems_)
  {
    Network original;
    add_frank_read_source(original, systems_.orientation(), {s.plane_miller, s.burgers, Vec3(50, 60, -70), 100, 30},
                          20);
    Network network = through_file(original);
    adopt_slip_planes(network, systems_);
    EXPECT_TRUE(network.violations().empty()) << s.name;
    // A source that is added later finds the same plane.
    const PlaneIndex plane = network.plane(*network.segments().begin());
    EXPECT_EQ(network.planes()[plane].miller, without_sense(s.plane_miller)) << s.name;
    EXPECT_LT(network.planes()[plane].normal.cross(s.normal).norm(), 1e-15) << s.name;
    for (const SegmentIndex segment : network.segments())
      EXPECT_EQ(network.plane(segment), plane) << s.name;
  }
}

TEST_F(HexagonalFile, PrismaticLoopKeepsItsSidesAndCorners)
{
  Network original;
  const Vec3 b = shortest_translation(Lattice::hcp, 0.32316, systems_.orientation(), {1, 1, 0});
  add_polygon_loop(original, systems_, {{1, 1, 0}, b, Vec3(10, 20, 30), 40, 0}, 10);
  Network network = through_file(original);
  adopt_slip_planes(network, systems_);
  EXPECT_TRUE(network.violations().empty());
  for (const NodeIndex i : network.nodes())
    EXPECT_LT((network.position(i) - original.position(*original.find_node(network.id(i)))).norm(), 1e-6);
  for (const SegmentIndex s : network.segments())
    EXPECT_FALSE(is_zero(network.planes()[network.plane(s)].miller));
}

/// A straight line whose plane encloses @p angle (rad) with the basal plane.
Network line_near_basal_plane(const SlipSystems &systems, const double angle)
{
  const SlipSystem &basal = systems[*systems.find("(0001)[11-20]")];
  const Vec3 along = basal.burgers.normalized(), across = basal.normal.cross(along);
  const Vec3 normal = std::cos(angle) * basal.normal - std::sin(angle) * across;
  const Vec3 line = std::cos(angle) * across + std::sin(angle) * basal.normal;
  Network network;
  const PlaneIndex plane = network.planes().find_or_insert({0, 0, 0}, normal, Vec3::Zero());
  add_line(network, {Vec3::Zero(), Vec3(50 * line), Vec3(100 * line + 20 * along)}, basal.burgers, plane, false,
           NodeConstraint::pinned);
  return network;
}

TEST_F(HexagonalFile, NodesFollowAPlaneThatIsSlightlyTurned)
{
  constexpr double angle = 5e-5;
  Network network = line_near_basal_plane(systems_, angle);
  ASSERT_TRUE(network.violations().empty());
  const Vec3 before = network.position(*network.find_node(2));
  adopt_slip_planes(network, systems_);
  EXPECT_TRUE(network.violations().empty());
  EXPECT_EQ(network.planes()[network.plane(*network.segments().begin())].miller, (Miller{0, 0, 1}));
  EXPECT_NEAR((network.position(*network.find_node(2)) - before).norm(), 100 * angle, 1e-9);
}

TEST_F(HexagonalFile, OtherPlanesAreLeftAlone)
{
  for (const double angle : {2e-4, 0.3})
  {
    Network network = line_near_basal_plane(systems_, angle);
    const PlaneIndex plane = network.plane(*network.segments().begin());
    adopt_slip_planes(network, systems_);
    EXPECT_EQ(network.plane(*network.segments().begin()), plane) << angle;
    EXPECT_TRUE(is_zero(network.planes()[plane].miller)) << angle;
  }
}

TEST_F(HexagonalFile, LineThatWindsAroundACellStaysOnTheImagesOfItsPlane)
{
  // The plane is oblique to the cell, so that its images have other offsets.
  const SlipSystem &basal = systems_[*systems_.find("(0001)[11-20]")];
  const Vec3 along = basal.burgers.normalized();
  const double period = 100;
  Network network;
  network.set_period(Vec3::Constant(period));
  std::vector<NodeIndex> nodes;
  for (int k = 0; k < 12; ++k)
  {
    const Vec3 x = 15.0 * k * along;
    nodes.push_back(network.insert(Node{x - period * (x / period).array().round().matrix(),
                                        k == 0 || k == 11 ? NodeConstraint::pinned : NodeConstraint::free}));
  }
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k)
  {
    const PlaneIndex plane = network.planes().find_or_insert({0, 0, 0}, basal.normal, network.position(nodes[k]));
    network.insert(Segment{nodes[k], nodes[k + 1], basal.burgers, plane});
  }
  ASSERT_GT(network.planes().size(), 1u);
  ASSERT_TRUE(network.violations().empty());
  std::vector<Vec3> before;
  for (const NodeIndex i : nodes)
    before.push_back(network.position(i));
  adopt_slip_planes(network, systems_);
  EXPECT_TRUE(network.violations().empty());
  for (std::size_t k = 0; k < nodes.size(); ++k)
    EXPECT_LT((network.position(nodes[k]) - before[k]).norm(), 1e-9);
}
} // namespace
