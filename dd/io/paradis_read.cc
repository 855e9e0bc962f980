#include "dd/io/file_error.h"
#include "dd/io/paradis_data.h"
#include "dd/io/paradis_links.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace ddfem
{
namespace
{
using namespace paradis;

/// Disjoint sets of links that lie on one glide plane.
class Groups
{
public:
  explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t find(std::size_t i)
  {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// The smaller number represents the set, so that the result does not depend on the order of the unions.
  void unite(std::size_t i, std::size_t j)
  {
    const std::size_t a = find(i), b = find(j);
    parent_[std::max(a, b)] = std::min(a, b);
  }

private:
  std::vector<std::size_t> parent_;
};

class Builder
{
public:
  Builder(const std::filesystem::path &path, const ParadisReadOptions &options)
      : options_(options), file_(parse(path)),
        warn_([this](std::size_t line, const std::string &message) { warn(line, message); }),
        links_(links_of(file_, warn_)), links_at_(file_.nodes.size())
  {
  }

  ParadisData build();

private:
  void warn(std::size_t line, const std::string &message)
  {
    const std::string text = at_line(file_.path, line, message);
    if (options_.strict)
      throw FileError(text);
    data_.warnings.push_back(text);
  }

  void place_nodes();
  void unwrap();
  Vec3 direction(const Link &link) const;
  /// Whether the link crosses the boundary of the cell even after unwrapping: it closes a line that winds around.
  bool winds(const Link &link) const;

  void find_families();
  void check_lines();
  bool same_family(std::size_t k, std::size_t l) const;
  void assign_planes();
  bool assign_plane(const std::vector<std::size_t> &group);
  void move_onto_planes();

  void insert_nodes();
  void insert_segments();

  const ParadisReadOptions &options_;
  File file_;
  Warn warn_;
  ParadisData data_;
  std::vector<Link> links_;
  std::vector<std::vector<std::size_t>> links_at_; ///< per node
  std::vector<Vec3> position_;                     ///< nm
  std::vector<Miller> miller_;                     ///< per link
  std::vector<PlaneIndex> plane_;                  ///< per link
  std::vector<NodeIndex> index_;                   ///< per node
};

ParadisData Builder::build()
{
  check_conservation(file_);
  for (std::size_t k = 0; k < links_.size(); ++k)
  {
    links_at_[links_[k].start].push_back(k);
    links_at_[links_[k].end].push_back(k);
  }
  place_nodes();
  find_families();
  check_lines();
  assign_planes();
  move_onto_planes();
  insert_nodes();
  insert_segments();
  return std::move(data_);
}

void Builder::place_nodes()
{
  data_.lower = options_.burgers_magnitude * file_.lower;
  data_.upper = options_.burgers_magnitude * file_.upper;
  for (const FileNode &node : file_.nodes)
    position_.emplace_back(options_.burgers_magnitude * node.position);
  if (options_.periodic)
  {
    data_.network.set_period(data_.upper - data_.lower);
    unwrap();
  }
}

void Builder::unwrap()
{
  std::vector<bool> placed(file_.nodes.size(), false);
  std::vector<std::size_t> queue;
  for (std::size_t first = 0; first < file_.nodes.size(); ++first)
  {
    if (placed[first])
      continue;
    placed[first] = true;
    queue.assign(1, first);
    for (std::size_t next = 0; next < queue.size(); ++next)
      for (const std::size_t k : links_at_[queue[next]])
      {
        const std::size_t here = queue[next];
        const std::size_t there = links_[k].start == here ? links_[k].end : links_[k].start;
        if (placed[there])
          continue;
        position_[there] = position_[here] + data_.network.minimum_image(position_[there] - position_[here]);
        placed[there] = true;
        queue.push_back(there);
      }
  }
}

Vec3 Builder::direction(const Link &link) const
{
  return data_.network.minimum_image(position_[link.end] - position_[link.start]);
}

bool Builder::winds(const Link &link) const
{
  const Vec3 plain = position_[link.end] - position_[link.start];
  return (plain - direction(link)).norm() > 1e-3 * options_.burgers_magnitude;
}

void Builder::find_families()
{
  miller_.resize(links_.size());
  if (!options_.cubic_orientation)
    return;
  for (std::size_t k = 0; k < links_.size(); ++k)
  {
    Link &link = links_[k];
    if (link.normal.isZero(0))
      continue;
    miller_[k] = without_sense(rationalised(options_.cubic_orientation->to_crystal(link.normal)));
    if (!is_zero(miller_[k]))
      link.normal = options_.cubic_orientation->unit_vector(miller_[k]);
  }
}

void Builder::check_lines()
{
  for (Link &link : links_)
  {
    const Vec3 line = direction(link);
    if (line.norm() < 1e-9 * options_.burgers_magnitude)
      throw FileError(at_line(file_.path, link.line,
                              "nodes " + to_string(file_.nodes[link.start].tag) + " and " +
                                  to_string(file_.nodes[link.end].tag) +
                                  " are at the same place; a connection must have a length."));
    const double rise = line.dot(link.normal) / options_.burgers_magnitude;
    if (std::abs(rise) <= 2 * options_.plane_tolerance)
      continue;
    warn(link.line, "the line from node " + to_string(file_.nodes[link.start].tag) + " to " +
                        to_string(file_.nodes[link.end].tag) + " leaves its glide plane by " + std::to_string(rise) +
                        " Burgers magnitudes; at most " + std::to_string(2 * options_.plane_tolerance) +
                        " is taken for rounding. The segment gets no glide plane.");
    link.normal = Vec3::Zero();
  }
}

bool Builder::same_family(std::size_t k, std::size_t l) const
{
  if (links_[k].normal.isZero(0) || links_[l].normal.isZero(0))
    return false;
  if (!is_zero(miller_[k]) || !is_zero(miller_[l]))
    return miller_[k] == miller_[l];
  return links_[k].normal.cross(links_[l].normal).norm() <= 1e-6;
}

void Builder::assign_planes()
{
  // Arms of one node with parallel normals lie on one plane: coordinates with few digits must not make it several.
  Groups groups(links_.size());
  for (const std::vector<std::size_t> &arms : links_at_)
    for (const std::size_t k : arms)
      for (const std::size_t l : arms)
        if (k < l && same_family(k, l) && !winds(links_[k]) && !winds(links_[l]))
          groups.unite(k, l);
  std::vector<std::vector<std::size_t>> members(links_.size());
  for (std::size_t k = 0; k < links_.size(); ++k)
    if (!links_[k].normal.isZero(0) && !winds(links_[k]))
      members[groups.find(k)].push_back(k);
  plane_.resize(links_.size());
  for (const std::vector<std::size_t> &group : members)
    if (!group.empty() && !assign_plane(group))
      warn(links_[group.front()].line, "the " + std::to_string(group.size()) +
                                           " connected segments of the glide plane of this arm are not coplanar to " +
                                           std::to_string(options_.plane_tolerance) +
                                           " Burgers magnitudes. They get no glide plane.");
}

bool Builder::assign_plane(const std::vector<std::size_t> &group)
{
  Vec3 centre = Vec3::Zero();
  for (const std::size_t k : group)
    centre += 0.5 * (position_[links_[k].start] + position_[links_[k].end]);
  centre /= static_cast<double>(group.size());
  const Vec3 &normal = links_[group.front()].normal;
  for (const std::size_t k : group)
    for (const std::size_t i : {links_[k].start, links_[k].end})
      if (std::abs((position_[i] - centre).dot(normal)) > options_.plane_tolerance * options_.burgers_magnitude)
        return false;
  const PlaneIndex plane = data_.network.planes().find_or_insert(miller_[group.front()], normal, centre);
  for (const std::size_t k : group)
    plane_[k] = plane;
  return true;
}

void Builder::move_onto_planes()
{
  std::vector<PlaneIndex> planes;
  for (std::size_t i = 0; i < position_.size(); ++i)
  {
    planes.clear();
    for (const std::size_t k : links_at_[i])
      planes.push_back(plane_[k]);
    position_[i] = data_.network.planes().project_on_intersection(planes, position_[i]);
  }
  // The plane of a line that winds around the cell goes through its start.
  for (std::size_t k = 0; k < links_.size(); ++k)
    if (!links_[k].normal.isZero(0) && winds(links_[k]))
      plane_[k] = data_.network.planes().find_or_insert(miller_[k], links_[k].normal, position_[links_[k].start]);
}

void Builder::insert_nodes()
{
  const auto of_first_domain = [this](const FileNode &node)
  { return node.tag.first == file_.nodes.front().tag.first && node.tag.second >= 0; };
  const bool keep_indices = std::ranges::all_of(file_.nodes, of_first_domain);
  data_.network.reserve(file_.nodes.size(), links_.size());
  for (std::size_t i = 0; i < file_.nodes.size(); ++i)
  {
    const FileNode &node = file_.nodes[i];
    const NodeConstraint constraint = constraint_of(file_, node, warn_);
    index_.emplace_back();
    if (constraint == NodeConstraint::free && node.arms.empty())
      warn(node.line, "free node " + to_string(node.tag) + " has no arms; it is left out.");
    else
      index_.back() = data_.network.insert(Node{position_[i], constraint},
                                           keep_indices ? static_cast<ObjectId>(node.tag.second) : ObjectId{i});
  }
}

void Builder::insert_segments()
{
  for (std::size_t k = 0; k < links_.size(); ++k)
    data_.network.insert(Segment{index_[links_[k].start], index_[links_[k].end],
                                 options_.burgers_magnitude * links_[k].burgers, plane_[k]});
}
} // namespace

ParadisData read_paradis_data(const std::filesystem::path &path, const ParadisReadOptions &options)
{
  if (!(options.burgers_magnitude > 0) || !std::isfinite(options.burgers_magnitude))
    throw std::invalid_argument("The Burgers magnitude, unit of length of " + path.string() + ", is " +
                                std::to_string(options.burgers_magnitude) + " nm; it must be positive.");
  return Builder(path, options).build();
}
} // namespace ddfem
