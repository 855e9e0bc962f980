#include "dd/io/paradis_data.h"
#include "dd/microstructure/adopt_slip_planes.h"
#include "dd/microstructure/sources.h"

#include <gtest/gtest.h>

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

TEST_F(HexagonalFile, OtherPlanesAreLeftAlone)
{
  // A plane near the basal one, and one that is no slip plane at all.
  const Vec3 n = systems_.orientation().plane_normal({0, 0, 1}), b = systems_[3].burgers;
  for (const double angle : {2e-4, 0.3})
  {
    const Vec3 tilted = (std::cos(angle) * n + std::sin(angle) * n.cross(b).normalized()).normalized();
    Network network;
    const PlaneIndex plane = network.planes().find_or_insert({0, 0, 0}, tilted, Vec3::Zero());
    add_line(network, {Vec3::Zero(), Vec3(10 * b), Vec3(20 * b)}, b, plane, false, NodeConstraint::pinned);
    adopt_slip_planes(network, systems_);
    EXPECT_EQ(network.plane(*network.segments().begin()), plane);
  }
}
} // namespace
