#include "dd/fmm/octree.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace ddfem::fmm
{
namespace
{
constexpr int deepest_level = 24;

/// Sorts [begin, end) of @p order by key(index) in [0, n_keys), stable; returns the n_keys + 1 limits.
template <class Key>
std::vector<std::uint32_t> sort_by_key(std::vector<std::uint32_t> &order, const std::uint32_t begin,
                                       const std::uint32_t end, const std::size_t n_keys, Key &&key)
{
  std::vector<std::uint32_t> limit(n_keys + 1, 0), keys, sorted(end - begin);
  keys.reserve(end - begin);
  for (std::uint32_t i = begin; i < end; ++i)
  {
    keys.push_back(static_cast<std::uint32_t>(key(order[i])));
    ++limit[keys.back() + 1];
  }
  std::partial_sum(limit.begin(), limit.end(), limit.begin());
  std::vector<std::uint32_t> next(limit.begin(), limit.end() - 1);
  for (std::uint32_t i = begin; i < end; ++i)
    sorted[next[keys[i - begin]]++] = order[i];
  std::copy(sorted.begin(), sorted.end(), order.begin() + begin);
  for (std::uint32_t &l : limit)
    l += begin;
  return limit;
}

int octant(const Vec3 &x, const Vec3 &centre)
{
  return (x[0] >= centre[0] ? 1 : 0) + (x[1] >= centre[1] ? 2 : 0) + (x[2] >= centre[2] ? 4 : 0);
}

DDFEM_FMM_EVERY_PROCESSOR
void find_near(const double *x, const double *y, const double *z, const double *radius, const Vec3 &centre,
               const double reach, const std::size_t n, std::uint8_t *near)
{
  const double cx = centre[0], cy = centre[1], cz = centre[2];
  for (std::size_t i = 0; i < n; ++i)
  {
    const double dx = x[i] - cx, dy = y[i] - cy, dz = z[i] - cz, sum = reach + radius[i];
    near[i] = dx * dx + dy * dy + dz * dz < sum * sum ? 1 : 0;
  }
}
} // namespace

void LineSpheres::find(const Vec3 &centre, const double reach, const std::size_t begin, const std::size_t n,
                       std::uint8_t *near) const
{
  find_near(x.data() + begin, y.data() + begin, z.data() + begin, radius.data() + begin, centre, reach, n, near);
}

void LineSpheres::reserve(const std::size_t n)
{
  for (std::vector<double> *const v : {&x, &y, &z, &radius})
    v->reserve(n);
}

void LineSpheres::add(const Vec3 &middle, const double radius_of_line)
{
  x.push_back(middle[0]);
  y.push_back(middle[1]);
  z.push_back(middle[2]);
  radius.push_back(radius_of_line);
}

std::vector<SourceExtent> extents_of(const std::span<const LineSource> lines)
{
  std::vector<SourceExtent> extents;
  extents.reserve(lines.size());
  for (const LineSource &l : lines)
    extents.push_back({0.5 * (l.start + l.end), (l.end - l.start).norm()});
  return extents;
}

Octree::Octree(const RootGrid &grid_, const std::span<const SourceExtent> sources, const std::span<const Vec3> points,
               const TreeSettings &settings_)
    : grid(grid_), settings(settings_), shifts{Vec3::Zero()}
{
  const Vec3 period = grid.edges.cwiseProduct(Vec3(grid.n[0], grid.n[1], grid.n[2]));
  if (grid.periodic)
    for (int k = 0; k < 27; ++k)
      if (k != 13)
      {
        const int i = k / 9 - 1, j = k / 3 % 3 - 1, l = k % 3 - 1;
        shifts.emplace_back(period.cwiseProduct(Vec3(i, j, l)));
      }
  for (int level = 0; level <= deepest_level; ++level)
    edges_of_level.emplace_back(std::ldexp(1.0, -level) * grid.edges);
  const Contents contents{sources, points};
  sort_into_roots(contents);
  LevelPairs level = pair_roots();
  while (level_begin.back() > level_begin[level_begin.size() - 2])
  {
    const std::size_t begin = level_begin[level_begin.size() - 2], end = level_begin.back();
    for (std::size_t i = begin; i < end; ++i)
      if (all[i].level < deepest_level && is_worth_dividing(i, level.neighbours[i - begin]))
        divide(i, contents);
    level_begin.push_back(static_cast<std::uint32_t>(all.size()));
    count_contents();
#pragma omp parallel for schedule(dynamic, 64)
    for (std::size_t i = begin; i < end; ++i)
      link_neighbours(i, level);
    near.append(level.near);
    adjacent.append(level.neighbours);
    n_far.insert(n_far.end(), level.n_far.begin(), level.n_far.end());
    LevelPairs children(end, all.size() - end);
#pragma omp parallel for schedule(dynamic, 64)
    for (std::size_t i = end; i < all.size(); ++i)
      for_each_pair(i, [&](const Neighbour &source) { pair(i, source, children); });
    level = std::move(children);
  }
  level_begin.pop_back(); // the last level is empty
  place_spheres(sources);
  for (const Box &box : all)
  {
    centres.push_back(centre(box));
    had_lines.push_back(box.own_lines_end > box.lines_begin ? 1 : 0);
  }
  measure_overhang();
}

void Octree::place_spheres(const std::span<const SourceExtent> sources)
{
  spheres = {};
  spheres.reserve(line_at.size());
  for (const std::uint32_t i : line_at)
    spheres.add(sources[i].middle, 0.5 * sources[i].length);
}

void Octree::measure_overhang()
{
  overhang.assign(all.size(), 0.0);
  for (std::size_t i = all.size(); i-- > 0;)
  {
    const Box &box = all[i];
    for (std::size_t k = box.lines_begin; k < box.own_lines_end; ++k)
      overhang[i] = std::max(overhang[i],
                             distance_outside(i, Vec3(spheres.x[k], spheres.y[k], spheres.z[k])) + spheres.radius[k]);
    if (box.level > 0)
      overhang[box.parent] = std::max(overhang[box.parent], overhang[i]);
  }
}

int Octree::root_at(const Vec3 &x) const
{
  int k = 0;
  for (int c = 0; c < 3; ++c)
  {
    const int n = grid.n[static_cast<std::size_t>(c)];
    k = k * n + std::clamp(static_cast<int>(std::floor((x[c] - grid.origin[c]) / grid.edges[c])), 0, n - 1);
  }
  return k;
}

void Octree::sort_into_roots(const Contents &contents)
{
  const auto &[sources, points] = contents;
  line_at.resize(sources.size());
  point_at.resize(points.size());
  std::iota(line_at.begin(), line_at.end(), 0U);
  std::iota(point_at.begin(), point_at.end(), 0U);
  const int volume = grid.n[0] * grid.n[1] * grid.n[2];
  const auto n_roots = static_cast<std::size_t>(volume);
  const auto line_limits = sort_by_key(line_at, 0, static_cast<std::uint32_t>(sources.size()), n_roots,
                                       [&](std::uint32_t i) { return root_at(contents.sources[i].middle); });
  const auto point_limits = sort_by_key(point_at, 0, static_cast<std::uint32_t>(points.size()), n_roots,
                                        [&](std::uint32_t i) { return root_at(contents.points[i]); });
  for (std::size_t k = 0; k < n_roots; ++k)
  {
    const int i = static_cast<int>(k);
    Box box;
    box.place = {i / (grid.n[1] * grid.n[2]), i / grid.n[2] % grid.n[1], i % grid.n[2]};
    box.lines_begin = line_limits[k];
    box.lines_end = box.own_lines_end = line_limits[k + 1];
    box.points_begin = point_limits[k];
    box.points_end = point_limits[k + 1];
    all.push_back(box);
  }
  level_begin = {0, static_cast<std::uint32_t>(all.size())};
  count_contents();
}

void Octree::count_contents()
{
  for (std::size_t i = made_with.size(); i < all.size(); ++i)
    made_with.push_back({all[i].n_points(), all[i].n_lines()});
}

Octree::LevelPairs Octree::pair_roots() const
{
  LevelPairs roots(0, all.size());
  for (std::size_t target = 0; target < all.size(); ++target)
    for_each_pair(target, [&](const Neighbour &source) { pair(target, source, roots); });
  return roots;
}

/// Calls visit(source) for every box of the level whose parent is a neighbour of that of @p target.
template <class Visit> void Octree::for_each_pair(const std::size_t target, Visit &&visit) const
{
  const Box &a = all[target];
  if (a.level > 0)
  {
    for (const Neighbour &n : adjacent.of(a.parent))
      for (std::uint32_t j = 0; j < all[n.box].n_children; ++j)
      {
        Neighbour link{all[n.box].first_child + j, {}, n.image};
        for (std::size_t c = 0; c < 3; ++c)
          link.offset[c] = static_cast<std::int16_t>(2 * n.offset[c] + (all[link.box].place[c] & 1) - (a.place[c] & 1));
        visit(link);
      }
    return;
  }
  for (std::size_t image = 0; image < shifts.size(); ++image)
    for (std::uint32_t source = 0; source < level_begin[1]; ++source)
    {
      Neighbour link{source, {}, static_cast<std::uint8_t>(image)};
      for (std::size_t c = 0; c < 3; ++c)
      {
        const auto axis = static_cast<int>(c);
        const auto shift = static_cast<int>(std::lround(shifts[image][axis] / grid.edges[axis]));
        link.offset[c] = static_cast<std::int16_t>(all[source].place[c] + shift - a.place[c]);
      }
      visit(link);
    }
}

double Octree::translation_cost(const std::array<std::int16_t, 3> &offset) const
{
  const int distance2 = offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2];
  return settings.translation_cost[std::min(static_cast<std::size_t>(distance2), settings.translation_cost.size() - 1)];
}

bool Octree::is_worth_dividing(const std::size_t box, const std::vector<Neighbour> &neighbours) const
{
  // Each pair of neighbours has direct work n_points n_lines in both directions. After the division of both, an eighth of
  // it stays, and 56 of 64 pairs of children need translations, at least if all children exist.
  const Box &a = all[box];
  if (size(a) / 2 < settings.smallest_box || neighbours.empty())
    return false;
  if (settings.depth > 0)
    return a.level < settings.depth;
  double work = 0;
  for (const Neighbour &n : neighbours)
  {
    const Box &b = all[n.box];
    work += static_cast<double>(a.n_points() * b.n_lines() + a.n_lines() * b.n_points());
  }
  return work > 2 * 64 * settings.translation_cost[8] * static_cast<double>(neighbours.size());
}

void Octree::divide(const std::size_t index, const Contents &contents)
{
  Box box = all[index];
  const Vec3 middle = centre(box);
  const double longest = settings.longest_line * size(box) / 2;
  // Key 0: lines too long for the children, held here.
  const auto lines = sort_by_key(line_at, box.lines_begin, box.lines_end, 9,
                                 [&](const std::uint32_t i)
                                 {
                                   const SourceExtent &s = contents.sources[i];
                                   return s.length > longest ? 0 : 1 + octant(s.middle, middle);
                                 });
  const auto points = sort_by_key(point_at, box.points_begin, box.points_end, 8,
                                  [&](std::uint32_t i) { return octant(contents.points[i], middle); });
  box.own_lines_end = lines[1];
  box.first_child = static_cast<std::uint32_t>(all.size());
  for (std::size_t k = 0; k < 8; ++k)
  {
    Box child;
    child.parent = static_cast<std::uint32_t>(index);
    child.level = static_cast<std::uint8_t>(box.level + 1);
    child.place = {2 * box.place[0] + static_cast<int>(k & 1), 2 * box.place[1] + static_cast<int>(k >> 1 & 1),
                   2 * box.place[2] + static_cast<int>(k >> 2)};
    child.lines_begin = lines[k + 1];
    child.lines_end = child.own_lines_end = lines[k + 2];
    child.points_begin = points[k];
    child.points_end = points[k + 1];
    if (child.n_lines() + child.n_points() > 0)
    {
      all.push_back(child);
      ++box.n_children;
    }
  }
  all[index] = box;
}

Octree::PairKind Octree::kind_of(const std::size_t target, const Neighbour &source) const
{
  const auto &d = source.offset;
  if (std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])}) <= 1)
    return PairKind::neighbours;
  const std::size_t n_points = made_with[target].n_points, n_lines = made_with[source.box].n_lines;
  if (n_points == 0 || n_lines == 0)
    return PairKind::none;
  if (settings.depth == 0 && static_cast<double>(n_points * n_lines) < translation_cost(d))
    return PairKind::direct;
  return PairKind::far;
}

void Octree::pair(const std::size_t target, const Neighbour &source, LevelPairs &level) const
{
  const std::size_t i = target - level.first_box;
  switch (kind_of(target, source))
  {
    case PairKind::none: break;
    case PairKind::neighbours: level.neighbours[i].push_back(source); break;
    case PairKind::direct: level.near[i].push_back({source.box, source.image, false}); break;
    case PairKind::far: ++level.n_far[i];
  }
}

/// Direct work of neighbours of which one is not divided, or holds lines itself. Gives up the neighbours of leaves.
void Octree::link_neighbours(const std::size_t box, LevelPairs &level) const
{
  const Box &a = all[box];
  const std::size_t i = box - level.first_box;
  for (const Neighbour &n : level.neighbours[i])
  {
    const Box &b = all[n.box];
    const bool both = !a.is_leaf() && !b.is_leaf();
    if (a.n_points() > 0 && (both ? b.own_lines_end : b.lines_end) > b.lines_begin)
      level.near[i].push_back({n.box, n.image, both});
  }
  if (a.is_leaf())
    level.neighbours[i] = {};
}

std::vector<FarLink> Octree::far_links(const std::size_t box) const
{
  std::vector<FarLink> links;
  links.reserve(n_far[box]);
  if (n_far[box] > 0)
    for_each_pair(box,
                  [&](const Neighbour &source)
                  {
                    if (kind_of(box, source) == PairKind::far)
                      links.push_back({source.box, source.offset});
                  });
  return links;
}

Vec3 Octree::centre(const Box &box) const
{
  const Vec3 corner(box.place[0] + 0.5, box.place[1] + 0.5, box.place[2] + 0.5);
  return grid.origin + corner.cwiseProduct(edges(box));
}
} // namespace ddfem::fmm
