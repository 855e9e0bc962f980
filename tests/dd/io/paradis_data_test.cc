#include "dd/io/file_error.h"
#include "dd/io/paradis_data.h"
#include "dd/io/paradis_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <unistd.h>

namespace
{
using namespace ddfem;
namespace fs = std::filesystem;

constexpr double b_mag = 0.2556; // nm

const fs::path folder = fs::path(DDFEM_TEST_DATA) / "paradis";

/// A folder of this process that disappears with the test.
class ParadisScratch : public testing::Test
{
protected:
  void SetUp() override
  {
    scratch = fs::temp_directory_path() / ("ddfem_paradis_" + std::to_string(::getpid()));
    fs::create_directories(scratch);
  }
  void TearDown() override { fs::remove_all(scratch); }

  fs::path write(const std::string &text) const
  {
    std::ofstream(scratch / "case.data") << text;
    return scratch / "case.data";
  }
  fs::path scratch;
};
using ParadisReader = ParadisScratch;
using ParadisWriter = ParadisScratch;
using ParadisErrors = ParadisScratch;

std::string text_of(const fs::path &path)
{
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::string replaced(std::string text, const std::string &old, const std::string &by, std::size_t occurrence = 0)
{
  std::size_t at = text.find(old);
  while (occurrence-- > 0)
    at = text.find(old, at + 1);
  if (at == std::string::npos)
    throw std::logic_error("the text to replace is missing: " + old);
  return text.replace(at, old.size(), by);
}

ParadisReadOptions options_for(bool periodic)
{
  ParadisReadOptions options;
  options.burgers_magnitude = b_mag;
  options.periodic = periodic;
  options.cubic_orientation = Orientation();
  return options;
}

std::string message_of(const fs::path &path, bool strict = false)
{
  ParadisReadOptions options = options_for(false);
  options.strict = strict;
  try
  {
    read_paradis_data(path, options);
  }
  catch (const FileError &error)
  {
    return error.what();
  }
  return "no error";
}

/// @p network has the nodes, arms and Burgers vectors of @p file; positions to @p tolerance (nm).
void expect_content(const paradis::File &file, const Network &network, double tolerance)
{
  ASSERT_EQ(network.n_nodes(), file.nodes.size());
  for (std::size_t k = 0; k < file.nodes.size(); ++k)
  {
    const paradis::FileNode &node = file.nodes[k];
    const NodeIndex i = *network.find_node(static_cast<ObjectId>(node.tag.second));
    EXPECT_LT(network.minimum_image(network.position(i) - b_mag * node.position).norm(), tolerance);
    ASSERT_EQ(network.degree(i), node.arms.size());
    for (const paradis::Arm &arm : node.arms)
    {
      const auto s = network.find(i, *network.find_node(static_cast<ObjectId>(arm.tag.second)));
      ASSERT_TRUE(s.has_value());
      EXPECT_LT((network.burgers_from(*s, i) - b_mag * arm.burgers).norm(), 1e-12);
      EXPECT_LT(network.normal(*s).cross(arm.normal).norm(), 1e-9);
      EXPECT_EQ(network.plane(*s).is_valid(), !arm.normal.isZero());
    }
  }
}

/// The sample files, and whether their lines cross the boundary of the cell.
const std::vector<std::pair<std::string, bool>> samples = {{"copper_x8", false},        {"form_binaryjunc", false},
                                                           {"frank_read_src", false},   {"hcp_junct_diss", false},
                                                           {"printstress_screw", true}, {"singlelinefem", false}};

TEST_F(ParadisReader, SampleFilesGiveSoundNetworksWithTheirContent)
{
  for (const auto &[name, periodic] : samples)
  {
    SCOPED_TRACE(name);
    const fs::path path = folder / (name + ".data");
    const ParadisData data = read_paradis_data(path, options_for(periodic));
    EXPECT_TRUE(data.warnings.empty()) << data.warnings.front();
    expect_content(paradis::parse(path), data.network, 2e-4 * b_mag);
    EXPECT_NO_THROW(data.network.check_invariants());
  }
}

TEST_F(ParadisWriter, RoundTripKeepsNodesArmsBurgersVectorsAndPlanes)
{
  for (const auto &[name, periodic] : samples)
  {
    SCOPED_TRACE(name);
    const ParadisData first = read_paradis_data(folder / (name + ".data"), options_for(periodic));
    write_paradis_data(scratch / "out.data", first.network, b_mag, first.lower, first.upper);
    const paradis::File written = paradis::parse(scratch / "out.data");
    expect_content(written, first.network, 1e-10);
    const ParadisData second = read_paradis_data(scratch / "out.data", options_for(periodic));
    EXPECT_EQ(second.network.n_segments(), first.network.n_segments());
    EXPECT_EQ(second.network.planes().size(), first.network.planes().size());
    EXPECT_LT((second.upper - first.upper).norm() + (second.lower - first.lower).norm(), 1e-9);
    for (const NodeIndex i : first.network.nodes())
    {
      const NodeIndex j = *second.network.find_node(first.network.id(i));
      EXPECT_EQ(second.network.constraint(j), first.network.constraint(i));
      EXPECT_LT((second.network.position(j) - first.network.position(i)).norm(), 1e-9);
    }
    EXPECT_FALSE(fs::exists(scratch / "out.data.tmp"));
  }
}

TEST_F(ParadisReader, LengthsAreInBurgersMagnitudesAndConstraintsHaveTheirMeaning)
{
  const ParadisData data = read_paradis_data(folder / "frank_read_src.data", options_for(false));
  const Network &network = data.network;
  ASSERT_EQ(network.n_nodes(), 3u);
  EXPECT_LT((network.position(*network.find_node(0)) - b_mag * Vec3(-4000, 500, 6000)).norm(), 1e-9);
  EXPECT_EQ(network.constraint(*network.find_node(0)), NodeConstraint::pinned);
  EXPECT_EQ(network.constraint(*network.find_node(1)), NodeConstraint::free);
  EXPECT_NEAR(data.upper[0], 17500 * b_mag, 1e-9);
  const SegmentIndex s = *network.find(*network.find_node(0), *network.find_node(1));
  EXPECT_EQ(network.planes()[network.plane(s)].miller, (std::array<int, 3>{0, 1, 1}));

  const Network bar = read_paradis_data(folder / "singlelinefem.data", options_for(false)).network;
  EXPECT_EQ(bar.constraint(*bar.find_node(0)), NodeConstraint::surface); // code 1 at a node with one arm
}

TEST_F(ParadisReader, OneLoopIsOnOnePlaneAlthoughItsCoordinatesAreRounded)
{
  const ParadisData data = read_paradis_data(folder / "copper_x8.data", options_for(false));
  EXPECT_EQ(data.network.planes().size(), 12u); // 12 sources of 24 pinned ends
  for (const SegmentIndex s : data.network.segments())
  {
    const std::array<int, 3> m = data.network.planes()[data.network.plane(s)].miller;
    EXPECT_TRUE(m[0] == 1 && std::abs(m[1]) == 1 && std::abs(m[2]) == 1);
  }
  EXPECT_TRUE(data.network.violations(1e-9).empty());
}

TEST_F(ParadisReader, PlanesWithoutRationalNormalHaveNoMillerIndices)
{
  const Network network = read_paradis_data(folder / "hcp_junct_diss.data", options_for(false)).network;
  const SegmentIndex s = *network.find(*network.find_node(1), *network.find_node(2));
  EXPECT_EQ(network.planes()[network.plane(s)].miller, (std::array<int, 3>{0, 0, 0}));
  ParadisReadOptions no_crystal = options_for(false);
  no_crystal.cubic_orientation.reset();
  const Network plain = read_paradis_data(folder / "frank_read_src.data", no_crystal).network;
  EXPECT_EQ(plain.planes()[PlaneIndex{0}].miller, (std::array<int, 3>{0, 0, 0}));
}

TEST_F(ParadisReader, MillerIndicesFollowTheOrientationOfTheCrystal)
{
  ParadisReadOptions options = options_for(false);
  options.cubic_orientation = Orientation::from_axes(SampleAxis::x, {1, 0, 0}, SampleAxis::y, {0, 1, 1});
  const Network network = read_paradis_data(folder / "frank_read_src.data", options).network;
  EXPECT_EQ(network.planes()[PlaneIndex{0}].miller, (std::array<int, 3>{0, 0, 1})); // y + z of the sample
}

TEST_F(ParadisReader, LineThroughThePeriodicBoundaryStaysContinuous)
{
  const Network network = read_paradis_data(folder / "printstress_screw.data", options_for(true)).network;
  EXPECT_EQ(network.period(), b_mag * Vec3::Constant(3500));
  for (const SegmentIndex s : network.segments())
    EXPECT_NEAR(network.length(s), 350 * b_mag, 1e-9);
  for (const NodeIndex i : network.nodes())
    EXPECT_FALSE(network.is_physical(i));
}

TEST_F(ParadisReader, LoopFoldedIntoThePeriodicCellIsUnfolded)
{
  // The middle node of the source is given on the other side of the cell.
  const std::string folded = replaced(text_of(folder / "frank_read_src.data"), "17.0000      500", "-34983.0     500");
  const fs::path path = write(folded);
  const ParadisData data = read_paradis_data(path, options_for(true));
  EXPECT_TRUE(data.warnings.empty());
  EXPECT_NEAR(data.network.position(*data.network.find_node(1))[0], 17 * b_mag, 1e-9);
  EXPECT_EQ(data.network.planes().size(), 1u);
}

TEST_F(ParadisReader, UnusableGlidePlanesAreReportedAndRefusedInStrictMode)
{
  const std::string good = text_of(folder / "frank_read_src.data");
  // b not in the plane (0 1 0), which holds the line.
  std::string tilted = good;
  for (int k = 0; k < 4; ++k)
    tilted = replaced(tilted, "0.              1.              1.", "0.  1.  0.");
  const ParadisData data = read_paradis_data(write(tilted), options_for(false));
  ASSERT_EQ(data.warnings.size(), 2u);
  EXPECT_NE(data.warnings[0].find("case.data:37: b . n / |b| is 0.577"), std::string::npos) << data.warnings[0];
  EXPECT_FALSE(data.network.plane(data.network.segments()[0]).is_valid());
  EXPECT_NE(message_of(write(tilted), true).find("b . n"), std::string::npos);

  // A node far off the plane.
  const std::string off = replaced(good, "17.0000      500.0000", "17.0000      600.0000");
  EXPECT_NE(message_of(write(off), true).find("leaves its glide plane by 70.7"), std::string::npos);
  EXPECT_EQ(read_paradis_data(write(off), options_for(false)).warnings.size(), 2u);

  const std::string half_pinned = replaced(good, "6000.0000  2   0", "6000.0000  2   3");
  EXPECT_NE(message_of(write(half_pinned), true).find("pins some directions only"), std::string::npos);
  const Network network = read_paradis_data(write(half_pinned), options_for(false)).network;
  EXPECT_EQ(network.constraint(*network.find_node(1)), NodeConstraint::pinned);
  EXPECT_EQ(message_of(write(good), true), "no error");
}

TEST_F(ParadisErrors, MalformedFilesAreAnsweredWithFileLineValueAndWhatIsAllowed)
{
  const std::string good = text_of(folder / "frank_read_src.data");
  struct Case
  {
    std::string text, message;
  };
  const std::vector<Case> cases = {
      {replaced(good, "dataFileVersion =   4", "dataFileVersion =   2"),
       ":1: dataFileVersion is 2; versions 4 and 5 are understood."},
      {replaced(good, "numFileSegments =   1", "numFileSegments =   4"), ":2: numFileSegments is 4; only files in one"},
      {replaced(good, "dataFileVersion =   4", ""), ": the header lacks the entry \"dataFileVersion\"."},
      {replaced(good, "minCoordinates = [\n  -1.75", "minCoordinates = [\n  9.75"), "maxCoordinates must exceed"},
      {replaced(good, "nodeCount =   3", "nodeCount =   4"),
       "the file ends where the tag of node 4 of 4 (domain) is expected; it is truncated."},
      {replaced(good, "nodeCount =   3", "nodeCount =   2"),
       ":44: \"0\" follows the last of the 2 nodes that nodeCount promises"},
      {replaced(good, "nodeCount =   3", "nodeCount =   three"),
       ":13: nodeCount is \"three\"; it must be an integer of at most 32 bits."},
      {good.substr(0, good.size() / 2), "it is truncated."},
      {good.substr(0, good.size() - 40), "it is truncated."},
      {"", ":1: the file ends where the entry \"nodalData\" is expected; it is truncated."},
      {replaced(good, "500.0000        6000", "5OO.0000        6000"),
       ":36: the position of node 1 of 3 y is \"5OO.0000\"; it must be a number."},
      {replaced(good, "500.0000        6000", "nan        6000"), "y is nan; it must be finite."},
      {replaced(good, "0,2       4000", "0,1       4000"),
       ":44: node 0,1 is given a second time; tags must be unique."},
      {replaced(good, "6000.0000  2   0", "6000.0000  1   0"), "must be an integer"},
      {replaced(good, "6000.0000  2   0", "6000.0000  -1   0"), ":39: the number of arms of node 0,1 is -1"},
      {replaced(good, "0,2      0.5773503000", "0,8      0.5773503000"),
       ":42: node 0,1 has an arm to node 0,8, which the file does not contain."},
      {replaced(good, "0,2      0.5773503000", "0,0      0.5773503000"), ":42: node 0,1 has two arms to node 0,0"},
      {replaced(good, "0,2      0.5773503000", "0,1      0.5773503000"), ":42: node 0,1 has an arm to itself."},
      {replaced(good, "0,1     -0.5773503000", "0,0     -0.5773503000"),
       ":42: node 0,1 has an arm to node 0,2, but none leads back"},
      {replaced(good, "0,1     -0.5773503000", "0,1     -0.6773503000"),
       ":45: the Burgers vector from node 0,2 to 0,1 is (-0.67735"},
      {replaced(replaced(good, "0,2      0.5773503000", "0,2      0.6773503000"), "0,1     -0.5773503000",
                "0,1     -0.6773503000"),
       ":39: the Burgers vectors of the 2 arms of node 0,1 add up to (0.1, 0, 0)"},
      {replaced(good, "6000.0000   1   7", "6000.0000   1   0"),
       ":36: the Burgers vectors of the 1 arms of node 0,0 add up to"},
      {replaced(good, "6000.0000   1   7", "6000.0000   1   20"), ":36: the constraint of node 0,0 is 20; it must be"},
      {replaced(good, "17.0000      500.0000", "-4000.0      500.0000"),
       ":37: nodes 0,0 and 0,1 are at the same place; a connection must have a length."},
  };
  for (const Case &c : cases)
  {
    const std::string message = message_of(write(c.text));
    EXPECT_NE(message.find(c.message), std::string::npos) << "wanted: " << c.message << "\ngot: " << message;
    EXPECT_NE(message.find("case.data:"), std::string::npos) << message;
  }
}

TEST_F(ParadisErrors, CannotReadWhatIsMissingNorWriteWhereThereIsNoFolder)
{
  EXPECT_THROW(read_paradis_data(scratch / "missing.data", options_for(false)), FileError);
  EXPECT_THROW(read_paradis_data(folder / "frank_read_src.data", ParadisReadOptions()), std::invalid_argument);
  Network network;
  network.insert(Node{Vec3::Zero(), NodeConstraint::pinned});
  EXPECT_THROW(write_paradis_data(scratch / "none" / "x.data", network, b_mag, -Vec3::Ones(), Vec3::Ones()), FileError);
  EXPECT_THROW(write_paradis_data(scratch / "x.data", network, 0, -Vec3::Ones(), Vec3::Ones()), std::invalid_argument);
  network.insert(Node{Vec3::Ones(), NodeConstraint::pinned}, ObjectId{1} << 40);
  EXPECT_THROW(write_paradis_data(scratch / "x.data", network, b_mag, -Vec3::Ones(), Vec3::Ones()),
               std::invalid_argument);
  EXPECT_FALSE(fs::exists(scratch / "x.data"));
}

TEST_F(ParadisWriter, FailedWriteLeavesTheOldFileAlone)
{
  fs::create_directory(scratch / "taken"); // cannot be replaced by a file
  Network network;
  network.insert(Node{Vec3::Zero(), NodeConstraint::pinned});
  EXPECT_THROW(write_paradis_data(scratch / "taken", network, b_mag, -Vec3::Ones(), Vec3::Ones()), FileError);
  EXPECT_TRUE(fs::is_directory(scratch / "taken"));
  EXPECT_FALSE(fs::exists(scratch / "taken.tmp"));
}
} // namespace
