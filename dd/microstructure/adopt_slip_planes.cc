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

/// The planes of the arms of node @p i, moved by the period of the network to where the node is.
std::vector<PlaneIndex> planes_at(Network &network, const NodeIndex i)
{
  std::vector<PlaneIndex> planes;
  for (const SegmentIndex s : network.connected_segments(i))
  {
    const PlaneIndex p = network.plane(s);
    if (!p.is_valid())
      continue;
    const Vec3 image =
        network.start(s) == i ? network.position(i) : Vec3(network.position(network.start(s)) + network.direction(s));
    const Vec3 shift = network.position(i) - image;
    const bool same_image = shift.norm() <= GlidePlanes::offset_quantum;
    planes.push_back(
        same_image ? p : network.planes().find_or_insert_parallel(p, Vec3(network.planes().project(p, image) + shift)));
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
