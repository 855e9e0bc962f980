#include "dd/microstructure/adopt_slip_planes.h"

#include <optional>
#include <vector>

namespace ddfem
{
namespace
{
constexpr double angle_tolerance = 1e-4; // rad

/// The slip plane with the normal of a plane without indices.
std::optional<std::size_t> matching_plane(const SlipSystems &systems, const GlidePlane &plane)
{
  if (!is_zero(plane.miller))
    return {};
  for (std::size_t k = 0; k < systems.planes().size(); ++k)
    if (systems.planes()[k].normal.cross(plane.normal).norm() <= angle_tolerance)
      return k;
  return {};
}

/// The planes of the arms of node @p i, except where it is an image of the node, across a periodic boundary, that lies
/// on the plane.
std::vector<PlaneIndex> planes_at(const Network &network, const NodeIndex i)
{
  std::vector<PlaneIndex> planes;
  for (const SegmentIndex s : network.connected_segments(i))
  {
    const Vec3 end = network.position(network.start(s)) + network.direction(s);
    const bool itself = network.start(s) == i || (end - network.position(i)).norm() <= GlidePlanes::offset_quantum;
    if (network.plane(s).is_valid() && itself)
      planes.push_back(network.plane(s));
  }
  return planes;
}
} // namespace

void adopt_slip_planes(Network &network, const SlipSystems &systems)
{
  std::vector<PlaneIndex> adopted(network.planes().size()); // invalid: not looked up yet
  for (const SegmentIndex s : network.segments())
  {
    Segment segment = network.get(s);
    if (!segment.plane.is_valid())
      continue;
    PlaneIndex &found = adopted[segment.plane.value];
    if (!found.is_valid())
    {
      const auto k = matching_plane(systems, network.planes()[segment.plane]);
      found = k ? network.planes().find_or_insert(systems.planes()[*k].miller, systems.planes()[*k].normal,
                                                  network.position(segment.start))
                : segment.plane;
    }
    segment.plane = found;
    network.set(s, segment);
  }
  for (const NodeIndex i : network.nodes())
    network.set_position(i, network.planes().project_on_intersection(planes_at(network, i), network.position(i)));
}
} // namespace ddfem
