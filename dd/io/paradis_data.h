// ParaDiS nodal data files (.data).
#pragma once

#include "dd/crystal/orientation.h"
#include "dd/network/network.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ddfem
{
struct ParadisReadOptions
{
  /// Unit of length of the file, nm. Required: the file does not name it.
  double burgers_magnitude = 0;
  /// For a cubic crystal: glide-plane normals (in the sample frame, as everything in the file) are rationalised to
  /// Miller indices up to 9 and made exact. Without it, and for normals that are not rational, planes get 0 0 0.
  std::optional<Orientation> cubic_orientation;
  /// The box of the file is a periodic cell: segments run to the nearest image. Connected nodes are moved by multiples
  /// of the cell so that lines are continuous (where they do not wind around the cell), and Network::period() is set.
  bool periodic = false;
  /// Refuse what is only reported otherwise: see ParadisData::warnings.
  bool strict = false;
  /// How far a line may leave its glide plane before the normal is taken to be wrong, in Burgers magnitudes. Smaller
  /// deviations are rounding of the file: nodes are moved onto their planes.
  double plane_tolerance = 1e-2;
};

struct ParadisData
{
  Network network;
  Vec3 lower = Vec3::Zero(); ///< minCoordinates, nm
  Vec3 upper = Vec3::Zero(); ///< maxCoordinates, nm
  /// One line each, starting "file:line:", about lines whose glide plane cannot be used (b . n or xi . n not zero, two
  /// normals for one connection: the segment gets no plane) and partial pins that are read as pinned.
  /// In strict mode each of them is an error.
  std::vector<std::string> warnings;
};

/// Reads a ParaDiS data file of version 4 or 5 (text nodal section, the same in both).
///
/// Lengths are multiplied by the Burgers magnitude. Node ids are the indices of the file when all tags are of one
/// domain, and count the nodes in file order otherwise. A segment starts at the node that the file lists first.
/// Normals of zero length mean a line without glide plane. Arms of a node whose normals are parallel share one plane.
///
/// Constraints: 0 free; 7 pinned; 8 surface (any code with that bit that is not all pinned), and 1 or 6, which the
/// ParaDiS versions with free surfaces use for the same, at nodes with one arm. Every other code between 1 and 6 pins
/// some directions only; it is read as pinned, with a warning (ParaDiS treats it so in its topological operations).
///
/// Throws std::invalid_argument if the Burgers magnitude is not positive, FileError for everything in the file:
/// unreadable, other version, malformed or missing numbers, truncated or too long, repeated nodes, arms to missing
/// nodes, arms without the opposite arm or with one whose Burgers vector is not opposite, two connections between the
/// same nodes, Burgers vectors that do not add up to zero at a free node.
ParadisData read_paradis_data(const std::filesystem::path &path, const ParadisReadOptions &options);

/// Writes version 4, lengths in units of @p burgers_magnitude (nm), box corners in nm. Node tags are 0,id; constraint
/// codes 0, 7 and 8. The file appears complete or not at all: it is written under a temporary name and renamed.
/// Throws FileError if it cannot be written, std::invalid_argument if an id exceeds the 32 bits of ParaDiS tags or the
/// Burgers magnitude is not positive.
void write_paradis_data(const std::filesystem::path &path, const Network &network, double burgers_magnitude,
                        const Vec3 &lower, const Vec3 &upper);
} // namespace ddfem
