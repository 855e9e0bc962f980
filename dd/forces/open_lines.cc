#include "dd/forces/open_lines.h"

namespace ddfem
{
namespace
{
bool is_open_end(const Network &network, const NodeIndex i)
{
  return network.constraint(i) == NodeConstraint::pinned && ray_burgers(network, i).norm() > 1e-9;
}

/// Marks all nodes connected with open ends.
std::vector<bool> nodes_of_open_lines(const Network &network)
{
  std::vector<bool> marked(network.node_capacity(), false);
  std::vector<NodeIndex> stack;
  const auto visit = [&](const NodeIndex i)
  {
    if (!marked[i.value])
      stack.push_back(i);
    marked[i.value] = true;
  };
  for (const NodeIndex i : network.nodes())
    if (is_open_end(network, i))
      visit(i);
  while (!stack.empty())
  {
    const NodeIndex i = stack.back();
    stack.pop_back();
    for (const SegmentIndex s : network.connected_segments(i))
      visit(network.other_end(s, i));
  }
  return marked;
}
} // namespace

OpenLines open_lines(const Network &network, const GrainShape *shape, const RayDirection rule)
{
  const std::vector<bool> marked = nodes_of_open_lines(network);
  OpenLines open;
  for (const SegmentIndex s : network.segments())
    if (marked[network.start(s).value])
    {
      const Vec3 &x = network.position(network.start(s));
      open.lines.push_back({x, x + network.direction(s), network.burgers(s)});
    }
  if (shape)
    for (const NodeIndex i : network.nodes())
      if (marked[i.value] && network.constraint(i) == NodeConstraint::surface)
        open.rays.push_back(
            {network.position(i), ray_direction(*shape, rule, network.position(i)), ray_burgers(network, i)});
  return open;
}
} // namespace ddfem
