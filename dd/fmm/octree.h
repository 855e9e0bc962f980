// Adaptive octree of lines and points, with the pairs of boxes that interact directly and by expansions.
#pragma once

#include "dd/fmm/stress_expansion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

namespace ddfem::fmm
{
/// Where a source is, as the tree sees it.
struct SourceExtent
{
  Vec3 middle;
  double length; ///< of a line; twice the radius around the middle of anything else, nm
};

std::vector<SourceExtent> extents_of(std::span<const LineSource> lines);

/// The boxes of level 0: a grid of n[0] x n[1] x n[2] boxes with edge lengths `edges` (nm).
struct RootGrid
{
  Vec3 origin = Vec3::Zero(); ///< lowest corner, nm
  Vec3 edges = Vec3::Ones();
  std::array<int, 3> n{1, 1, 1};
  bool periodic = false; ///< with the 26 neighbouring images of the grid
};

/// Box of the tree. Its lines and points, those of its children included, are contiguous in the tree's order.
struct Box
{
  std::uint32_t parent = 0, first_child = 0;
  std::uint8_t n_children = 0, level = 0;
  std::array<std::int32_t, 3> place{};          ///< integer coordinates in the grid of its level
  std::uint32_t lines_begin = 0, lines_end = 0; ///< of the box and its children
  std::uint32_t own_lines_end = 0;              ///< [lines_begin, own_lines_end) are held by this box itself
  std::uint32_t points_begin = 0, points_end = 0;

  std::size_t n_lines() const { return lines_end - lines_begin; }
  std::size_t n_points() const { return points_end - points_begin; }
  bool is_leaf() const { return n_children == 0; }
  /// Which child of its parent this is: bits of x, y and z.
  std::size_t octant() const
  {
    const int bits = (place[0] & 1) + 2 * (place[1] & 1) + 4 * (place[2] & 1);
    return static_cast<std::size_t>(bits);
  }
};

/// Lines of `box`, shifted by image number `image`, that act directly on the points of the box that has the link.
struct NearLink
{
  std::uint32_t box;
  std::uint8_t image;
  bool own_only; ///< only the lines that `box` holds itself
};

/// Box whose multipole expansion acts on the box that has the link; offset of places, source - target.
struct FarLink
{
  std::uint32_t box;
  std::array<std::int16_t, 3> offset;
};

/// Around lines, nm.
struct LineSpheres
{
  std::vector<double> x, y, z, radius;

  void reserve(std::size_t n);
  void add(const Vec3 &middle, double radius);
  /// Calls visit(k) for every sphere k in [begin, end) that touches the one of @p reach (nm) around @p centre.
  template <class Visit>
  void for_each_near(const Vec3 &centre, double reach, std::size_t begin, std::size_t end, Visit &&visit) const;

private:
  /// Sets near[i] to whether sphere number @p begin + i does, for i < @p n.
  void find(const Vec3 &centre, double reach, std::size_t begin, std::size_t n, std::uint8_t *near) const;
};

/// Links of all boxes, one after the other.
template <class Link> class LinkLists
{
public:
  std::span<const Link> of(const std::size_t box) const
  {
    return {links.data() + first[box], first[box + 1] - first[box]};
  }
  /// Adds those of the next boxes.
  void append(const std::vector<std::vector<Link>> &of_boxes)
  {
    for (const std::vector<Link> &l : of_boxes)
      first.push_back(first.back() + l.size());
    links.reserve(first.back());
    for (const std::vector<Link> &l : of_boxes)
      links.insert(links.end(), l.begin(), l.end());
  }

private:
  std::vector<std::size_t> first{0};
  std::vector<Link> links;
};

/// What decides how far boxes are divided and which pairs use expansions.
struct TreeSettings
{
  /// Cost of a translation between boxes by their squared distance in boxes, in evaluations of a segment at a point; the last
  /// entry holds for all larger distances.
  std::vector<double> translation_cost;
  double longest_line = 0.5; ///< of a box's lines, in box sizes; longer ones stay in a larger box
  double smallest_box = 0.0; ///< nm
  int depth = 0;             ///< levels below the roots, everywhere, and no distant pair is direct; 0: what costs least
};

class Octree
{
public:
  Octree(const RootGrid &grid, std::span<const SourceExtent> sources, std::span<const Vec3> points,
         const TreeSettings &settings);

  /// Puts other sources and points into the boxes, whose division and links stay: each source into a box that held some itself when
  /// the tree was made, @p box_of_line, each point into a leaf that had some.
  void move(std::span<const SourceExtent> sources, std::span<const std::uint32_t> box_of_line,
            std::span<const std::uint32_t> leaf_of_point);
  /// Box that holds each line itself, in the order given.
  std::vector<std::uint32_t> boxes_of_lines() const;
  /// Leaf of a point, or the nearest one on the way to it that had points when the tree was made.
  std::uint32_t leaf_at(const Vec3 &x) const;
  /// Smallest box around @p middle (nm) that takes a line of @p length (nm) and held some itself when the tree was made.
  std::optional<std::uint32_t> box_for_line(const Vec3 &middle, double length) const;
  /// nm; 0 inside.
  double distance_outside(std::size_t box, const Vec3 &x) const;

  /// Level by level; children of a box are contiguous.
  const std::vector<Box> &boxes() const { return all; }
  /// First box of each level, and one past the last box.
  const std::vector<std::uint32_t> &levels() const { return level_begin; }
  std::span<const NearLink> near_links(std::size_t box) const { return near.of(box); }
  /// Computed from the neighbours of the parent: kept, they would be most of the tree's memory.
  std::vector<FarLink> far_links(std::size_t box) const;
  std::size_t n_far_links(std::size_t box) const { return n_far[box]; }

  /// Position in the tree's order -> index in what the constructor was given.
  const std::vector<std::uint32_t> &line_order() const { return line_at; }
  const std::vector<std::uint32_t> &point_order() const { return point_at; }

  /// In the tree's order.
  const LineSpheres &line_spheres() const { return spheres; }

  Vec3 centre(const Box &box) const; ///< nm
  /// nm
  const Vec3 &edges(const Box &box) const { return edges_of_level[box.level]; }
  double size(const Box &box) const { return edges(box).maxCoeff(); } ///< longest edge, nm
  /// Translations of the images, nm; the first is zero.
  const std::vector<Vec3> &image_shifts() const { return shifts; }

  /// Calls visit(position in the tree's order, image) for every line whose middle is nearer to @p x than @p radius plus half its
  /// length, in a fixed order.
  template <class Visit> void for_each_line_near(const Vec3 &x, double radius, Visit &&visit) const;

  /// Calls visit(link, begin, end) for every link that acts on the points of a leaf, its own and those of the boxes that contain it;
  /// [begin, end): its lines, in the tree's order.
  template <class Visit> void for_each_near_link(std::size_t leaf, Visit &&visit) const;

private:
  template <class Visit>
  void visit_lines(const Box &box, const Vec3 &x, double radius, std::size_t image, Visit &visit) const;

  struct Neighbour
  {
    std::uint32_t box;
    std::array<std::int16_t, 3> offset;
    std::uint8_t image;
  };
  /// Pairs of the boxes of one level.
  struct LevelPairs
  {
    std::size_t first_box;
    std::vector<std::vector<Neighbour>> neighbours;
    std::vector<std::vector<NearLink>> near;
    std::vector<std::uint32_t> n_far;

    LevelPairs(std::size_t first, std::size_t n) : first_box(first), neighbours(n), near(n), n_far(n, 0) {}
  };
  /// How two boxes of one level act on each other.
  enum class PairKind : std::uint8_t
  {
    none,
    neighbours,
    direct,
    far
  };
  struct Counts
  {
    std::size_t n_points, n_lines;
  };
  struct Contents
  {
    std::span<const SourceExtent> sources;
    std::span<const Vec3> points;
  };

  int root_at(const Vec3 &x) const;
  void sort_into_roots(const Contents &contents);
  LevelPairs pair_roots() const;
  bool is_worth_dividing(std::size_t box, const std::vector<Neighbour> &neighbours) const;
  void divide(std::size_t box, const Contents &contents);
  void count_contents();
  template <class Visit> void for_each_pair(std::size_t target, Visit &&visit) const;
  PairKind kind_of(std::size_t target, const Neighbour &source) const;
  void link_neighbours(std::size_t box, LevelPairs &level) const;
  void pair(std::size_t target, const Neighbour &source, LevelPairs &level) const;
  double translation_cost(const std::array<std::int16_t, 3> &offset) const;
  void place_spheres(std::span<const SourceExtent> sources);
  void number_contents(std::size_t box, std::span<const std::uint32_t> own_lines,
                       std::span<const std::uint32_t> own_points, std::uint32_t &next_line, std::uint32_t &next_point);
  void measure_overhang();

  RootGrid grid;
  TreeSettings settings;
  std::vector<Vec3> edges_of_level; ///< nm
  std::vector<Box> all;
  std::vector<std::uint32_t> level_begin;
  LinkLists<NearLink> near;
  LinkLists<Neighbour> adjacent; ///< of boxes with children
  std::vector<std::uint32_t> n_far;
  std::vector<std::uint32_t> line_at, point_at;
  std::vector<Vec3> shifts;
  LineSpheres spheres;
  std::vector<Vec3> centres;           ///< of the boxes, nm
  std::vector<double> overhang;        ///< how far the lines of a box and of its children reach out of it, nm
  std::vector<Counts> made_with;       ///< contents of the boxes when the tree was made
  std::vector<std::uint8_t> had_lines; ///< of its own, when the tree was made
};

template <class Visit>
void LineSpheres::for_each_near(const Vec3 &centre, const double reach, const std::size_t begin, const std::size_t end,
                                Visit &&visit) const
{
  constexpr std::size_t at_once = 64, eight = 8;
  std::uint8_t near[at_once];
  for (std::size_t first = begin; first < end; first += at_once)
  {
    const std::size_t n = std::min(at_once, end - first);
    find(centre, reach, first, n, near);
    std::fill(near + n, near + (n + eight - 1) / eight * eight, std::uint8_t{0});
    for (std::size_t i = 0; i < n; i += eight) // few are near: most eights hold none
    {
      std::uint64_t flags = 0;
      std::memcpy(&flags, near + i, eight);
      if (flags != 0)
        for (std::size_t k = i; k < i + eight; ++k)
          if (near[k] != 0)
            visit(first + k);
    }
  }
}

template <class Visit> void Octree::for_each_near_link(const std::size_t leaf, Visit &&visit) const
{
  for (std::size_t i = leaf;; i = all[i].parent)
  {
    for (const NearLink &link : near.of(i))
    {
      const Box &source = all[link.box];
      visit(link, source.lines_begin, link.own_only ? source.own_lines_end : source.lines_end);
    }
    if (all[i].level == 0)
      return;
  }
}

template <class Visit> void Octree::for_each_line_near(const Vec3 &x, const double radius, Visit &&visit) const
{
  for (std::size_t image = 0; image < shifts.size(); ++image)
    for (std::size_t root = 0; root < level_begin[1]; ++root)
      visit_lines(all[root], x - shifts[image], radius, image, visit);
}

template <class Visit>
void Octree::visit_lines(const Box &box, const Vec3 &x, const double radius, const std::size_t image,
                         Visit &visit) const
{
  const auto index = static_cast<std::size_t>(&box - all.data());
  const Vec3 &centre_of_box = centres[index], &whole = edges(box);
  const double reach = radius + overhang[index];
  double outside2 = 0;
  for (Eigen::Index c = 0; c < 3; ++c)
  {
    const double outside = std::max(std::abs(x[c] - centre_of_box[c]) - 0.5 * whole[c], 0.0);
    outside2 += outside * outside;
  }
  if (box.n_lines() == 0 || outside2 > reach * reach)
    return;
  spheres.for_each_near(x, radius, box.lines_begin, box.own_lines_end,
                        [&](const std::size_t k) { visit(static_cast<std::uint32_t>(k), image); });
  for (std::uint32_t i = 0; i < box.n_children; ++i)
    visit_lines(all[box.first_child + i], x, radius, image, visit);
}
} // namespace ddfem::fmm
