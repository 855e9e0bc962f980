// What every topological operation needs to know besides the network.
#pragma once

#include "dd/forces/virtual_rays.h"
#include "dd/geometry/grain_shape.h"
#include "dd/network/network.h"
#include "dd/topology/swept_area.h"

#include <functional>
#include <vector>

namespace ddfem
{
/// Lengths that control topology, nm.
struct TopologySettings
{
  double min_segment = 10.0;     ///< L_min
  double max_segment = 30.0;     ///< L_max
  double min_area = 0.0;         ///< triangle at a node below which the node is removed, nm^2
  double collision_radius = 2.0; ///< capture distance
};

/// Number of topological events since the start of the run.
struct TopologyCounts
{
  std::size_t collisions = 0, annihilations = 0, splits = 0, refinements = 0, coarsenings = 0, surface_exits = 0;
};

/// The glide plane of a product line of direction xi (unit) and Burgers vector b through a point, or invalid if the line is
/// sessile.
using ProductPlane = std::function<PlaneIndex(Network &, const Vec3 &xi, const Vec3 &b, const Vec3 &point)>;

/// Passed by reference through one step: network, surroundings, and the books that every operation keeps.
struct TopologyContext
{
  Network &network;
  const TopologySettings &settings;
  const GrainShape *shape; ///< null without a surface
  RayDirection ray_direction;
  ProductPlane product_plane;
  SweptArea &swept;
  TopologyCounts &counts;
  /// Displacement of each node in this step, nm, by NodeIndex::value; zero once an event has stopped the node.
  std::vector<Vec3> remaining;

  /// @p displacement may be an entry of `remaining`.
  NodeIndex insert_node(const Node &node, const Vec3 &displacement)
  {
    const Vec3 kept = displacement; // `remaining` may move in memory below
    const NodeIndex i = network.insert(node);
    if (remaining.size() <= i.value)
      remaining.resize(i.value + 1, Vec3::Zero());
    remaining[i.value] = kept;
    return i;
  }
};
} // namespace ddfem
