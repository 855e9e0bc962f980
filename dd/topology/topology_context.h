// What every topological operation needs to know besides the network.
#pragma once

#include "dd/forces/virtual_rays.h"
#include "dd/geometry/grain_shape.h"
#include "dd/network/network.h"
#include "dd/topology/swept_area.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace ddfem
{
/// How lines that meet are found and merged.
enum class CollisionAlgorithm : std::uint8_t
{
  continuous, ///< over the whole step, in the order of time
  proximity,  ///< by distance, in sub-steps: the reference
};

/// Lengths that control topology, nm.
struct TopologySettings
{
  double min_segment = 10.0;     ///< L_min
  double max_segment = 30.0;     ///< L_max
  double min_area = 0.0;         ///< triangle at a node below which the node is removed, nm^2
  double collision_radius = 2.0; ///< capture distance
  /// Triangle at a node above which the line is sharply bent there, nm^2.
  double max_area = std::numeric_limits<double>::infinity();
  CollisionAlgorithm collisions = CollisionAlgorithm::continuous;
};

/// Number of topological events since the start of the run.
struct TopologyCounts
{
  std::size_t collisions = 0, annihilations = 0, splits = 0, refinements = 0, coarsenings = 0, surface_exits = 0,
              cross_slips = 0;
};

/// The glide plane of a product line of direction xi (unit) and Burgers vector b through a point, or invalid if the line is
/// sessile. @p parents: unit normals of the planes of the lines that reacted (zero for sessile ones), which a screw keeps.
using ProductPlane = std::function<PlaneIndex(Network &, const Vec3 &xi, const Vec3 &b, const Vec3 &point,
                                              std::span<const Vec3> parents)>;

/// What a segment remembers of the start of the step while collisions are handled.
struct SegmentOrigin
{
  ObjectId lineage; ///< persistent id of the segment of the start of the step that it is a piece of
  Vec3 start_displacement, end_displacement; ///< that the ends of this piece had at the start of the step, nm
};

/// Passed by reference through one step: network, surroundings, and the books that every operation keeps.
///
/// Motion within the step. Time t runs from 0 to 1. The position stored in the network is that of the node at its own time
/// `recorded_at` (0 until an event places it elsewhere), and from there it moves straight by `remaining` until t = 1.
struct TopologyContext
{
  Network &network;
  const TopologySettings &settings;
  const GrainShape *shape; ///< null without a surface
  RayDirection ray_direction;
  ProductPlane product_plane;
  SweptArea &swept;
  TopologyCounts &counts;
  /// Displacement of each node in the rest of the step, nm, by NodeIndex::value.
  std::vector<Vec3> remaining;
  /// Time within the step to which the stored position belongs, by NodeIndex::value; zero where the array ends.
  std::vector<double> recorded_at{};
  /// Origins of the segments with SegmentIndex::value >= first_new_segment, in that order; kept from begin_tracking() on.
  std::vector<SegmentOrigin> new_segment_origins{};
  std::vector<Vec3> initial_displacement{}; ///< copy of `remaining` at begin_tracking()
  std::size_t first_new_segment = 0;

  /// Starts to keep the origins of segments.
  void begin_tracking();
  void end_tracking();
  bool is_tracking() const { return !initial_displacement.empty(); }
  /// Meaningful only while tracking.
  SegmentOrigin origin(SegmentIndex s) const;
  SegmentIndex insert_segment(const Segment &segment, const SegmentOrigin &origin);

  /// @p displacement is taken by value: it may be an entry of `remaining`, which grows here.
  NodeIndex insert_node(const Node &node, Vec3 displacement);

  double time_of(NodeIndex i) const { return i.value < recorded_at.size() ? recorded_at[i.value] : 0.0; }
  void set_time(NodeIndex i, double t);
  /// Displacement per step at which the node moves now, nm.
  Vec3 velocity(NodeIndex i) const;
  /// Position at time @p t >= time_of(i), nm.
  Vec3 position_at(NodeIndex i, double t) const { return network.position(i) + (t - time_of(i)) * velocity(i); }
};
} // namespace ddfem
