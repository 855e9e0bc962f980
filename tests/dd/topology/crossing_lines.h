// Pinned straight lines that cross at the origin, and what has become of them after they have reacted.
#pragma once

#include "dd/crystal/material.h"
#include "dd/crystal/product_plane.h"
#include "dd/microstructure/sources.h"
#include "dislocation_driver.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace ddfem
{
/// Coarse: segments of 6 to 16 nm, capture within 1 nm, no core energy beyond that of the non-singular theory.
inline DriverSettings coarse_settings(const Material &m)
{
  const double b = m.burgers_magnitude;
  return {{m.mu, m.nu, b}, b, {m.drag, m.drag}, {6, 16, 0.1, 1}, {0.1, 2, 0.2, 1e-4, 30}};
}

inline SlipSystems slip_systems_of(const Material &m)
{
  const UnitCell cell = m.c_over_a ? UnitCell::hexagonal(*m.c_over_a) : UnitCell();
  return {m.lattice, m.lattice_parameter, Orientation(cell)};
}

/// A pinned straight line whose middle lies in its plane near the origin.
struct CrossingLine
{
  SlipSystem system;                 ///< its plane
  Vec3 burgers = Vec3::Zero();       ///< nm: that of the system or its negative
  Vec3 direction = Vec3::Zero();     ///< unit, in the plane; the line sense
  double gap = 0;                    ///< of the middle from the origin, along n x direction, nm
  std::array<ObjectId, 2> ends = {}; ///< persistent ids of its first and last node
};

/// The line of @p system with its Burgers vector times @p sign, at @p degrees from @p e towards n x e; e is a unit vector in
/// its plane.
inline CrossingLine line_at(const SlipSystem &system, const double sign, const Vec3 &e, const double degrees,
                            const double gap = 0)
{
  const double phi = degrees * std::numbers::pi / 180;
  return {system, sign * system.burgers, std::cos(phi) * e + std::sin(phi) * system.normal.cross(e), gap, {}};
}

/// The system with this plane and this direction of b (three indices, on the axes of UnitCell).
inline const SlipSystem &system_of(const SlipSystems &systems, const Miller &plane, const Miller &direction)
{
  for (const SlipSystem &s : systems)
    if (without_sense(s.plane_miller) == without_sense(plane) && without_sense(s.direction) == without_sense(direction))
      return s;
  throw std::invalid_argument("no such slip system");
}

class CrossingLines : public DislocationDriver
{
public:
  CrossingLines(const Material &material, const SlipSystems &slip_systems, const double line_length,
                std::vector<CrossingLine> crossing)
      : DislocationDriver(coarse_settings(material), slip_systems), systems(slip_systems), length(line_length),
        lines(std::move(crossing))
  {
    constexpr int parts = 10;
    for (CrossingLine &l : lines)
    {
      const PlaneIndex p = network.planes().find_or_insert(l.system.plane_miller, l.system.normal, Vec3(Vec3::Zero()));
      const Vec3 middle = l.gap * l.system.normal.cross(l.direction);
      std::vector<Vec3> points;
      for (int m = 0; m <= parts; ++m)
        points.push_back(network.planes().project(p, middle + (double(m) / parts - 0.5) * length * l.direction));
      const auto nodes = add_line(network, points, l.burgers, p, false, NodeConstraint::pinned);
      l.ends = {network.id(nodes.front()), network.id(nodes.back())};
    }
  }

  /// Until no node is faster than 1 nm/ns, @p duration ns at most.
  void relax_to_rest(const double duration = 0.5) { relax(duration, 1); }

  /// Whether segment @p s carries @p b, in either sense.
  bool carries(const SegmentIndex s, const Vec3 &b) const
  {
    const Vec3 &q = network.burgers(s);
    return (q - b).norm() < 1e-6 || (q + b).norm() < 1e-6;
  }

  std::vector<SegmentIndex> segments_with(const Vec3 &b) const
  {
    std::vector<SegmentIndex> found;
    for (const SegmentIndex s : network.segments())
      if (carries(s, b))
        found.push_back(s);
    return found;
  }

  /// Length of all lines with this Burgers vector, nm.
  double length_with(const Vec3 &b) const
  {
    double sum = 0;
    for (const SegmentIndex s : segments_with(b))
      sum += network.length(s);
    return sum;
  }

  std::size_t nodes_with_degree(const std::size_t degree) const
  {
    std::size_t n = 0;
    for (const NodeIndex i : network.nodes())
      n += network.degree(i) == degree ? 1 : 0;
    return n;
  }

  /// Persistent id of the node where the line without branches ends that starts at pinned node @p id.
  ObjectId other_end_of_line(const ObjectId id) const
  {
    NodeIndex k = *network.find_node(id);
    SegmentIndex s = network.connected_segments(k)[0];
    k = network.other_end(s, k);
    while (network.degree(k) == 2 && network.constraint(k) != NodeConstraint::pinned)
    {
      const auto arms = network.connected_segments(k);
      s = arms[0] == s ? arms[1] : arms[0];
      k = network.other_end(s, k);
    }
    return network.id(k);
  }

  const SlipSystems &systems;
  double length; ///< of each line, nm
  std::vector<CrossingLine> lines;
};

/// Two lines on different planes, at angles from the line that the planes have in common; b2 such that b1 + b2 is
/// the sum of @p sign1 b1 and @p sign2 b2 of the systems and the line senses agree at angle zero.
struct CrossingPair
{
  CrossingPair(const SlipSystem &first, const SlipSystem &second, const double sign1, const double sign2)
      : s1(first), s2(second), sign_1(sign1), sign_2(sign2), e(first.normal.cross(second.normal).normalized())
  {
  }
  std::vector<CrossingLine> at(const double angle1, const double angle2, const double gap = 0.5) const
  {
    return {line_at(s1, sign_1, e, angle1), line_at(s2, sign_2, e, angle2, gap)};
  }
  Vec3 product() const { return sign_1 * s1.burgers + sign_2 * s2.burgers; }

  SlipSystem s1, s2;
  double sign_1, sign_2;
  Vec3 e; ///< unit vector along both planes
};
} // namespace ddfem
