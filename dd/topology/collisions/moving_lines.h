// The motion of a step with the collisions on its way.
#pragma once

#include "dd/topology/collisions/candidate_list.h"
#include "dd/topology/motion_part.h"
#include "dd/topology/topology_context.h"

#include <span>

namespace ddfem
{
/// Moves all nodes by their remaining displacements; lines that meet on the way are merged by the algorithm that the
/// settings name. @p candidates live from step to step.
void move_lines(TopologyContext &context, CandidateList &candidates);

/// The same for a motion in parts, one after the other; with none, that of the context. Nodes whose lines have merged in a part go on at the speed that this gave them.
void move_lines(TopologyContext &context, CandidateList &candidates, std::span<const MotionPart> parts);
} // namespace ddfem
