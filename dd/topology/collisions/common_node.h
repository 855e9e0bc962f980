// Whether two segments are arms of one node.
#pragma once

#include "dd/network/network.h"

#include <optional>

namespace ddfem
{
/// The node that two different segments share; empty if there is none.
inline std::optional<NodeIndex> common_node(const Network &network, const SegmentIndex a, const SegmentIndex b)
{
  for (const NodeIndex i : {network.start(a), network.end(a)})
    if (i == network.start(b) || i == network.end(b))
      return i;
  return std::nullopt;
}
} // namespace ddfem
