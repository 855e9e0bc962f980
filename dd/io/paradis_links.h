// Connections and constraints of a ParaDiS data file. Internal to the reader.
#pragma once

#include "dd/io/paradis_file.h"
#include "dd/network/network.h"

#include <functional>

namespace ddfem::paradis
{
/// What to do about something doubtful in a line of the file: note it, or refuse the file.
using Warn = std::function<void(std::size_t line, const std::string &message)>;

/// A connection, from the node that the file lists first to the one it lists later.
struct Link
{
  std::size_t start = 0, end = 0; ///< positions in File::nodes
  Vec3 burgers = Vec3::Zero();    ///< units of the file
  Vec3 normal = Vec3::Zero();     ///< unit; zero for a line without a (usable) glide plane
  std::size_t line = 0;
};

/// Pairs the arms. Throws FileError if they do not match; reports b . n != 0 and contradicting normals.
std::vector<Link> links_of(const File &file, const Warn &warn);

/// Throws FileError if the Burgers vectors at a free node do not add up to zero.
void check_conservation(const File &file);

/// Meaning of the constraint code; see read_paradis_data(). Throws FileError for a code without meaning.
NodeConstraint constraint_of(const File &file, const FileNode &node, const Warn &warn);
} // namespace ddfem::paradis
