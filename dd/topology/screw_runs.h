// Straight pieces of screw line, found and made exactly straight.
#pragma once

#include "dd/topology/topology_context.h"

#include <optional>
#include <vector>

namespace ddfem
{
/// Segments in a row with one Burgers vector and glide plane, all nearly of screw character.
struct ScrewRun
{
  std::vector<NodeIndex> nodes;       ///< in order along the line
  std::vector<SegmentIndex> segments; ///< segments[k] joins nodes[k] and nodes[k + 1]
  /// How far each node is moved, in the glide plane and across b, to where the run is a straight line along b, nm.
  std::vector<Vec3> shift;
  Vec3 burgers = Vec3::Zero(); ///< nm, for the line sense from the first node to the last
  double length = 0;           ///< along b, nm
  ObjectId id = 0;             ///< smallest of its segments

  /// Whether the line runs along its Burgers vector rather than against it.
  bool is_right_handed(const Network &network) const
  {
    const Vec3 t = network.minimum_image(network.position(nodes[1]) - network.position(nodes[0]));
    return t.dot(burgers) > 0;
  }
  Vec3 middle_of(const Network &network, const std::size_t k) const
  {
    return network.position(network.start(segments[k])) + 0.5 * network.direction(segments[k]);
  }
};

/// All runs of segments with a glide plane that are within the angle of cosine @p cosine of their Burgers vectors, in the order of their ids.
/// They end at nodes that are not discretisation nodes and where the character changes. Nodes that cannot be moved (physical,
/// pinned or surface nodes) hold the line on which the run is put; where two such ends are not on one line along b, or a node would
/// move by more than a collision radius, segments are left out at an end. What remains is at least 2 L_min long.
std::vector<ScrewRun> screw_runs(const TopologyContext &context, double cosine);

/// @p run put on the line along b through @p point (nm) instead, which is near its glide plane; without its end segments where nodes
/// that cannot be moved hold it elsewhere. Empty if nothing is left or a node would move by more than @p largest_shift.
std::optional<ScrewRun> moved_onto_line(const Network &network, const ScrewRun &run, const Vec3 &point,
                                        double largest_shift);
} // namespace ddfem
