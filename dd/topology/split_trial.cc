#include "dd/topology/split_trial.h"

#include "dd/elasticity/distance.h"
#include "dd/elasticity/self_force.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace ddfem
{
namespace
{
/// Half of what a uniform stress exerts on a segment: the force on each of its ends, MPa nm^2.
Vec3 half_of_peach_koehler(const SymTensor &stress, const Vec3 &burgers, const Vec3 &t)
{
  return 0.5 * contract(stress, burgers).cross(t);
}
} // namespace

NodeNeighbourhood::NodeNeighbourhood(const Network &network, const NodeIndex node, const SplittingModel &trial_model,
                                     const NodalForces &forces)
    : model(trial_model)
{
  const auto segments = network.connected_segments(node);
  std::vector<SegmentIndex> known(segments.begin(), segments.end());
  for (const SegmentIndex s : segments)
  {
    const NodeIndex far = network.other_end(s, node);
    const Vec3 far_end = (network.start(s) == node ? 1.0 : -1.0) * network.direction(s);
    node_arms.push_back({far_end, network.burgers_from(s, node), network.normal(s),
                         model.mobility->constraint(line_state(network, s))});
    for (const SegmentIndex next : network.connected_segments(far))
      if (std::find(known.begin(), known.end(), next) == known.end())
      {
        known.push_back(next);
        const Vec3 along = (network.start(next) == far ? 1.0 : -1.0) * network.direction(next);
        surroundings.push_back({far_end, far_end + along, network.burgers_from(next, far), network.normal(next)});
      }
  }
  std::vector<Line> lines;
  for (const Arm &a : node_arms)
    lines.push_back({Vec3::Zero(), a.far_end, a.burgers, a.normal});
  for (std::size_t k = 0; k < node_arms.size(); ++k)
  {
    const SegmentForces &total = forces.segment_ends[segments[k].value];
    node_arms[k].force = network.start(segments[k]) == node ? total.start : total.end;
    node_arms[k].background = node_arms[k].force - near_force(lines, k).start;
  }
  std::vector<std::size_t> all(node_arms.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  unsplit = merged(all);
}

Mat3 NodeNeighbourhood::directions() const
{
  std::vector<ArmConstraint> constraints;
  for (const Arm &a : node_arms)
    constraints.push_back(a.constraint);
  return free_directions(constraints);
}

Mat3 NodeNeighbourhood::directions(std::span<const std::size_t> which) const
{
  std::vector<ArmConstraint> constraints;
  for (const std::size_t k : which)
    constraints.push_back(node_arms[k].constraint);
  return free_directions(constraints);
}

Mat3 NodeNeighbourhood::directions(const TrialSplit &split, const std::size_t side) const
{
  std::vector<ArmConstraint> constraints;
  for (const std::size_t k : split.arms[side])
    constraints.push_back(node_arms[k].constraint);
  if (!split.burgers.isZero(0))
    constraints.push_back(model.mobility->constraint(
        {(split.shift[1] - split.shift[0]).normalized(), split.burgers, split.junction_normal}));
  return free_directions(constraints);
}

SegmentForces NodeNeighbourhood::near_force(const std::vector<Line> &lines, const std::size_t number) const
{
  const Line &line = lines[number];
  const Vec3 stress = half_of_peach_koehler(model.applied, line.burgers, line.end - line.start);
  SegmentForces sum{stress, stress};
  const auto add = [&](const SegmentForces &f)
  {
    sum.start += f.start;
    sum.end += f.end;
  };
  add(self_force(model.medium, line.start, line.end, line.burgers));
  add(core_force(model.medium, CoreEnergy{model.core_cutoff_radius}, line.start, line.end, line.burgers));
  const auto add_pair = [&](const Line &source)
  {
    add(segment_force(model.medium, source.start, source.end, source.burgers, line.start, line.end, line.burgers,
                      model.pair_tolerance));
  };
  for (std::size_t k = 0; k < lines.size(); ++k)
    if (k != number)
      add_pair(lines[k]);
  for (const Line &source : surroundings)
    add_pair(source);
  return sum;
}

NodeMotion NodeNeighbourhood::merged(std::span<const std::size_t> which) const
{
  NodeMotion part;
  std::vector<NodalArm> part_arms;
  for (const std::size_t k : which)
  {
    const Arm &a = node_arms[k];
    part.force += a.force;
    part_arms.push_back(Line{Vec3::Zero(), a.far_end, a.burgers, a.normal}.as_arm());
  }
  part.velocity = local_velocity(*model.mobility, part_arms, directions(which), part.force);
  return part;
}

std::array<NodeMotion, 2> NodeNeighbourhood::motion(const TrialSplit &split) const
{
  std::vector<Line> lines(node_arms.size());
  for (std::size_t side = 0; side < 2; ++side)
    for (const std::size_t k : split.arms[side])
      lines[k] = {split.shift[side], node_arms[k].far_end, node_arms[k].burgers, node_arms[k].normal};
  SegmentForces junction;
  std::vector<NodalArm> junction_arm;
  if (!split.burgers.isZero(0))
  {
    lines.push_back({split.shift[0], split.shift[1], split.burgers, split.junction_normal});
    junction = near_force(lines, lines.size() - 1);
    junction_arm.push_back(lines.back().as_arm());
  }
  std::array<NodeMotion, 2> parts;
  for (std::size_t side = 0; side < 2; ++side)
  {
    NodeMotion &part = parts[side];
    std::vector<NodalArm> part_arms = junction_arm;
    part.force = side == 0 ? junction.start : junction.end;
    for (const std::size_t k : split.arms[side])
    {
      part.force += node_arms[k].background + near_force(lines, k).start;
      part_arms.push_back(lines[k].as_arm());
    }
    part.velocity = local_velocity(*model.mobility, part_arms, directions(split, side), part.force);
  }
  return parts;
}

double NodeNeighbourhood::clearance(const TrialSplit &split) const
{
  double squared = std::numeric_limits<double>::infinity();
  for (const std::size_t k : split.arms[0])
    for (const std::size_t m : split.arms[1])
      squared = std::min(
          squared,
          distance_segment_segment(split.shift[0], node_arms[k].far_end, split.shift[1], node_arms[m].far_end).squared);
  return std::sqrt(squared);
}
} // namespace ddfem
