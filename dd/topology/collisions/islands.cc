#include "dd/topology/collisions/islands.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace ddfem
{
Islands::Islands(const Network &network, const std::span<const CandidatePair> pairs,
                 const std::span<const CollisionEvent> events)
    : parent(network.segment_capacity())
{
  std::iota(parent.begin(), parent.end(), 0U);
  std::vector<std::uint8_t> done(parent.size(), 0);
  const auto add_pair = [&](const SegmentIndex a, const SegmentIndex b)
  {
    unite(of(a), of(b));
    for (const SegmentIndex s : {a, b})
      if (!std::exchange(done[s.value], std::uint8_t{1}))
        unite_arms(network, s);
  };
  for (const CandidatePair &pair : pairs)
    add_pair(pair.first, pair.second);
  for (const CollisionEvent &event : events)
    add_pair(event.first, event.second);
}

void Islands::unite_arms(const Network &network, const SegmentIndex s)
{
  for (const NodeIndex i : {network.start(s), network.end(s)})
    for (const SegmentIndex arm : network.connected_segments(i))
      unite(of(s), of(arm));
}

std::uint32_t Islands::of(const SegmentIndex s)
{
  if (parent.empty())
    return 0;
  std::uint32_t root = s.value;
  while (parent[root] != root)
    root = parent[root];
  for (std::uint32_t k = s.value; parent[k] != root;) // shorten the path
    k = std::exchange(parent[k], root);
  return root;
}

void Islands::add(const SegmentIndex s)
{
  if (parent.empty())
    return;
  for (auto k = static_cast<std::uint32_t>(parent.size()); k <= s.value; ++k)
    parent.push_back(k);
}

std::uint32_t Islands::unite(const std::uint32_t a, const std::uint32_t b)
{
  const std::uint32_t root = std::min(a, b);
  if (!parent.empty())
    parent[std::max(a, b)] = root;
  return root;
}
} // namespace ddfem
