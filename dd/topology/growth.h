// The area that lines sweep when they grow from nothing.
#pragma once

#include "dd/forces/virtual_rays.h"
#include "dd/topology/swept_area.h"

namespace ddfem
{
/// Triangles that create the present lines of @p network in a perfect crystal: closed loops and lines from surface node to
/// surface node, each spanned by a fan from its first node. Throws std::invalid_argument naming a node if lines branch or
/// end inside the crystal.
SweptArea grown_area(const Network &network, const GrainShape *shape, RayDirection rule);
} // namespace ddfem
