#include "dd/microstructure/clip.h"

#include <array>
#include <cmath>
#include <vector>

namespace ddfem
{
namespace
{
bool is_inside(const GrainShape &shape, const Vec3 &x)
{
  return shape.signed_distance(x) < 0;
}

/// Where between @p t0 and @p t1 of the segment from @p p along @p d the line passes through the surface.
double passage(const GrainShape &shape, const Vec3 &p, const Vec3 &d, double t0, double t1)
{
  const bool first_inside = is_inside(shape, p + t0 * d);
  for (int i = 0; i < 60; ++i)
  {
    const double middle = 0.5 * (t0 + t1);
    (is_inside(shape, p + middle * d) == first_inside ? t0 : t1) = middle;
  }
  return first_inside ? t0 : t1; // on the inner side
}

/// The parts of a segment inside, as pairs of line coordinates from 0 to 1.
std::vector<std::array<double, 2>> inside_parts(const GrainShape &shape, const Vec3 &p, const Vec3 &d,
                                                const double resolution)
{
  const auto n = static_cast<int>(std::ceil(d.norm() / resolution)) + 1;
  std::vector<std::array<double, 2>> parts;
  bool before = is_inside(shape, p);
  double entry = 0;
  for (int k = 1; k <= n; ++k)
  {
    const double t0 = static_cast<double>(k - 1) / n, t1 = static_cast<double>(k) / n;
    const bool now = is_inside(shape, p + t1 * d);
    if (!before && now)
      entry = passage(shape, p, d, t0, t1);
    if (before && !now)
      parts.push_back({entry, passage(shape, p, d, t0, t1)});
    before = now;
  }
  if (before)
    parts.push_back({entry, 1});
  return parts;
}
} // namespace

void clip_to_grain(Network &network, const GrainShape &shape, const double resolution)
{
  const std::vector<SegmentIndex> segments(network.segments().begin(), network.segments().end());
  for (const SegmentIndex s : segments)
  {
    const Segment old = network.get(s);
    const Vec3 p = network.position(old.start), d = network.direction(s);
    const auto parts = inside_parts(shape, p, d, resolution);
    if (parts.size() == 1 && parts[0][0] == 0 && parts[0][1] == 1)
      continue;
    network.erase(s);
    const auto node_at = [&](const double t) { return network.insert(Node{p + t * d, NodeConstraint::surface}); };
    for (const auto &[entry, exit] : parts)
      if ((exit - entry) * d.norm() > 1e-9 * shape.diameter())
      {
        const NodeIndex start = entry == 0 ? old.start : node_at(entry), end = exit == 1 ? old.end : node_at(exit);
        network.insert(Segment{start, end, old.burgers, old.plane});
      }
  }
  const std::vector<NodeIndex> nodes(network.nodes().begin(), network.nodes().end());
  for (const NodeIndex i : nodes)
    if (network.degree(i) == 0)
      network.erase(i);
    else if (network.degree(i) == 1 && network.constraint(i) == NodeConstraint::free)
      network.set_constraint(i, NodeConstraint::surface); // a node that lies on the surface
}
} // namespace ddfem
