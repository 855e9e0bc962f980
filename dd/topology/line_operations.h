// Elementary operations on lines from which collisions, remeshing and splitting are built. Each books the area it sweeps.
#pragma once

#include "dd/topology/topology_context.h"

#include <span>

namespace ddfem
{
/// Cuts segment @p s at @p x (on its line up to rounding) and returns the new node. Sweeps nothing.
NodeIndex split_segment(TopologyContext &context, SegmentIndex s, const Vec3 &x, const Vec3 &displacement);

/// Moves node @p i to @p x at once, together with its arms and, for a surface node, its ray.
void move_node(TopologyContext &context, NodeIndex i, const Vec3 &x);

/// Merges @p gone into @p kept; both must be at the same place (move_node() first). Arms that join the same two nodes
/// afterwards are added up; if their Burgers vectors cancel both vanish. Nodes left without arms are erased.
void merge_nodes(TopologyContext &context, NodeIndex kept, NodeIndex gone);

/// Detaches the arms @p arms from node @p i and hangs them on a new node at the same place, which is returned.
NodeIndex detach_arms(TopologyContext &context, NodeIndex i, std::span<const SegmentIndex> arms,
                      NodeConstraint constraint);

/// Removes node @p i of degree two with equal Burgers vector and plane on both sides and joins its neighbours; if these are
/// joined already, the two lines are added up.
void remove_node(TopologyContext &context, NodeIndex i);

/// True if the two arms of node @p i are one line: degree two, free, same Burgers vector and plane.
bool is_discretisation_node(const Network &network, NodeIndex i);

/// Erases node @p i if it has no arms left and is not pinned.
void erase_if_orphan(Network &network, NodeIndex i);
} // namespace ddfem
