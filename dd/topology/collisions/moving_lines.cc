#include "dd/topology/collisions/moving_lines.h"

#include "dd/topology/collisions/continuous_collisions.h"
#include "dd/topology/collisions/proximity_collisions.h"
#include "dd/topology/motion.h"

namespace ddfem
{
void move_lines(TopologyContext &context, CandidateList &candidates)
{
  if (context.settings.collisions == CollisionAlgorithm::continuous)
  {
    bend_displacements_along_surface(context);
    collide_continuously(context, candidates);
    move_nodes(context, 1);
    return;
  }
  const unsigned parts = motion_substeps(context);
  for (unsigned k = 0; k < parts; ++k)
  {
    collide(context);
    move_nodes(context, 1.0 / parts);
  }
}
} // namespace ddfem
