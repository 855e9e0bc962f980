#include "dd/topology/collisions/moving_lines.h"

#include "dd/topology/collisions/continuous_collisions.h"
#include "dd/topology/collisions/proximity_collisions.h"
#include "dd/topology/motion.h"

#include <utility>
#include <vector>

namespace ddfem
{
namespace
{
/// By which nodes are recognised whose arms have changed.
std::vector<std::vector<ObjectId>> arms_of_nodes(const Network &network)
{
  std::vector<std::vector<ObjectId>> arms(network.node_capacity());
  for (const NodeIndex i : network.nodes())
    for (const SegmentIndex s : network.connected_segments(i))
      arms[i.value].push_back(network.id(s));
  return arms;
}
} // namespace

void move_lines(TopologyContext &context, CandidateList &candidates)
{
  if (context.settings.collisions == CollisionAlgorithm::continuous)
  {
    bend_displacements_along_surface(context);
    collide_continuously(context, candidates);
    move_nodes(context, 1);
    return;
  }
  const unsigned parts = motion_substeps(context);
  for (unsigned k = 0; k < parts; ++k)
  {
    collide(context);
    move_nodes(context, 1.0 / parts);
  }
}

void move_lines(TopologyContext &context, CandidateList &candidates, const std::span<const MotionPart> parts)
{
  if (parts.empty())
  {
    move_lines(context, candidates);
    return;
  }
  const std::vector<std::vector<ObjectId>> before = arms_of_nodes(context.network);
  for (std::size_t k = 0; k < parts.size(); ++k)
  {
    std::vector<Vec3> displacement = parts[k].displacement;
    if (k > 0)
    {
      const std::vector<std::vector<ObjectId>> now = arms_of_nodes(context.network);
      displacement.resize(now.size(), Vec3::Zero());
      for (const NodeIndex i : context.network.nodes())
        if (i.value >= before.size() || now[i.value] != before[i.value])
          displacement[i.value] = parts[k].duration / parts[k - 1].duration * context.velocity(i);
    }
    context.remaining = std::move(displacement);
    context.recorded_at.clear();
    move_lines(context, candidates);
  }
}
} // namespace ddfem
