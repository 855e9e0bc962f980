#include "dd/forces/frozen_lines.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace ddfem
{
namespace
{
/// How far the middle of a line may lie outside its box, in box sizes, and in shortest edges of the periodic cell: images are
/// exact in a margin only.
constexpr double farthest_of_box = 0.25, farthest_of_cell = 0.05;
/// In motions before.
constexpr double farthest_ahead = 10;

Vec3 middle(const StraightLine &l)
{
  return 0.5 * (l.start + l.end);
}

/// Lattice vector that takes @p x to the image nearest to @p reference.
Vec3 shift_towards(const PeriodicCell *const cell, const Vec3 &x, const Vec3 &reference)
{
  if (!cell)
    return Vec3::Zero();
  const Vec3 d = x - reference;
  return cell->minimum_image(d) - d;
}

/// Whether a line with its middle at @p x is near enough to a box. @p farthest: set to the largest distance, in box sizes.
bool stays(const Vec3 &x, const std::uint32_t box, const PeriodicCell *const cell, const fmm::Octree &tree,
           double &farthest)
{
  const double outside = tree.distance_outside(box, x), size = tree.size(tree.boxes()[box]);
  farthest = std::max(farthest, outside / size);
  return outside <= farthest_of_box * size && (!cell || outside <= farthest_of_cell * cell->lengths.minCoeff());
}

/// Motion of the ends of all lines, compared with the one before.
class Motion
{
public:
  void add(const Vec3 &now, const Vec3 &before)
  {
    now_now += now.squaredNorm();
    now_before += now.dot(before);
    before_before += before.squaredNorm();
    n += 1;
  }
  void finish(LinesInBoxes &placed) const
  {
    if (n == 0)
      return;
    const double t = before_before > 0 ? std::clamp(now_before / before_before, 0.0, farthest_ahead) : 0.0;
    const double left = now_now - 2 * t * now_before + t * t * before_before;
    placed.ahead = t;
    placed.displacement = std::sqrt(std::max(0.0, left / n));
    placed.curvature = t * (1 + t) * before_before / n;
  }

private:
  double now_now = 0, now_before = 0, before_before = 0, n = 0; ///< sums of products, nm^2; number
};

fmm::LineSource moved(const StraightLine &l, const Vec3 &shift, const double sign = 1)
{
  return {l.start + shift, l.end + shift, sign * l.burgers};
}

/// Joins nodes by their ids.
class NodeGroups
{
public:
  std::size_t group_of(const ObjectId node)
  {
    std::size_t i = number.try_emplace(node, parent.size()).first->second;
    if (i == parent.size())
      parent.push_back(i);
    while (parent[i] != i)
      i = parent[i] = parent[parent[i]];
    return i;
  }
  void join(const ObjectId a, const ObjectId b)
  {
    const std::size_t i = group_of(a), j = group_of(b);
    parent[std::max(i, j)] = std::min(i, j);
  }
  std::size_t size() const { return parent.size(); }

private:
  std::unordered_map<ObjectId, std::size_t> number;
  std::vector<std::size_t> parent;
};
} // namespace

FrozenLines::FrozenLines(const Network &network, const LineSystem &system, const fmm::Octree &tree)
{
  const std::vector<std::uint32_t> boxes = tree.boxes_of_lines();
  for (std::size_t i = 0; const SegmentIndex s : network.segments())
  {
    frozen.push_back({network.id(s), network.id(network.start(s)), network.id(network.end(s)), system.lines()[i],
                      boxes[i], Vec3::Zero(), Vec3::Zero()});
    ++i;
  }
  sort();
}

void FrozenLines::sort()
{
  std::sort(frozen.begin(), frozen.end(), [](const Line &a, const Line &b) { return a.id < b.id; });
}

FrozenLines FrozenLines::continued(const Network &network, const LinesInBoxes &placed) const
{
  FrozenLines now;
  for (std::size_t i = 0; const SegmentIndex s : network.segments())
  {
    const fmm::LineSource &l = placed.lines[i];
    Line line{network.id(s),
              network.id(network.start(s)),
              network.id(network.end(s)),
              {l.start, l.end, l.burgers},
              placed.box[i],
              Vec3::Zero(),
              Vec3::Zero()};
    // Lines that have changed their box belong to other expansions: their change is no motion.
    if (const Line *const old = find(network, s); old && placed.lines.size() == network.n_segments())
    {
      line.start_motion = l.start - old->line.start;
      line.end_motion = l.end - old->line.end;
    }
    now.frozen.push_back(line);
    ++i;
  }
  now.sort();
  return now;
}

/// The same line at the time of the far field; null if it is new or has another Burgers vector.
const FrozenLines::Line *FrozenLines::find(const Network &network, const SegmentIndex s) const
{
  const auto l = std::lower_bound(frozen.begin(), frozen.end(), network.id(s),
                                  [](const Line &line, const ObjectId id) { return line.id < id; });
  return l != frozen.end() && l->id == network.id(s) && l->line.burgers == network.burgers(s) ? &*l : nullptr;
}

std::optional<LinesInBoxes> FrozenLines::place(const Network &network, const LineSystem &system,
                                               const fmm::Octree &tree) const
{
  LinesInBoxes placed;
  placed.lines.resize(system.lines().size());
  placed.box.resize(system.lines().size());
  std::vector<std::uint8_t> is_here(frozen.size(), 0);
  std::vector<std::size_t> appeared;
  Motion motion;
  for (std::size_t i = 0; const SegmentIndex s : network.segments())
  {
    const StraightLine &l = system.lines()[i];
    if (const Line *const old = find(network, s))
    {
      const Vec3 shift = shift_towards(system.cell(), middle(l), middle(old->line));
      placed.lines[i] = moved(l, shift);
      placed.box[i] = old->box;
      placed.in_system_frame = placed.in_system_frame && shift.isZero(0);
      motion.add(l.start + shift - old->line.start, old->start_motion);
      motion.add(l.end + shift - old->line.end, old->end_motion);
      is_here[static_cast<std::size_t>(old - frozen.data())] = 1;
      if (!stays(middle(l) + shift, old->box, system.cell(), tree, placed.farthest))
        return {};
    }
    else
      appeared.push_back(i);
    ++i;
  }
  motion.finish(placed);
  for (const Patch &p : patches(network, is_here, appeared))
    if (!place_patch(p, system, tree, placed))
      return {};
  return placed;
}

std::vector<FrozenLines::Patch> FrozenLines::patches(const Network &network, const std::vector<std::uint8_t> &is_here,
                                                     const std::vector<std::size_t> &appeared) const
{
  NodeGroups groups;
  for (std::size_t k = 0; k < frozen.size(); ++k)
    if (is_here[k] == 0)
      groups.join(frozen[k].start_node, frozen[k].end_node);
  const auto node = [&](const std::size_t i) { return network.id(network.start(network.segments()[i])); };
  for (const std::size_t i : appeared)
    groups.join(node(i), network.id(network.end(network.segments()[i])));
  std::vector<Patch> of_group(groups.size());
  for (std::size_t k = 0; k < frozen.size(); ++k)
    if (is_here[k] == 0)
      of_group[groups.group_of(frozen[k].start_node)].gone.push_back(k);
  for (const std::size_t i : appeared)
    of_group[groups.group_of(node(i))].appeared.push_back(i);
  std::erase_if(of_group, [](const Patch &p) { return p.gone.empty() && p.appeared.empty(); });
  return of_group;
}

bool FrozenLines::fits(const Patch &patch, const Line &host, const LineSystem &system, const fmm::Octree &tree) const
{
  const auto is_near = [&](const StraightLine &l)
  {
    const Vec3 x = middle(l);
    double farthest = 0;
    return stays(x + shift_towards(system.cell(), x, middle(host.line)), host.box, system.cell(), tree, farthest);
  };
  return std::all_of(patch.gone.begin(), patch.gone.end(), [&](std::size_t k) { return is_near(frozen[k].line); }) &&
         std::all_of(patch.appeared.begin(), patch.appeared.end(),
                     [&](std::size_t i) { return is_near(system.lines()[i]); });
}

bool FrozenLines::place_patch(const Patch &patch, const LineSystem &system, const fmm::Octree &tree,
                              LinesInBoxes &placed) const
{
  const auto found = std::find_if(patch.gone.begin(), patch.gone.end(),
                                  [&](std::size_t k) { return fits(patch, frozen[k], system, tree); });
  if (found == patch.gone.end())
    return false;
  const Line &host = frozen[*found];
  const auto shift_of = [&](const StraightLine &l)
  {
    const Vec3 shift = shift_towards(system.cell(), middle(l), middle(host.line));
    placed.in_system_frame = placed.in_system_frame && shift.isZero(0);
    return shift;
  };
  for (const std::size_t i : patch.appeared)
  {
    placed.lines[i] = moved(system.lines()[i], shift_of(system.lines()[i]));
    placed.box[i] = host.box;
  }
  for (const std::size_t k : patch.gone)
    if (const Vec3 shift = shift_of(frozen[k].line); frozen[k].box != host.box || !shift.isZero(0))
    {
      placed.lines.push_back(moved(frozen[k].line, Vec3::Zero()));
      placed.box.push_back(frozen[k].box);
      placed.lines.push_back(moved(frozen[k].line, shift, -1));
      placed.box.push_back(host.box);
    }
  return true;
}
} // namespace ddfem
