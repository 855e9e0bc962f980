#include "dd/io/paradis_links.h"

#include "dd/io/file_error.h"

#include <algorithm>
#include <cstdio>

namespace ddfem::paradis
{
namespace
{
/// Files carry at least six significant digits.
constexpr double burgers_tolerance = 1e-5;
constexpr double normal_tolerance = 1e-4;

// Constraint bits of ParaDiS 4.
constexpr int all_pinned = 7;
constexpr int surface_bit = 8;
/// Set by post-processing tools; no constraint.
constexpr int marks = 0x1000 | 0x2000 | 0x4000;

std::string text_of(const Vec3 &v)
{
  char text[96];
  std::snprintf(text, sizeof(text), "(%.10g, %.10g, %.10g)", v[0], v[1], v[2]);
  return text;
}

[[noreturn]] void fail(const File &file, std::size_t line, const std::string &message)
{
  throw FileError(at_line(file.path, line, message));
}

const FileNode &neighbour(const File &file, const FileNode &node, const Arm &arm)
{
  const auto found = file.node_of_tag.find(arm.tag);
  if (found == file.node_of_tag.end())
    fail(file, arm.line,
         "node " + to_string(node.tag) + " has an arm to node " + to_string(arm.tag) +
             ", which the file does not contain.");
  if (arm.tag == node.tag)
    fail(file, arm.line, "node " + to_string(node.tag) + " has an arm to itself.");
  return file.nodes[found->second];
}

/// The arm that leads back from @p other.
const Arm &opposite_arm(const File &file, const FileNode &node, const Arm &arm, const FileNode &other)
{
  const auto back = std::ranges::find(other.arms, node.tag, &Arm::tag);
  if (back == other.arms.end())
    fail(file, arm.line,
         "node " + to_string(node.tag) + " has an arm to node " + to_string(other.tag) +
             ", but none leads back; every connection must appear at both its nodes.");
  if (!((arm.burgers + back->burgers).norm() <= burgers_tolerance * arm.burgers.norm()))
    fail(file, back->line,
         "the Burgers vector from node " + to_string(other.tag) + " to " + to_string(node.tag) + " is " +
             text_of(back->burgers) + "; it must be opposite to the one from " + to_string(node.tag) + " to " +
             to_string(other.tag) + ", " + text_of(arm.burgers) + " (line " + std::to_string(arm.line) + ").");
  return *back;
}

/// Unit normal of a connection, zero if there is none that can be used.
Vec3 glide_normal(const Arm &arm, const Arm &back, const Warn &warn)
{
  if (arm.normal.norm() < normal_tolerance || back.normal.norm() < normal_tolerance)
    return Vec3::Zero();
  Vec3 n = arm.normal.normalized();
  if (n.cross(back.normal.normalized()).norm() > normal_tolerance)
  {
    warn(back.line, "the glide-plane normal is " + text_of(back.normal) + " here, " + text_of(arm.normal) +
                        " at the other end (line " + std::to_string(arm.line) +
                        "); they must agree up to the sign. The segment gets no glide plane.");
    return Vec3::Zero();
  }
  const double component = arm.burgers.normalized().dot(n);
  if (std::abs(component) > normal_tolerance)
  {
    char text[32];
    std::snprintf(text, sizeof(text), "%.3g", component);
    warn(arm.line, "b . n / |b| is " + std::string(text) + " for b = " + text_of(arm.burgers) +
                       " and n = " + text_of(arm.normal) + "; it must be zero. The segment gets no glide plane.");
    return Vec3::Zero();
  }
  return n;
}

void check_arms(const File &file, const FileNode &node)
{
  for (std::size_t k = 0; k < node.arms.size(); ++k)
  {
    const Arm &arm = node.arms[k];
    if (arm.burgers.norm() < burgers_tolerance)
      fail(file, arm.line,
           "the Burgers vector of an arm of node " + to_string(node.tag) + " is " + text_of(arm.burgers) +
               "; it must not be zero.");
    for (std::size_t l = 0; l < k; ++l)
      if (node.arms[l].tag == arm.tag)
        fail(file, arm.line,
             "node " + to_string(node.tag) + " has two arms to node " + to_string(arm.tag) +
                 "; two nodes can be joined once.");
  }
}
} // namespace

std::vector<Link> links_of(const File &file, const Warn &warn)
{
  std::vector<Link> links;
  for (std::size_t i = 0; i < file.nodes.size(); ++i)
  {
    const FileNode &node = file.nodes[i];
    check_arms(file, node);
    for (const Arm &arm : node.arms)
    {
      const FileNode &other = neighbour(file, node, arm);
      const Arm &back = opposite_arm(file, node, arm, other);
      const std::size_t j = file.node_of_tag.at(other.tag);
      if (i < j)
        links.push_back({i, j, arm.burgers, glide_normal(arm, back, warn), arm.line});
    }
  }
  return links;
}

void check_conservation(const File &file)
{
  for (const FileNode &node : file.nodes)
  {
    Vec3 sum = Vec3::Zero();
    double largest = 0;
    for (const Arm &arm : node.arms)
    {
      sum += arm.burgers;
      largest = std::max(largest, arm.burgers.norm());
    }
    if ((node.constraint & ~marks) == 0 && sum.norm() > burgers_tolerance * largest)
      fail(file, node.line,
           "the Burgers vectors of the " + std::to_string(node.arms.size()) + " arms of node " + to_string(node.tag) +
               " add up to " + text_of(sum) + "; at a node with constraint 0 they must add up to zero.");
  }
}

NodeConstraint constraint_of(const File &file, const FileNode &node, const Warn &warn)
{
  const int code = node.constraint & ~marks;
  if (node.constraint < 0 || code > (all_pinned | surface_bit))
    fail(file, node.line,
         "the constraint of node " + to_string(node.tag) + " is " + std::to_string(node.constraint) +
             "; it must be 0 (free), 7 (pinned), 8 (surface) or a combination of the bits 1, 2, 4, 8.");
  if (code == 0)
    return NodeConstraint::free;
  if ((code & all_pinned) == all_pinned)
    return NodeConstraint::pinned;
  const bool one_arm = node.arms.size() == 1;
  if ((code & surface_bit) != 0)
  {
    if (!one_arm)
      warn(node.line, "surface node " + to_string(node.tag) + " has " + std::to_string(node.arms.size()) +
                          " arms; it must have one.");
    return NodeConstraint::surface;
  }
  if (one_arm && (code == 1 || code == 6))
    return NodeConstraint::surface;
  warn(node.line, "the constraint " + std::to_string(node.constraint) + " of node " + to_string(node.tag) +
                      " pins some directions only; the node is read as pinned (7).");
  return NodeConstraint::pinned;
}
} // namespace ddfem::paradis
