// Collisions by proximity: the reference algorithm, safe as long as lines move less than the capture radius at a time.
#pragma once

#include "dd/topology/topology_context.h"

namespace ddfem
{
/// Number of equal parts into which the remaining displacements must be divided so that no two lines approach each other
/// by more than the collision radius between two calls of collide(): a pair cannot pass through each other unseen. One where no
/// two lines are near enough to meet at all.
unsigned motion_substeps(const TopologyContext &context);

/// Merges every pair of lines that is closer than the collision radius and approaching, in the order of the segments'
/// persistent ids. The merged node lies on the glide planes of all its arms; where these leave no such point within
/// the collision radius the pair is left alone. Opposite Burgers vectors annihilate.
void collide(TopologyContext &context);
} // namespace ddfem
