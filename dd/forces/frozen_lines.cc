#include "dd/forces/frozen_lines.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace ddfem
{
namespace
{
/// How far the middle of a line may lie outside its box, in shortest edges of the periodic cell: images are exact in a margin only.
constexpr double farthest_of_cell = 0.05;
/// What is summed in closed form for all points, at most: about as much as near lines.
constexpr std::size_t most_corrections = 256;
/// In motions before.
constexpr double farthest_ahead = 10;
constexpr std::uint32_t no_box = 0xffffffffU;

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

/// Whether a line with its middle at @p x is near enough to a box.
bool stays(const Vec3 &x, const std::uint32_t box, const PeriodicCell *const cell, const fmm::Octree &tree,
           LinesInBoxes &placed)
{
  return placed.stays(x, box, tree) &&
         (!cell || tree.distance_outside(box, x) <= farthest_of_cell * cell->lengths.minCoeff());
}

/// Areas that all lines sweep, compared with those before. They add up at random: by the squares.
class SweptAreas
{
public:
  void add(const double length, const Vec3 &now, const Vec3 &before)
  {
    now_before += now.dot(before);
    before_before += before.squaredNorm();
    total_length += length;
    n += 1;
  }
  double ahead() const { return before_before > 0 ? std::clamp(now_before / before_before, 0.0, farthest_ahead) : 0.0; }
  double curvature() const
  {
    const double before = displacement(before_before);
    return ahead() * (1 + ahead()) * before * before;
  }
  /// Of all lines, that sweeps areas with this sum of squares (nm^4), nm.
  double displacement(const double squares) const
  {
    return total_length > 0 ? std::sqrt(std::max(0.0, squares) * n) / total_length : 0.0;
  }

private:
  double now_before = 0, before_before = 0; ///< sums of products, nm^4
  double total_length = 0, n = 0;           ///< of the lines, nm; number
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

FrozenLines::FrozenLines(const Network &network, const LineSystem &system, const std::span<const fmm::LineSource> lines,
                         const std::span<const std::uint32_t> box, const CutRays &cuts, const FrozenLines *const before)
    : rays(system.rays(), cuts, box.subspan(network.n_segments()))
{
  frozen.reserve(network.n_segments());
  std::vector<std::size_t> appeared;
  for (std::size_t i = 0; const SegmentIndex s : network.segments())
  {
    Line line{network.id(s),
              network.id(network.start(s)),
              network.id(network.end(s)),
              {lines[i].start, lines[i].end, lines[i].burgers},
              box[i],
              Vec3::Zero(),
              Vec3::Zero()};
    if (const Line *const old = before ? before->find(network, s) : nullptr)
    {
      const Vec3 shift = shift_towards(system.cell(), middle(line.line), middle(old->line));
      line.start_motion = line.line.start + shift - old->line.start;
      line.end_motion = line.line.end + shift - old->line.end;
    }
    else
      appeared.push_back(i);
    frozen.push_back(line);
    ++i;
  }
  if (before)
    join_motion(appeared, system, *before);
  std::sort(frozen.begin(), frozen.end(), [](const Line &a, const Line &b) { return a.id < b.id; });
}

/// Lines that have @p appeared, and rays, move with the ends of their neighbours: with a gap between the two, the field before
/// would have lines that end there.
void FrozenLines::join_motion(const std::span<const std::size_t> appeared, const LineSystem &system,
                              const FrozenLines &before)
{
  std::unordered_map<ObjectId, Vec3> motion_of;
  for (const VirtualRay &r : system.rays())
    motion_of.emplace(r.node, Vec3::Zero());
  for (const std::size_t i : appeared)
    for (const ObjectId node : {frozen[i].start_node, frozen[i].end_node})
      motion_of.emplace(node, Vec3::Zero());
  const auto note = [&](const ObjectId node, const Vec3 &motion)
  {
    if (const auto found = motion_of.find(node); found != motion_of.end() && !motion.isZero(0))
      found->second = motion;
  };
  for (const Line &line : frozen)
  {
    note(line.start_node, line.start_motion);
    note(line.end_node, line.end_motion);
  }
  for (const std::size_t i : appeared)
  {
    frozen[i].start_motion = motion_of.at(frozen[i].start_node);
    frozen[i].end_motion = motion_of.at(frozen[i].end_node);
  }
  rays.set_motion(before.rays, motion_of);
}

void FrozenLines::forget_motion()
{
  for (Line &line : frozen)
    line.start_motion = line.end_motion = Vec3::Zero();
  rays.forget_motion();
}

FrozenLines::Earlier FrozenLines::earlier(const Network &network) const
{
  Earlier result;
  for (const SegmentIndex s : network.segments())
    result.lines.push_back(moved(extrapolated(*find(network, s), -1), Vec3::Zero()));
  rays.append_earlier(result.lines, result.distant_rays);
  return result;
}

/// The same line at the time of the far field; null if it is new or has another Burgers vector.
const FrozenLines::Line *FrozenLines::find(const Network &network, const SegmentIndex s) const
{
  const auto l = std::lower_bound(frozen.begin(), frozen.end(), network.id(s),
                                  [](const Line &line, const ObjectId id) { return line.id < id; });
  return l != frozen.end() && l->id == network.id(s) && l->line.burgers == network.burgers(s) ? &*l : nullptr;
}

std::optional<LinesInBoxes> FrozenLines::place(const Network &network, const LineSystem &system,
                                               const fmm::Octree &tree, const double longest_jump) const
{
  std::vector<const Line *> known;
  SweptAreas areas;
  for (std::size_t i = 0; const SegmentIndex s : network.segments())
  {
    known.push_back(find(network, s));
    if (const Line *const old = known.back())
    {
      const Motion motion = motion_of(*old, system.lines()[i], system.cell());
      const Vec3 t = old->line.end - old->line.start;
      areas.add(t.norm(), motion.area(t), Motion{old->start_motion, old->end_motion}.area(t));
    }
    ++i;
  }
  LinesInBoxes placed;
  placed.ahead = areas.ahead();
  placed.curvature = areas.curvature();
  std::vector<std::uint8_t> is_here(frozen.size(), 0);
  double squares = 0;
  if (!place_known(known, longest_jump, system, tree, placed, is_here, squares))
    return {};
  const auto changed = rays.place(system.rays(), tree, longest_jump, placed, squares);
  if (!changed)
    return {};
  placed.n_of_system = placed.lines.size();
  placed.displacement = areas.displacement(squares);
  double swept2 = 0;
  for (const Patch &p : patches(network, is_here, placed))
    if (double swept = 0; !has_node_of(p, network, *changed) && place_patch(p, system, tree, placed, swept))
      swept2 += swept * swept;
    else if (!system.cell())
      correct_patch(p, system, tree, placed);
    else
      return {};
  placed.jump = areas.displacement(swept2);
  if (placed.corrections.size() > most_corrections)
    return {};
  return placed;
}

/// Motion since, as if the cell had no boundaries.
FrozenLines::Motion FrozenLines::motion_of(const Line &old, const StraightLine &now, const PeriodicCell *const cell)
{
  const Vec3 shift = shift_towards(cell, middle(now), middle(old.line));
  return {now.start + shift - old.line.start, now.end + shift - old.line.end};
}

/// Puts lines that have moved on, and by less than @p longest_jump (in box sizes) besides, into their boxes; others get no
/// box. @p is_here: which of the frozen ones these are. @p squares: sum of squares of the areas they have swept besides.
bool FrozenLines::place_known(const std::vector<const Line *> &known, const double longest_jump,
                              const LineSystem &system, const fmm::Octree &tree, LinesInBoxes &placed,
                              std::vector<std::uint8_t> &is_here, double &squares) const
{
  placed.lines.resize(known.size());
  placed.box.assign(known.size(), no_box);
  for (std::size_t i = 0; i < known.size(); ++i)
    if (known[i])
    {
      const Line &old = *known[i];
      const StraightLine &l = system.lines()[i];
      Motion rest = motion_of(old, l, system.cell());
      rest.start -= placed.ahead * old.start_motion;
      rest.end -= placed.ahead * old.end_motion;
      if (std::max(rest.start.norm(), rest.end.norm()) > longest_jump * tree.size(tree.boxes()[old.box]))
        continue;
      const Vec3 shift = shift_towards(system.cell(), middle(l), middle(old.line));
      placed.lines[i] = moved(l, shift);
      placed.box[i] = old.box;
      is_here[static_cast<std::size_t>(&old - frozen.data())] = 1;
      squares += rest.area(old.line.end - old.line.start).squaredNorm();
      if (!stays(middle(l) + shift, old.box, system.cell(), tree, placed))
        return false;
    }
  return true;
}

std::vector<FrozenLines::Patch> FrozenLines::patches(const Network &network, const std::vector<std::uint8_t> &is_here,
                                                     const LinesInBoxes &placed) const
{
  std::vector<std::size_t> appeared;
  for (std::size_t i = 0; i < network.n_segments(); ++i)
    if (placed.box[i] == no_box)
      appeared.push_back(i);
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

/// A line where the far field has it.
StraightLine FrozenLines::extrapolated(const Line &l, const double ahead)
{
  return {l.line.start + ahead * l.start_motion, l.line.end + ahead * l.end_motion, l.line.burgers};
}

bool FrozenLines::fits(const Patch &patch, const Line &host, const LineSystem &system, const fmm::Octree &tree) const
{
  const auto is_near = [&](const StraightLine &l)
  {
    const Vec3 x = middle(l);
    LinesInBoxes unused;
    return stays(x + shift_towards(system.cell(), x, middle(host.line)), host.box, system.cell(), tree, unused);
  };
  return std::all_of(patch.gone.begin(), patch.gone.end(), [&](std::size_t k) { return is_near(frozen[k].line); }) &&
         std::all_of(patch.appeared.begin(), patch.appeared.end(),
                     [&](std::size_t i) { return is_near(system.lines()[i]); });
}

bool FrozenLines::place_patch(const Patch &patch, const LineSystem &system, const fmm::Octree &tree,
                              LinesInBoxes &placed, double &swept) const
{
  const auto found = std::find_if(patch.gone.begin(), patch.gone.end(),
                                  [&](std::size_t k) { return fits(patch, frozen[k], system, tree); });
  if (found == patch.gone.end())
    return false;
  const Line &host = frozen[*found];
  const auto shift_of = [&](const StraightLine &l)
  { return shift_towards(system.cell(), middle(l), middle(host.line)); };
  for (const std::size_t i : patch.appeared)
  {
    placed.lines[i] = moved(system.lines()[i], shift_of(system.lines()[i]));
    placed.box[i] = host.box;
    placed.stays(0.5 * (placed.lines[i].start + placed.lines[i].end), host.box, tree);
  }
  for (const std::size_t k : patch.gone)
    if (const Vec3 shift = shift_of(frozen[k].line); frozen[k].box != host.box || !shift.isZero(0))
    {
      const StraightLine gone = extrapolated(frozen[k], placed.ahead);
      placed.lines.push_back(moved(gone, Vec3::Zero()));
      placed.box.push_back(frozen[k].box);
      placed.lines.push_back(moved(gone, shift, -1));
      placed.box.push_back(host.box);
    }
  swept = area_swept_by(patch, host, system, placed.ahead);
  return true;
}

/// In closed form, for all points to which the patch is distant.
void FrozenLines::correct_patch(const Patch &patch, const LineSystem &system, const fmm::Octree &tree,
                                LinesInBoxes &placed) const
{
  for (const std::size_t i : patch.appeared)
  {
    placed.lines[i] = moved(system.lines()[i], Vec3::Zero());
    placed.box[i] = placed.box_of_new(placed.lines[i], tree);
  }
  for (const std::size_t k : patch.gone)
    placed.corrections.push_back({moved(extrapolated(frozen[k], placed.ahead), Vec3::Zero(), -1), frozen[k].box});
}

bool FrozenLines::has_node_of(const Patch &patch, const Network &network, const FrozenRays::Nodes &nodes) const
{
  if (nodes.empty())
    return false;
  const auto any = [&](const ObjectId a, const ObjectId b) { return nodes.contains(a) || nodes.contains(b); };
  const auto is_gone = [&](std::size_t k) { return any(frozen[k].start_node, frozen[k].end_node); };
  const auto has_appeared = [&](std::size_t i)
  {
    const SegmentIndex s = network.segments()[i];
    return any(network.id(network.start(s)), network.id(network.end(s)));
  };
  return std::any_of(patch.gone.begin(), patch.gone.end(), is_gone) ||
         std::any_of(patch.appeared.begin(), patch.appeared.end(), has_appeared);
}

/// Area of the loops between the lines of a patch now and where those before would be, by their moment, nm^2.
double FrozenLines::area_swept_by(const Patch &patch, const Line &host, const LineSystem &system,
                                  const double ahead) const
{
  const Vec3 centre = middle(host.line);
  Mat3 moment = Mat3::Zero();
  double largest = 0; // Burgers vector
  const auto add = [&](const StraightLine &l, const double sign)
  {
    const Vec3 start = l.start + shift_towards(system.cell(), middle(l), centre) - centre;
    moment += 0.5 * sign * l.burgers * start.cross(Vec3(l.end - l.start)).transpose();
    largest = std::max(largest, l.burgers.norm());
  };
  for (const std::size_t k : patch.gone)
    add(extrapolated(frozen[k], ahead), -1);
  for (const std::size_t i : patch.appeared)
    add(system.lines()[i], 1);
  return largest > 0 ? moment.norm() / largest : 0.0;
}
} // namespace ddfem
