#include "dd/topology/node_splitting.h"

#include "dd/topology/line_operations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

namespace ddfem
{
namespace
{
/// One of the two nodes that a split would make.
struct Part
{
  std::vector<SegmentIndex> arms;
  Vec3 force = Vec3::Zero();   ///< MPa nm^2
  Vec3 burgers = Vec3::Zero(); ///< sum of the arms' Burgers vectors, leaving the node
  double drag = 0;             ///< MPa ns nm
  Mat3 projector = Mat3::Identity();
  double shortest = 0;         ///< shortest arm, nm
  Vec3 arm_sum = Vec3::Zero(); ///< sum of the arms' unit vectors

  Vec3 velocity(const Vec3 &extra_force) const { return projector * (force + extra_force) / drag; }
};

Part make_part(const Network &n, const NodeIndex i, std::vector<SegmentIndex> arms, const NodalForces &forces,
               const LinearGlide &law)
{
  Part part;
  part.shortest = std::numeric_limits<double>::infinity();
  for (const SegmentIndex s : arms)
  {
    const SegmentForces &f = forces.segment_ends[s.value];
    part.force += n.start(s) == i ? f.start : f.end;
    part.burgers += n.burgers_from(s, i);
    const Vec3 t = n.direction(s);
    const double length = t.norm();
    part.shortest = std::min(part.shortest, length);
    part.arm_sum += (n.start(s) == i ? 1.0 : -1.0) / length * t;
  }
  part.drag = drag_of_arms(n, arms, law);
  part.projector = glide_projector(n, arms);
  part.arms = std::move(arms);
  return part;
}

struct Split
{
  Part first, second;
  Vec3 direction; ///< unit, from second to first
  double power = 0;
};

/// Line tension of a junction with Burgers vector b whose length is of the order of @p scale, MPa nm^2.
double junction_tension(const SplittingModel &model, const Vec3 &b, const double scale)
{
  return model.medium.mu * b.squaredNorm() / (4 * std::numbers::pi) *
         std::max(1.0, std::log(scale / model.core_cutoff_radius));
}

/// Whether all arms of node @p i share one glide plane.
bool is_planar(const Network &n, const NodeIndex i)
{
  const auto arms = n.connected_segments(i);
  return std::all_of(arms.begin(), arms.end(),
                     [&](const SegmentIndex s) { return n.normal(s).cross(n.normal(arms[0])).norm() < 1e-6; });
}

/// @p planar: lines of one plane cannot pass each other, so that each part must move towards its own arms.
std::optional<Split> evaluate(const SplittingModel &model, Part first, Part second, const double separation,
                              const bool planar)
{
  const Vec3 apart = first.velocity(Vec3::Zero()) - second.velocity(Vec3::Zero());
  if (apart.norm() == 0)
    return std::nullopt;
  const Vec3 direction = apart.normalized();
  if (planar && (first.arm_sum - second.arm_sum).dot(direction) <= 0)
    return std::nullopt;
  Vec3 pull = Vec3::Zero();
  if (first.burgers.norm() > 1e-9)
    pull = -junction_tension(model, first.burgers, separation) * direction;
  const Vec3 v1 = first.velocity(pull), v2 = second.velocity(-pull);
  if ((v1 - v2).dot(direction) <= 0)
    return std::nullopt;
  Split split{std::move(first), std::move(second), direction, 0};
  split.power = (split.first.force + pull).dot(v1) + (split.second.force - pull).dot(v2);
  return split;
}

std::optional<Split> best_split(const Network &n, const NodeIndex i, const SplittingModel &model,
                                const NodalForces &forces, const double separation)
{
  const auto arms = n.connected_segments(i);
  const std::size_t m = arms.size();
  const Part whole = make_part(n, i, {arms.begin(), arms.end()}, forces, model.mobility);
  const bool planar = is_planar(n, i);
  const double at_least = 1.001 * whole.force.dot(whole.velocity(Vec3::Zero()));
  std::optional<Split> best;
  // Every partition once: the first arm always belongs to the first part.
  for (std::size_t mask = 1; mask < (std::size_t{1} << m); mask += 2)
  {
    std::vector<SegmentIndex> a, b;
    for (std::size_t k = 0; k < m; ++k)
      ((mask >> k & 1U) ? a : b).push_back(arms[k]);
    if (a.size() < 2 || b.size() < 2)
      continue;
    auto split = evaluate(model, make_part(n, i, std::move(a), forces, model.mobility),
                          make_part(n, i, std::move(b), forces, model.mobility), separation, planar);
    if (split && split->power > std::max(at_least, best ? best->power : 0.0))
      best = std::move(split);
  }
  return best;
}

bool is_inside(const TopologyContext &c, const Vec3 &x)
{
  return !c.shape || c.shape->signed_distance(x) <= 0;
}

void perform(TopologyContext &c, const NodeIndex i, const Split &split, const double separation)
{
  Network &n = c.network;
  const Vec3 b = split.first.burgers;
  const double half = 0.5 * std::min({separation, split.first.shortest, split.second.shortest});
  const Vec3 first = n.position(i) + half * (split.first.projector * split.direction);
  const Vec3 second = n.position(i) - half * (split.second.projector * split.direction);
  if (!is_inside(c, first) || !is_inside(c, second) || (first - second).norm() < 0.1 * half)
    return;
  const NodeIndex j = detach_arms(c, i, split.second.arms, NodeConstraint::free);
  move_node(c, i, first);
  move_node(c, j, second);
  // Balance at node i: the arms leave with b, so the junction, leaving i towards j, carries -b.
  if (b.norm() > 1e-9)
    n.insert(Segment{i, j, -b, c.product_plane(n, (second - first).normalized(), b, first)});
  ++c.counts.splits;
}
} // namespace

void split_nodes(TopologyContext &context, const SplittingModel &model, const ForceFunction &forces)
{
  Network &n = context.network;
  std::vector<NodeIndex> candidates;
  for (const NodeIndex i : n.nodes())
    if (n.degree(i) >= 4 && n.degree(i) <= 8 && n.constraint(i) == NodeConstraint::free)
      candidates.push_back(i);
  if (candidates.empty())
    return;
  std::sort(candidates.begin(), candidates.end(),
            [&](const NodeIndex a, const NodeIndex b) { return n.id(a) < n.id(b); });
  const double separation = 1.5 * context.settings.collision_radius;
  for (const NodeIndex i : candidates)
    if (const auto split = best_split(n, i, model, forces(n), separation))
      perform(context, i, *split, separation);
}
} // namespace ddfem
