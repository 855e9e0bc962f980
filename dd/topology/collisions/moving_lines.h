// The motion of a step with the collisions on its way.
#pragma once

#include "dd/topology/collisions/candidate_list.h"
#include "dd/topology/topology_context.h"

namespace ddfem
{
/// Moves all nodes by their remaining displacements; lines that meet on the way are merged by the algorithm that the
/// settings name. @p candidates live from step to step.
void move_lines(TopologyContext &context, CandidateList &candidates);
} // namespace ddfem
