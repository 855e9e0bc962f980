// The content of a ParaDiS data file as it stands there, before it becomes a network. Internal to the reader.
#pragma once

#include "dd/common/types.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace ddfem::paradis
{
using Tag = std::pair<int, int>; ///< domain, index

std::string to_string(const Tag &tag);

/// "file:line: message"
std::string at_line(const std::filesystem::path &path, std::size_t line, const std::string &message);

struct Arm
{
  Tag tag;
  Vec3 burgers = Vec3::Zero(); ///< units of the file, line sense away from the node
  Vec3 normal = Vec3::Zero();  ///< as written, any length
  std::size_t line = 0;
};

struct FileNode
{
  Tag tag;
  Vec3 position = Vec3::Zero(); ///< units of the file
  int constraint = 0;
  std::vector<Arm> arms;
  std::size_t line = 0;
};

struct File
{
  std::filesystem::path path;
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero(); ///< units of the file
  std::vector<FileNode> nodes;
  std::map<Tag, std::size_t> node_of_tag;
};

/// Syntax, counts and tags. Throws FileError.
File parse(const std::filesystem::path &path);
} // namespace ddfem::paradis
