// Pinned straight lines that cross at the origin, and what has become of them after they have reacted.
#pragma once

#include "dd/crystal/material.h"
#include "dd/crystal/product_plane.h"
#include "dd/elasticity/segment_energy.h"
#include "dd/microstructure/sources.h"
#include "samples/dislocation_driver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace ddfem
{
/// Coarse: segments of 6 to 16 nm, capture within 1 nm, no core energy beyond that of the non-singular theory.
inline DriverSettings coarse_settings(const Material &m)
{
  const double b = m.burgers_magnitude;
  return {{m.mu, m.nu, b}, b, linear_glide(m.drag, m.drag), {6, 16, 0.1, 1}, {0.1, 2, 0.2, 1e-4, 30}};
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

/// The line of @p system with its Burgers vector times @p sign, at @p degrees from @p e towards n x e; e is a unit
/// vector in its plane.
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
                const std::vector<CrossingLine> &crossing)
      : DislocationDriver(coarse_settings(material), slip_systems), systems(slip_systems), length(line_length)
  {
    for (const CrossingLine &l : crossing)
      add(l);
  }

  void add(CrossingLine l)
  {
    constexpr int parts = 10;
    const PlaneIndex p = network.planes().find_or_insert(l.system.plane_miller, l.system.normal, Vec3(Vec3::Zero()));
    const Vec3 middle = l.gap * l.system.normal.cross(l.direction);
    std::vector<Vec3> points;
    for (int m = 0; m <= parts; ++m)
      points.push_back(network.planes().project(p, middle + (1.0 * m / parts - 0.5) * length * l.direction));
    const auto nodes = add_line(network, points, l.burgers, p, false, NodeConstraint::pinned);
    l.ends = {network.id(nodes.front()), network.id(nodes.back())};
    lines.push_back(l);
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

  const SlipSystems &systems;
  double length; ///< of each line, nm
  std::vector<CrossingLine> lines;
};

/// Two lines on different planes that cross at angles from the line that the planes have in common. Angle zero: both
/// line senses along e, so that a junction along e carries b1 + b2.
struct CrossingPair
{
  CrossingPair(const SlipSystem &first, const SlipSystem &second, const double sign_1, const double sign_2)
      : system{first, second}, sign{sign_1, sign_2}, e(first.normal.cross(second.normal).normalized())
  {
  }
  /// Signs such that parallel lines attract: b1 . b2 < 0.
  static CrossingPair attractive(const SlipSystem &first, const SlipSystem &second)
  {
    return {first, second, 1, first.burgers.dot(second.burgers) < 0 ? 1.0 : -1.0};
  }

  std::vector<CrossingLine> at(const double degrees_1, const double degrees_2, const double gap = 0.5) const
  {
    return {line_at(system[0], sign[0], e, degrees_1), line_at(system[1], sign[1], e, degrees_2, gap)};
  }
  Vec3 product() const { return sign[0] * system[0].burgers + sign[1] * system[1].burgers; }
  /// Of Frank's criterion, b^2 - b1^2 - b2^2 in nm^2.
  double energy_change() const
  {
    return product().squaredNorm() - system[0].burgers.squaredNorm() - system[1].burgers.squaredNorm();
  }

  std::array<SlipSystem, 2> system;
  std::array<double, 2> sign;
  Vec3 e; ///< unit vector along both planes
};

/// What is left of two lines at plus and minus @p degrees from e that annihilate, were the line tension isotropic: the
/// distances of their four ends from e, nm.
inline double shortest_way_to_intersection(const double degrees, const double line_length)
{
  return 2 * line_length * std::sin(degrees * std::numbers::pi / 180);
}

/// How far the length of a junction may be from junction_length_of_least_energy(), relative: the stress of lines that
/// end 50 nm away is not in equilibrium, and the forces of these lines are not minus the gradient of their energy.
/// Five straight pieces are in balance up to 8 % from the length of least energy; with tails that move the ends 3 um
/// away, force and gradient agree to 2e-4. The arms also bow, which adds 1 % and less.
constexpr double open_end_tolerance = 0.08;

/// Length of the junction that makes the elastic energy of five straight pieces smallest, nm: the junction along e,
/// centred at the origin, and the four arms from its ends to the pinned ends of the lines. Knows nothing of forces,
/// motion or topology.
inline double junction_length_of_least_energy(const IsotropicMedium &medium, const CrossingPair &pair,
                                              const std::vector<CrossingLine> &lines, const double line_length)
{
  struct Piece
  {
    Vec3 start, end, b;
  };
  const auto energy = [&](const double half)
  {
    const Vec3 x = half * pair.e;
    std::vector<Piece> pieces{{-x, x, pair.product()}};
    for (const CrossingLine &l : lines)
    {
      const Vec3 end = 0.5 * line_length * l.direction;
      pieces.insert(pieces.end(), {{-end, -x, l.burgers}, {x, end, l.burgers}});
    }
    double sum = 0;
    for (std::size_t k = 0; k < pieces.size(); ++k)
    {
      const Piece &p = pieces[k];
      sum += segment_self_energy(medium, p.start, p.end, p.b);
      for (std::size_t m = 0; m < k; ++m)
        sum +=
            segment_interaction_energy(medium, p.start, p.end, p.b, pieces[m].start, pieces[m].end, pieces[m].b, 1e-8);
    }
    return sum;
  };
  double low = 1e-3 * line_length, high = 0.5 * line_length; // golden section
  while (high - low > 1e-4 * line_length)
  {
    const double third = 0.381966 * (high - low), a = low + third, b = high - third;
    (energy(a) < energy(b) ? high : low) = energy(a) < energy(b) ? b : a;
  }
  return low + high;
}

/// Every segment carries a lattice translation of one of @p types; it lies in its plane with its direction and b; at
/// every free node the Burgers vectors balance; lines with the b of an initial line are still on the plane of such a
/// line.
inline void expect_sound(const CrossingLines &c, const std::vector<BurgersType> &types)
{
  const Network &n = c.network;
  EXPECT_NO_THROW(n.check_invariants(1e-5));
  for (const SegmentIndex s : n.segments())
  {
    const auto type = c.systems.burgers_type(n.burgers(s));
    ASSERT_TRUE(type.has_value());
    EXPECT_NE(std::find(types.begin(), types.end(), *type), types.end()) << name_of(*type);
    if (n.plane(s).is_valid())
    {
      EXPECT_NEAR(n.normal(s).dot(n.burgers(s)), 0, 1e-9);
      EXPECT_NEAR(n.normal(s).dot(n.direction(s)), 0, 1e-5);
    }
  }
  for (const NodeIndex i : n.nodes())
    if (n.constraint(i) == NodeConstraint::free)
    {
      Vec3 sum = Vec3::Zero();
      for (const SegmentIndex s : n.connected_segments(i))
        sum += n.burgers_from(s, i);
      EXPECT_LT(sum.norm(), 1e-12);
    }
  for (const CrossingLine &l : c.lines)
    for (const SegmentIndex s : c.segments_with(l.burgers))
    {
      ASSERT_TRUE(n.plane(s).is_valid());
      const auto is_home = [&](const CrossingLine &other)
      { return c.carries(s, other.burgers) && n.normal(s).cross(other.system.normal).norm() < 1e-12; };
      EXPECT_TRUE(std::any_of(c.lines.begin(), c.lines.end(), is_home));
      EXPECT_NEAR(n.position(n.start(s)).dot(n.normal(s)), 0, 1e-5);
    }
}

/// Follows the segments with @p b from node @p here to the next node that has not two arms; returns that node and how
/// many segments there were.
inline std::pair<NodeIndex, std::size_t> follow(const CrossingLines &c, NodeIndex here, const Vec3 &b)
{
  const Network &n = c.network;
  SegmentIndex last;
  for (std::size_t count = 1; count <= n.n_segments(); ++count)
  {
    const auto arms = n.connected_segments(here);
    const SegmentIndex before = last;
    const auto next =
        std::find_if(arms.begin(), arms.end(), [&](const SegmentIndex s) { return s != before && c.carries(s, b); });
    if (next == arms.end())
      return {here, count - 1};
    last = *next;
    here = n.other_end(last, here);
    if (n.degree(here) != 2)
      return {here, count};
  }
  return {{}, 0}; // a closed ring
}

/// One chain of segments with @p b joins two nodes of three arms, and there is no other node of more than two; each of
/// the two joins both lines. With @p plane (index into SlipSystems::planes()) it glides there, otherwise it is
/// sessile.
inline void expect_junction(const CrossingLines &c, const Vec3 &b, const std::optional<std::size_t> plane)
{
  const Network &n = c.network;
  EXPECT_EQ(c.nodes_with_degree(3), 2U);
  EXPECT_EQ(c.nodes_with_degree(4), 0U);
  for (const SegmentIndex s : c.segments_with(b))
  {
    ASSERT_EQ(n.plane(s).is_valid(), plane.has_value());
    if (plane)
    {
      EXPECT_LT(n.normal(s).cross(c.systems.planes()[*plane].normal).norm(), 1e-12);
    }
  }
  std::vector<NodeIndex> ends;
  for (const NodeIndex i : n.nodes())
    if (n.degree(i) == 3)
    {
      ends.push_back(i);
      const auto arms = n.connected_segments(i);
      for (const Vec3 &each : {b, c.lines[0].burgers, c.lines[1].burgers})
        EXPECT_EQ(std::count_if(arms.begin(), arms.end(), [&](const SegmentIndex s) { return c.carries(s, each); }), 1);
    }
  ASSERT_EQ(ends.size(), 2U);
  const auto [far, count] = follow(c, ends[0], b);
  EXPECT_EQ(far, ends[1]);
  EXPECT_EQ(count, c.segments_with(b).size());
}

/// Both lines run again from end to end of their own, with their Burgers vectors and on their planes.
inline void expect_separate_lines(const CrossingLines &c)
{
  EXPECT_EQ(c.nodes_with_degree(3) + c.nodes_with_degree(4), 0U);
  for (const CrossingLine &l : c.lines)
  {
    EXPECT_EQ(c.other_end_of_line(*c.network.find_node(l.ends[0])), l.ends[1]);
    const NodeIndex first = *c.network.find_node(l.ends[0]);
    const SegmentIndex s = c.network.connected_segments(first)[0];
    EXPECT_LT((c.network.burgers_from(s, first) - l.burgers).norm(), 1e-12);
    EXPECT_LT(c.network.normal(s).cross(l.system.normal).norm(), 1e-12);
  }
}

/// Nothing is left between the points where two lines of the same b have annihilated: each new line joins an end of
/// one to an end of the other.
inline void expect_annihilated(const CrossingLines &c)
{
  EXPECT_EQ(c.nodes_with_degree(3) + c.nodes_with_degree(4), 0U);
  for (std::size_t k = 0; k < 2; ++k)
    for (const ObjectId end : c.lines[k].ends)
    {
      const ObjectId far = c.other_end_of_line(*c.network.find_node(end));
      const auto &other = c.lines[1 - k].ends;
      EXPECT_TRUE(far == other[0] || far == other[1]);
    }
}

/// The configuration @p c under the point operation @p g of the crystal (cubic or hexagonal axes along those of the
/// sample). Under a reflection the line sense keeps its image and the FS/RH Burgers vector changes sign as well,
/// because the circuit becomes left-handed.
inline CrossingLine image_of(const CrossingLine &l, const SlipSystems &systems, const Mat3 &g)
{
  const double handedness = g.determinant() < 0 ? -1 : 1;
  CrossingLine image = l;
  image.burgers = handedness * (g * l.burgers);
  image.direction = g * l.direction;
  image.system = systems[systems.find(image.burgers, Vec3(g * l.system.normal)).value().system];
  // The gap is measured along n x direction, whose sense follows those of the normals.
  const Vec3 towards = g * l.system.normal.cross(l.direction);
  image.gap = l.gap * (towards.dot(image.system.normal.cross(image.direction)) > 0 ? 1 : -1);
  return image;
}

/// Largest distance of a node of @p image from the image under @p g of the node of @p c with the same persistent id,
/// nm.
inline double largest_deviation(const CrossingLines &c, const CrossingLines &image, const Mat3 &g)
{
  double largest = 0;
  EXPECT_EQ(c.network.n_nodes(), image.network.n_nodes());
  for (const NodeIndex i : c.network.nodes())
  {
    const auto k = image.network.find_node(c.network.id(i));
    if (!k)
      return std::numeric_limits<double>::infinity();
    largest = std::max(largest, (g * c.network.position(i) - image.network.position(*k)).norm());
  }
  return largest;
}
} // namespace ddfem
