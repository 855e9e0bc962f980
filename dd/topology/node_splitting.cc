#include "dd/topology/node_splitting.h"

#include "dd/topology/line_operations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace ddfem
{
namespace
{
using Shifts = std::array<Vec3, 2>;

constexpr std::size_t most_arms = 8;

/// A split in the best configuration tried so far.
struct Outcome
{
  TrialSplit split;
  std::array<NodeMotion, 2> motion;
  double power = 0;
};

/// What a trial needs to know besides the partition.
struct TrialSettings
{
  const ProductPlane &product_plane;
  double separation; ///< of the parts, nm
  Vec3 node;         ///< position of the node, nm
};

/// One partition of the arms, nothing moved yet, and what follows from it.
struct Partition
{
  TrialSplit split;
  std::array<Mat3, 2> directions;
  Vec3 common = Vec3::Zero(); ///< the only line along which the unsplit node can move, if there is just one
  std::array<NodeMotion, 2> merged;
  Shifts arm_sum{Vec3::Zero(), Vec3::Zero()}; ///< sums of the arms' unit vectors
};

/// Arm k belongs to part 0 where bit k of @p mask is set.
Partition make_partition(const NodeNeighbourhood &node, const std::size_t mask)
{
  Partition p;
  for (std::size_t k = 0; k < node.arms().size(); ++k)
  {
    const NodeNeighbourhood::Arm &arm = node.arms()[k];
    const std::size_t side = (mask >> k & 1U) != 0 ? 0 : 1;
    p.split.arms[side].push_back(k);
    p.arm_sum[side] += arm.far_end.normalized();
    if (side == 0) // balance of part 0: the junction takes back what its arms carry away
      p.split.burgers -= arm.burgers;
  }
  if (p.split.burgers.norm() < 1e-6 * node.arms()[0].burgers.norm())
    p.split.burgers.setZero();
  p.common = only_direction(node.directions());
  for (std::size_t side = 0; side < 2; ++side)
  {
    p.directions[side] = node.directions(p.split.arms[side]);
    p.merged[side] = node.merged(p.split.arms[side]);
  }
  return p;
}

/// Directions worth trying, of any length: as the forces on the unsplit node pull the parts; along the only line that
/// both can take, or one of them; towards their own arms; across two lines that touch.
std::vector<Shifts> candidate_shifts(const NodeNeighbourhood &node, const Partition &p)
{
  std::vector<Shifts> found{{p.merged[0].velocity, p.merged[1].velocity}};
  const auto add_both_senses = [&](const Vec3 &u0, const Vec3 &u1)
  {
    found.push_back({u0, u1});
    found.push_back({-u0, -u1});
  };
  const Vec3 line0 = only_direction(p.directions[0]), line1 = only_direction(p.directions[1]);
  if (p.common.squaredNorm() > 0)
    add_both_senses(p.common, -p.common);
  else if (line0.squaredNorm() > 0)
    add_both_senses(line0, Vec3::Zero());
  else if (line1.squaredNorm() > 0)
    add_both_senses(Vec3::Zero(), line1);
  const Vec3 apart = p.arm_sum[0] - p.arm_sum[1];
  found.push_back({p.directions[0] * apart, p.directions[1] * -apart});
  if (p.split.burgers.isZero(0) && p.split.arms[0].size() == 2 && p.split.arms[1].size() == 2)
  {
    const auto chord = [&](const std::size_t side) -> Vec3
    { return node.arms()[p.split.arms[side][0]].far_end - node.arms()[p.split.arms[side][1]].far_end; };
    const Vec3 across = chord(0).cross(chord(1));
    add_both_senses(p.directions[0] * across, p.directions[1] * -across);
  }
  return found;
}

/// Sets the parts apart along @p shifts, scaled to the separation, and looks up the plane of the junction. False if
/// they would not part, or leave their planes or the line of a sessile junction.
bool set_apart(const NodeNeighbourhood &node, const TrialSettings &settings, const Shifts &shifts, TrialSplit &split)
{
  const double apart = (shifts[0] - shifts[1]).norm();
  if (apart < 1e-9 * (shifts[0].norm() + shifts[1].norm()) || apart == 0)
    return false;
  for (std::size_t side = 0; side < 2; ++side)
    split.shift[side] = settings.separation / apart * shifts[side];
  if (std::max(split.shift[0].norm(), split.shift[1].norm()) > 2 * settings.separation)
    return false;
  if (!split.burgers.isZero(0))
  {
    Network planes; // only its registry of planes is used
    const Vec3 xi = (split.shift[1] - split.shift[0]).normalized();
    std::vector<Vec3> parents;
    for (const NodeNeighbourhood::Arm &arm : node.arms())
      parents.push_back(arm.constraint.normal);
    const PlaneIndex plane =
        settings.product_plane(planes, xi, split.burgers, Vec3(settings.node + split.shift[0]), parents);
    split.junction_normal = plane.is_valid() ? planes.planes()[plane].normal : Vec3(Vec3::Zero());
  }
  for (std::size_t side = 0; side < 2; ++side)
    if ((node.directions(split, side) * split.shift[side] - split.shift[side]).norm() > 1e-6 * settings.separation)
      return false;
  // Lines that cross in the trial have passed through each other.
  return node.clearance(split) > 0.2 * settings.separation;
}

std::optional<Outcome> attempt(const NodeNeighbourhood &node, const TrialSettings &settings, const Partition &p,
                               const Shifts &shifts)
{
  Outcome outcome{p.split, {}, 0};
  if (!set_apart(node, settings, shifts, outcome.split))
    return std::nullopt;
  outcome.motion = node.motion(outcome.split);
  outcome.power = outcome.motion[0].power() + outcome.motion[1].power();
  return outcome;
}

/// Whether the parts move apart by themselves, and not only together.
bool separates(const Outcome &o)
{
  const Vec3 apart = (o.split.shift[0] - o.split.shift[1]).normalized();
  const Vec3 &v0 = o.motion[0].velocity, &v1 = o.motion[1].velocity;
  return (v0 - v1).dot(apart) > 0.05 * (v0.norm() + v1.norm());
}

/// The best configuration of one partition. Each direction is followed by the one in which its own forces point.
std::optional<Outcome> best_of_partition(const NodeNeighbourhood &node, const TrialSettings &settings,
                                         const Partition &p)
{
  std::optional<Outcome> best;
  const auto consider = [&](const std::optional<Outcome> &o)
  {
    if (o && separates(*o) && (!best || o->power > best->power))
      best = o;
  };
  for (const Shifts &shifts : candidate_shifts(node, p))
  {
    const auto first = attempt(node, settings, p, shifts);
    consider(first);
    if (first)
      consider(attempt(node, settings, p, {first->motion[0].velocity, first->motion[1].velocity}));
  }
  return best;
}

std::optional<Outcome> best_split(const NodeNeighbourhood &node, const TrialSettings &settings, const double margin)
{
  const std::size_t n_arms = node.arms().size();
  double threshold = (1 + margin) * node.whole().power();
  std::optional<Outcome> best;
  // Every partition once: the first arm always belongs to part 0.
  for (std::size_t mask = 1; mask < (std::size_t{1} << n_arms); mask += 2)
  {
    const Partition p = make_partition(node, mask);
    if (p.split.arms[0].size() < 2 || p.split.arms[1].size() < 2)
      continue;
    auto outcome = best_of_partition(node, settings, p);
    if (outcome && outcome->power > threshold)
    {
      threshold = outcome->power;
      best = std::move(outcome);
    }
  }
  return best;
}

bool is_inside(const TopologyContext &c, const Vec3 &x)
{
  return !c.shape || c.shape->signed_distance(x) <= 0;
}

/// Returns whether the node could be split: not where a part would leave the grain.
bool perform(TopologyContext &c, const NodeIndex i, const TrialSplit &split)
{
  Network &n = c.network;
  const Vec3 first = n.position(i) + split.shift[0], second = n.position(i) + split.shift[1];
  if (!is_inside(c, first) || !is_inside(c, second))
    return false;
  std::vector<SegmentIndex> detached;
  for (const std::size_t k : split.arms[1])
    detached.push_back(n.connected_segments(i)[k]);
  const NodeIndex j = detach_arms(c, i, detached, NodeConstraint::free);
  move_node(c, i, first);
  move_node(c, j, second);
  if (!split.burgers.isZero(0))
  {
    const std::array<Vec3, 1> as_tried{split.junction_normal};
    const Vec3 xi = (second - first).normalized();
    n.insert(Segment{i, j, split.burgers, c.product_plane(n, xi, split.burgers, first, as_tried)});
  }
  ++c.counts.splits;
  return true;
}

std::vector<NodeIndex> candidates(const Network &n)
{
  std::vector<NodeIndex> found;
  for (const NodeIndex i : n.nodes())
    if (n.degree(i) >= 4 && n.degree(i) <= most_arms && n.constraint(i) == NodeConstraint::free)
      found.push_back(i);
  std::sort(found.begin(), found.end(), [&](const NodeIndex a, const NodeIndex b) { return n.id(a) < n.id(b); });
  return found;
}

double shortest_arm(const Network &n, const NodeIndex i)
{
  double shortest = std::numeric_limits<double>::infinity();
  for (const SegmentIndex s : n.connected_segments(i))
    shortest = std::min(shortest, n.length(s));
  return shortest;
}

/// Whether @p forces are those of the arms of node @p i as they are now.
bool are_current(const Network &n, const NodeIndex i, const NodalForces &forces, const std::vector<bool> &changed)
{
  const auto arms = n.connected_segments(i);
  return std::all_of(arms.begin(), arms.end(),
                     [&](const SegmentIndex s)
                     {
                       const NodeIndex far = n.other_end(s, i);
                       return s.value < forces.segment_ends.size() && far.value < changed.size() && !changed[far.value];
                     });
}
} // namespace

void split_nodes(TopologyContext &context, const SplittingModel &model, const ForceFunction &forces)
{
  Network &n = context.network;
  const std::vector<NodeIndex> nodes = candidates(n);
  if (nodes.empty())
    return;
  const NodalForces present = forces(n);
  std::vector<bool> changed(n.node_capacity(), false); // nodes that have been split
  for (const NodeIndex i : nodes)
  {
    if (!are_current(n, i, present, changed))
      continue; // a neighbour has been split: next step, with new forces
    const double separation = std::min(1.5 * context.settings.collision_radius, 0.5 * shortest_arm(n, i));
    const NodeNeighbourhood neighbourhood(n, i, model, present);
    const auto split = best_split(neighbourhood, {context.product_plane, separation, n.position(i)}, model.margin);
    if (split && perform(context, i, split->split))
      changed[i.value] = true;
  }
}
} // namespace ddfem
