// Groups of segments that cannot influence each other within a step.
#pragma once

#include "dd/topology/collisions/collision_events.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ddfem
{
/// Partition of the segments: candidates of each other are in one island, and so are the arms of every node that an event
/// may change. Events of different islands may be handled in any order.
class Islands
{
public:
  /// Everything is one island.
  Islands() = default;
  Islands(const Network &network, std::span<const CandidatePair> pairs, std::span<const CollisionEvent> events);

  /// Name of the island of a segment.
  std::uint32_t of(SegmentIndex s);
  /// A segment that has just been inserted is an island of its own.
  void add(SegmentIndex s);
  /// Makes two islands one and returns its name, the smaller of the two.
  std::uint32_t unite(std::uint32_t a, std::uint32_t b);

private:
  void unite_arms(const Network &network, SegmentIndex s);
  std::vector<std::uint32_t> parent; ///< union-find forest by SegmentIndex::value; empty: one island
};
} // namespace ddfem
