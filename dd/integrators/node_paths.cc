#include "dd/integrators/node_paths.h"

#include "dd/elasticity/distance.h"

#include <algorithm>

namespace ddfem
{
namespace
{
constexpr std::size_t most_parts = 96;
} // namespace

Vec3 NodePaths::Polygon::at(const double time) const
{
  const auto next = std::ranges::upper_bound(corners, time, {}, &Waypoint::time);
  if (next == corners.end())
    return corners.back().position;
  const Waypoint &a = *(next - 1);
  return a.position + (time - a.time) / (next->time - a.time) * (next->position - a.position);
}

bool NodePaths::Polygon::is_straight(const double begin, const double end, const double deviation) const
{
  const Vec3 from = at(begin), to = at(end);
  return std::ranges::all_of(corners,
                             [&](const Waypoint &w)
                             {
                               return w.time <= begin || w.time >= end ||
                                      distance_point_segment(w.position, from, to).squared <= deviation * deviation;
                             });
}

std::vector<NodePaths::Polygon> NodePaths::polygons(const std::vector<Vec3> &start, const std::vector<Vec3> &end) const
{
  std::vector<Waypoint> sorted = waypoints;
  std::ranges::stable_sort(sorted, {}, [](const Waypoint &w) { return w.node.value; });
  std::vector<Polygon> result;
  for (auto w = sorted.begin(); w != sorted.end();)
  {
    Polygon p{w->node, {{w->node, 0.0, start[w->node.value]}}};
    for (; w != sorted.end() && w->node == p.node; ++w)
      if (w->time > p.corners.back().time && w->time < 1)
        p.corners.push_back(*w);
    p.corners.push_back({p.node, 1.0, end[p.node.value]});
    result.push_back(std::move(p));
  }
  return result;
}

bool NodePaths::divide(const std::vector<Vec3> &start, const std::vector<Vec3> &end, const double deviation,
                       std::vector<MotionPart> &parts) const
{
  const std::vector<Polygon> all = polygons(start, end);
  std::vector<double> times{0, 1};
  for (std::size_t k = 0; k + 1 < times.size();)
  {
    if (std::ranges::all_of(all, [&](const Polygon &p) { return p.is_straight(times[k], times[k + 1], deviation); }))
      ++k;
    else if (times.size() > most_parts)
      return false;
    else
      times.insert(times.begin() + static_cast<std::ptrdiff_t>(k) + 1, 0.5 * (times[k] + times[k + 1]));
  }
  parts.clear();
  if (times.size() == 2)
    return true;
  for (std::size_t k = 0; k + 1 < times.size(); ++k)
  {
    std::vector<Vec3> part(start.size());
    for (std::size_t i = 0; i < start.size(); ++i)
      part[i] = (times[k + 1] - times[k]) * (end[i] - start[i]);
    for (const Polygon &p : all)
      part[p.node.value] = p.at(times[k + 1]) - p.at(times[k]);
    parts.push_back({times[k + 1] - times[k], std::move(part)});
  }
  return true;
}
} // namespace ddfem
