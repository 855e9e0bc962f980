// Where nodes have been within a step.
#pragma once

#include "dd/network/network.h"
#include "dd/topology/motion_part.h"

#include <vector>

namespace ddfem
{
/// Polygons through the places at the ends of the shorter steps of some nodes; all other nodes have gone straight.
class NodePaths
{
public:
  void clear() { waypoints.clear(); }
  /// @p time: part of the step in (0, 1], not earlier than the last one of the node.
  void add(const NodeIndex i, const double time, const Vec3 &position) { waypoints.push_back({i, time, position}); }

  /// Divides the way from @p start to @p end (nm, by NodeIndex::value) into parts in time, so that no waypoint is farther than @p deviation
  /// (nm) from the straight way of its node in its part. Halves parts until this holds. @p parts: none if one
  /// part suffices. Returns false if it takes too many.
  bool divide(const std::vector<Vec3> &start, const std::vector<Vec3> &end, double deviation,
              std::vector<MotionPart> &parts) const;

private:
  struct Waypoint
  {
    NodeIndex node;
    double time;
    Vec3 position;
  };
  struct Polygon
  {
    NodeIndex node;
    std::vector<Waypoint> corners; ///< from the start of the step to its end
    Vec3 at(double time) const;
    bool is_straight(double begin, double end, double deviation) const;
  };
  std::vector<Polygon> polygons(const std::vector<Vec3> &start, const std::vector<Vec3> &end) const;

  std::vector<Waypoint> waypoints;
};
} // namespace ddfem
