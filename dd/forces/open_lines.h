// Lines that end inside the crystal, and how they are closed for the boundary-value problem.
#pragma once

#include "dd/forces/virtual_rays.h"

#include <vector>

namespace ddfem
{
/// A straight piece of line as the kernels see it.
struct StraightLine
{
  Vec3 start, end, burgers;
};

/// The initial position of all lines that end at pinned nodes inside the crystal (Frank-Read sources).
///
/// A line that ends inside a crystal has no field in equilibrium. What a source is attached to is not modelled, so its field
/// is split in two: the closed loop between the present and the initial position of the line, which is the slip since
/// t = 0 and whose boundary-value problem is solved exactly (tractions, displacements, reactions), and the initial line, whose
/// field acts on the other segments as in an unbounded body, in every mode alike.
struct OpenLines
{
  std::vector<StraightLine> lines;
  std::vector<VirtualRay> rays;
};

/// Collects the connected components of @p network that hold a pinned node at which Burgers vectors do not balance.
/// @p shape may be null (no rays).
OpenLines open_lines(const Network &network, const GrainShape *shape, RayDirection rule);
} // namespace ddfem
