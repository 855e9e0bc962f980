#include "dd/forces/near_forces.h"

#include "dd/elasticity/distance.h"
#include "dd/elasticity/self_force.h"
#include "dd/elasticity/vectorised/force_kernels.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace ddfem
{
namespace
{
struct Ends
{
  Vec3 start, end;
};

Ends ends_of(const Network &network, const SegmentIndex s)
{
  const Vec3 &x = network.position(network.start(s));
  return {x, x + network.direction(s)};
}

/// The image of segment @p s that is nearest to the point @p x.
Ends image_near(const Network &network, const SegmentIndex s, const Vec3 &x)
{
  Ends e = ends_of(network, s);
  if (network.period().isZero(0))
    return e;
  const Vec3 away = 0.5 * (e.start + e.end) - x;
  const Vec3 shift = network.minimum_image(away) - away;
  return {e.start + shift, e.end + shift};
}

bool share_a_node(const Network &network, const SegmentIndex s, const SegmentIndex r)
{
  const NodeIndex a = network.start(s), b = network.end(s);
  return network.start(r) == a || network.start(r) == b || network.end(r) == a || network.end(r) == b;
}

PairDistance distance_of(const Network &network, const SegmentIndex s, const SegmentIndex r)
{
  const Ends a = ends_of(network, s), b = image_near(network, r, 0.5 * (a.start + a.end));
  return distance_segment_segment(a.start, a.end, b.start, b.end);
}
/// At the start, in the middle or at the end of the motion.
bool come_near(const Network &network, const SegmentIndex s, const SegmentIndex r, const std::span<const Vec3> motion,
               const double distance)
{
  const Ends a = ends_of(network, s), b = image_near(network, r, 0.5 * (a.start + a.end));
  const auto moved = [&](const Vec3 &x, const NodeIndex i, const double part) -> Vec3
  { return motion.empty() ? x : Vec3(x + part * motion[i.value]); };
  for (const double t : {0.0, 0.5, 1.0})
  {
    if (distance_segment_segment(moved(a.start, network.start(s), t), moved(a.end, network.end(s), t),
                                 moved(b.start, network.start(r), t), moved(b.end, network.end(r), t))
            .squared <= distance * distance)
      return true;
    if (motion.empty())
      return false;
  }
  return false;
}
} // namespace

void NearForces::update(const Network &network, const NearForceSettings &force_settings,
                        const SymTensor &applied_stress, const std::span<const Vec3> motion)
{
  settings = force_settings;
  applied = applied_stress;
  // The list has all pairs that come near while nodes go straight: those near at three times of it are among them.
  candidates.update(network, motion, settings.distance);
  const std::span<const CandidatePair> all = candidates.pairs();
  std::vector<std::uint8_t> is_near(all.size(), 0);
#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < all.size(); ++k)
    is_near[k] = !share_a_node(network, all[k].first, all[k].second) &&
                 come_near(network, all[k].first, all[k].second, motion, settings.distance);
  pairs.clear();
  for (std::size_t k = 0; k < all.size(); ++k)
    if (is_near[k])
      pairs.push_back(all[k]);
  make_lists(network);
}

void NearForces::widen(const Network &network, const std::span<const NodeIndex> around, const double distance)
{
  const auto ids = [&](const CandidatePair &p) { return std::pair(network.id(p.first), network.id(p.second)); };
  // Spheres are about where their nodes were when they were entered.
  const double reach = distance + candidates.statistics().skin;
  for (const NodeIndex i : around)
    for (const SegmentIndex s : network.connected_segments(i))
    {
      const Ends e = ends_of(network, s);
      std::vector<SegmentIndex> found;
      candidates.neighbours(network, 0.5 * (e.start + e.end), 0.5 * (e.end - e.start).norm(), reach, found);
      for (const SegmentIndex r : found)
        if (r != s && !share_a_node(network, s, r) && come_near(network, s, r, {}, distance))
          pairs.push_back(network.id(s) < network.id(r) ? CandidatePair{s, r} : CandidatePair{r, s});
    }
  std::ranges::sort(pairs, {}, ids);
  const auto same = [&](const CandidatePair &p, const CandidatePair &q) { return ids(p) == ids(q); };
  pairs.erase(std::unique(pairs.begin(), pairs.end(), same), pairs.end());
  make_lists(network);
}

/// Lists of all segments, one after the other: counted, then filled.
void NearForces::make_lists(const Network &network)
{
  first.assign(network.segment_capacity() + 1, 0);
  const auto for_each_source = [&](auto &&visit)
  {
    for (const SegmentIndex s : network.segments())
      for (const NodeIndex i : {network.start(s), network.end(s)})
        for (const SegmentIndex r : network.connected_segments(i))
          if (r != s)
            visit(s, r);
    for (const CandidatePair &p : pairs)
    {
      visit(p.first, p.second);
      visit(p.second, p.first);
    }
  };
  for_each_source([&](const SegmentIndex s, SegmentIndex) { ++first[s.value + 1]; });
  for (std::size_t s = 1; s < first.size(); ++s)
    first[s] += first[s - 1];
  source_list.resize(first.back());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for_each_source([&](const SegmentIndex s, const SegmentIndex r) { source_list[next[s.value]++] = r; });
}

SegmentForces NearForces::on(const Network &network, const SegmentIndex s, LineTable &scratch) const
{
  const Ends e = ends_of(network, s);
  const Vec3 middle = 0.5 * (e.start + e.end), &b = network.burgers(s);
  scratch.clear();
  for (const SegmentIndex r : sources(s))
  {
    const Ends source = image_near(network, r, middle);
    scratch.add_segment(source.start, source.end, network.burgers(r));
  }
  SegmentForces f = force_of_segments(settings.medium, scratch, e.start, e.end, b, settings.pair_tolerance);
  const SegmentForces self = self_force(settings.medium, e.start, e.end, b);
  const SegmentForces core = core_force(settings.medium, CoreEnergy{settings.core_cutoff_radius}, e.start, e.end, b);
  const Vec3 half = 0.5 * contract(applied, b).cross(Vec3(e.end - e.start));
  f.start += self.start + core.start + half;
  f.end += self.end + core.end + half;
  return f;
}

double NearForces::gradient(const Network &network, const SegmentIndex s, const SegmentIndex source) const
{
  const Vec3 t = network.direction(s), u = network.direction(source);
  const double d2 = distance_of(network, s, source).squared + settings.medium.a * settings.medium.a;
  const double sine = t.cross(u).norm() / (t.norm() * u.norm());
  const double common = std::min({t.norm(), u.norm(), 2 * std::sqrt(d2) / std::max(sine, 1e-12)});
  return settings.medium.mu * network.burgers(s).norm() * network.burgers(source).norm() * common /
         (2 * std::numbers::pi * (1 - settings.medium.nu) * d2);
}

std::vector<double> NearForces::gradient_at_nodes(const Network &network) const
{
  std::vector<double> of_segment(network.segment_capacity(), 0.0), of_node(network.node_capacity(), 0.0);
  network.for_each_segment(
      [&](const SegmentIndex s, NodeIndex, NodeIndex)
      {
        for (const SegmentIndex r : sources(s))
          if (!share_a_node(network, s, r))
            of_segment[s.value] += gradient(network, s, r);
      });
  network.for_each_node_with_segments(
      [&](const NodeIndex i, std::span<const SegmentIndex> arms)
      {
        for (const SegmentIndex s : arms)
          of_node[i.value] += of_segment[s.value];
      });
  return of_node;
}
} // namespace ddfem
