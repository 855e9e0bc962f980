#include "dd/topology/growth.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace ddfem
{
namespace
{
/// Nodes of the line through @p first, from surface node to surface node or around the loop.
std::vector<NodeIndex> follow(const Network &network, const NodeIndex first)
{
  std::vector<NodeIndex> chain{first};
  SegmentIndex s = network.connected_segments(first)[0];
  while (true)
  {
    const NodeIndex next = network.other_end(s, chain.back());
    if (next == first)
      return chain;
    chain.push_back(next);
    const auto arms = network.connected_segments(next);
    if (arms.size() == 1)
      return chain;
    s = arms[0] == s ? arms[1] : arms[0];
  }
}

void require_simple_line(const Network &network, const NodeIndex i)
{
  const std::size_t degree = network.degree(i);
  const bool surface = network.constraint(i) == NodeConstraint::surface;
  if ((surface && degree == 1) || (!surface && degree == 2))
    return;
  std::ostringstream message;
  message << "the line at node " << network.id(i) << " at (" << network.position(i).transpose()
          << ") nm is neither a closed loop nor does it end at the surface: it cannot have grown in a perfect crystal";
  throw std::invalid_argument(message.str());
}
} // namespace

SweptArea grown_area(const Network &network, const GrainShape *shape, const RayDirection rule)
{
  for (const NodeIndex i : network.nodes())
    require_simple_line(network, i);
  SweptArea area;
  std::vector<bool> done(network.node_capacity(), false);
  const auto add_line_from = [&](const NodeIndex first)
  {
    const auto chain = follow(network, first);
    const auto s = network.connected_segments(first)[0];
    const Vec3 b = network.burgers_from(s, first);
    const PlaneIndex p = network.plane(s);
    for (const NodeIndex i : chain)
      done[i.value] = true;
    const Vec3 &x0 = network.position(first);
    for (std::size_t k = 1; k + 1 < chain.size(); ++k)
      area.add_triangle(x0, network.position(chain[k]), network.position(chain[k + 1]), b, p);
    if (network.constraint(first) == NodeConstraint::surface && shape)
    {
      const Vec3 &x1 = network.position(chain.back());
      // The fan is closed by the chord x1 -> x0; what remains is x0 -> x1 -> infinity -> x0.
      area.add_opening(x1, ray_direction(*shape, rule, x1), x0, ray_direction(*shape, rule, x0), b, p);
    }
  };
  for (const NodeIndex i : network.nodes()) // open lines first: they must be followed from an end
    if (!done[i.value] && network.degree(i) == 1)
      add_line_from(i);
  for (const NodeIndex i : network.nodes())
    if (!done[i.value])
      add_line_from(i);
  return area;
}
} // namespace ddfem
