#include "dd/io/file_error.h"
#include "dd/io/paradis_data.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <system_error>

namespace ddfem
{
namespace
{
int code_of(NodeConstraint constraint)
{
  switch (constraint)
  {
    case NodeConstraint::free: return 0;
    case NodeConstraint::pinned: return 7;
    case NodeConstraint::surface: return 8;
  }
  return 0;
}

/// Three numbers with all the digits that doubles have.
std::string text_of(const Vec3 &v)
{
  char text[96];
  std::snprintf(text, sizeof(text), "%.17g %.17g %.17g", v[0], v[1], v[2]);
  return text;
}

std::string bracketed(const Vec3 &v)
{
  char text[112];
  std::snprintf(text, sizeof(text), "[\n  %.17g\n  %.17g\n  %.17g\n  ]\n", v[0], v[1], v[2]);
  return text;
}

/// One domain that is the whole box.
std::string header(std::size_t n_nodes, const Vec3 &lower, const Vec3 &upper)
{
  return "dataFileVersion =   4\nnumFileSegments =   1\nminCoordinates = " + bracketed(lower) +
         "maxCoordinates = " + bracketed(upper) + "nodeCount =   " + std::to_string(n_nodes) +
         "\ndataDecompType =   2\ndataDecompGeometry = [\n  1\n  1\n  1\n  ]\n\n"
         "#\n#  END OF DATA FILE PARAMETERS\n#\n\n"
         "domainDecomposition =\n# Dom_ID  Minimum XYZ bounds   Maximum XYZ bounds\n  0  " +
         text_of(lower) + "   " + text_of(upper) +
         "\nnodalData =\n#  Primary lines: node_tag, x, y, z, num_arms, constraint\n"
         "#  Secondary lines: arm_tag, burgx, burgy, burgz, nx, ny, nz\n#  length in unit of burgMag\n";
}

std::string node_lines(const Network &network, NodeIndex i, double burgers_magnitude)
{
  std::string text = " 0," + std::to_string(network.id(i)) + " " + text_of(network.position(i) / burgers_magnitude) +
                     " " + std::to_string(network.degree(i)) + " " + std::to_string(code_of(network.constraint(i))) +
                     "\n";
  for (const SegmentIndex s : network.connected_segments(i))
    text += "   0," + std::to_string(network.id(network.other_end(s, i))) + " " +
            text_of(network.burgers_from(s, i) / burgers_magnitude) + "\n       " + text_of(network.normal(s)) + "\n";
  return text;
}

std::string file_text(const Network &network, double burgers_magnitude, const Vec3 &lower, const Vec3 &upper)
{
  std::vector<NodeIndex> nodes(network.nodes().begin(), network.nodes().end());
  std::ranges::sort(nodes, {}, [&network](NodeIndex i) { return network.id(i); });
  if (!nodes.empty() && network.id(nodes.back()) > std::numeric_limits<std::int32_t>::max())
    throw std::invalid_argument("Node id " + std::to_string(network.id(nodes.back())) +
                                " does not fit into the 32 bits of a ParaDiS tag.");
  std::string text = header(nodes.size(), lower / burgers_magnitude, upper / burgers_magnitude);
  for (const NodeIndex i : nodes)
    text += node_lines(network, i, burgers_magnitude);
  return text;
}

/// Throws FileError; leaves nothing behind then.
void write_whole(const std::filesystem::path &path, const std::string &text)
{
  const std::filesystem::path temporary = path.string() + ".tmp";
  std::FILE *file = std::fopen(temporary.c_str(), "w");
  if (file == nullptr)
    throw FileError(temporary.string() + ": the file cannot be opened for writing.");
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0;
  const bool closed = std::fclose(file) == 0;
  std::error_code error;
  if (written && closed)
    std::filesystem::rename(temporary, path, error);
  if (written && closed && !error)
    return;
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  throw FileError(path.string() + ": writing failed" + (error ? ": " + error.message() : std::string()) + ".");
}
} // namespace

void write_paradis_data(const std::filesystem::path &path, const Network &network, double burgers_magnitude,
                        const Vec3 &lower, const Vec3 &upper)
{
  if (!(burgers_magnitude > 0) || !std::isfinite(burgers_magnitude))
    throw std::invalid_argument("The Burgers magnitude, unit of length of a ParaDiS file, is " +
                                std::to_string(burgers_magnitude) + " nm; it must be positive.");
  write_whole(path, file_text(network, burgers_magnitude, lower, upper));
}
} // namespace ddfem
