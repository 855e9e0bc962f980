#include "dd/topology/collisions/candidate_list.h"

#include "dd/topology/collisions/common_node.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ddfem
{
namespace
{
/// A node that is faster than the skin provides for gets room for this many steps.
constexpr double steps_of_fast_node = 3;
/// This share of the segments may be unusually long or fast: they are entered one by one instead of widening the grid.
constexpr std::size_t one_in_unusual = 64;
/// Segments entered one by one cost about eight times as much as in a build: when one in eight has been, rebuild.
constexpr std::size_t one_in_inserted = 8;
constexpr std::size_t least_inserted = 16;
/// Entering one is some microseconds of work.
constexpr std::size_t least_entered_for_threads = 32;
/// Spheres are a little larger than the segments need, for the rounding of positions.
constexpr double rounding = 1e-9;

double norm_of(std::span<const Vec3> displacement, NodeIndex i)
{
  return i.value < displacement.size() ? displacement[i.value].norm() : 0.0;
}

/// The value that one in one_in_unusual of about 16 000 evenly picked ones exceed.
template <class F> double usual_maximum(std::size_t n, F &&value)
{
  if (n == 0)
    return 0;
  std::vector<double> sample;
  const std::size_t stride = n / 16384 + 1;
  for (std::size_t k = 0; k < n; k += stride)
    sample.push_back(value(k));
  const auto rank = static_cast<std::ptrdiff_t>(sample.size() - 1 - sample.size() / one_in_unusual);
  std::nth_element(sample.begin(), sample.begin() + rank, sample.end());
  return sample[static_cast<std::size_t>(rank)];
}

/// Lists of all threads, in the order of the threads.
template <class T> std::vector<T> joined(const std::vector<std::vector<T>> &parts)
{
  std::vector<T> all;
  for (const std::vector<T> &part : parts)
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Sorts the entries from the given one on and leaves each once.
void remove_duplicates(std::vector<SegmentIndex> &segments, std::ptrdiff_t from)
{
  const auto begin = segments.begin() + from;
  std::ranges::sort(begin, segments.end(), {}, &SegmentIndex::value);
  segments.erase(std::unique(begin, segments.end()), segments.end());
}

struct ById
{
  const Network &network;
  bool operator()(const CandidatePair &a, const CandidatePair &b) const
  {
    const ObjectId i = network.id(a.first), j = network.id(b.first);
    return i != j ? i < j : network.id(a.second) < network.id(b.second);
  }
};

CandidatePair ordered(const Network &network, SegmentIndex a, SegmentIndex b)
{
  return network.id(a) < network.id(b) ? CandidatePair{a, b} : CandidatePair{b, a};
}

/// Sorted and joined parts. Ids are unique: the result does not depend on the parts.
std::vector<CandidatePair> merged(const Network &network, std::vector<std::vector<CandidatePair>> &parts)
{
  std::size_t n = 0;
  for (const std::vector<CandidatePair> &part : parts)
    n += part.size();
#pragma omp parallel for schedule(dynamic) if (n > least_for_threads)
  for (std::vector<CandidatePair> &part : parts)
    std::sort(part.begin(), part.end(), ById{network});
  std::vector<CandidatePair> all;
  for (const std::vector<CandidatePair> &part : parts)
  {
    const auto middle = static_cast<std::ptrdiff_t>(all.size());
    all.insert(all.end(), part.begin(), part.end());
    std::inplace_merge(all.begin(), all.begin() + middle, all.end(), ById{network});
  }
  return all;
}
} // namespace

void CandidateList::update(const Network &network, std::span<const Vec3> displacement, double radius)
{
  ++statistics_.updates;
  in_step_.reset(map_);
  if (is_outdated(network, radius))
    return rebuild(network, displacement, radius, false);
  for (std::size_t i = references_.size(); i < network.node_capacity(); ++i)
  {
    references_.emplace_back();
    set_reference(network, NodeIndex{static_cast<std::uint32_t>(i)}, displacement);
  }
  const std::vector<NodeIndex> moved = nodes_out_of_reach(network, displacement);
  const std::span<const SegmentIndex> live = network.segments();
  const auto born = std::ranges::lower_bound(live, number_.size(), {}, &SegmentIndex::value);
  std::vector<SegmentIndex> fresh(born, live.end());
  const std::size_t n_born = fresh.size();
  for (const NodeIndex i : moved)
    fresh.insert(fresh.end(), network.connected_segments(i).begin(), network.connected_segments(i).end());
  remove_duplicates(fresh, 0);
  if (inserted_.size() / 2 + fresh.size() > std::max(least_inserted, live.size() / one_in_inserted))
    return rebuild(network, displacement, radius, fresh.size() > 2 * n_born);

  ++steps_of_build_;
  for (const NodeIndex i : moved)
    set_reference(network, i, displacement);
  number_.resize(network.segment_capacity(), 0);
  const bool died = live.size() - n_born != n_live_;
  n_live_ = live.size();
  if (died || !fresh.empty())
    enter(network, fresh);
}

bool CandidateList::is_outdated(const Network &network, double radius) const
{
  return radius > radius_ || network.n_cleans() != n_cleans_ || network.period() != period_ ||
         network.node_capacity() < references_.size() || network.segment_capacity() < number_.size();
}

void CandidateList::set_reference(const Network &network, NodeIndex i, std::span<const Vec3> displacement)
{
  const double d = norm_of(displacement, i), half_skin = 0.5 * statistics_.skin;
  const Vec3 &x = network.position(i);
  if (network.contains(i) && !std::isfinite(x.sum() + d))
    throw std::invalid_argument("Node " + std::to_string(network.id(i)) + " has a position or displacement that is " +
                                "not finite.");
  references_[i.value] = {x, half_skin >= d ? half_skin : steps_of_fast_node * d};
}

std::vector<NodeIndex> CandidateList::nodes_out_of_reach(const Network &network,
                                                         std::span<const Vec3> displacement) const
{
  const std::span<const NodeIndex> nodes = network.nodes();
  std::vector<std::vector<NodeIndex>> found(static_cast<std::size_t>(omp_get_max_threads()));
#pragma omp parallel if (nodes.size() > least_for_threads)
  {
    std::vector<NodeIndex> &mine = found[static_cast<std::size_t>(omp_get_thread_num())];
#pragma omp for schedule(static)
    for (std::size_t k = 0; k < nodes.size(); ++k)
    {
      const NodeIndex i = nodes[k];
      const Reference &reference = references_[i.value];
      const double limit = reference.allowance * reference.allowance;
      Vec3 now = network.position(i) - reference.position, then = now;
      if (i.value < displacement.size())
        then += displacement[i.value];
      if (now.squaredNorm() <= limit && then.squaredNorm() <= limit)
        continue;
      now = network.minimum_image(now); // somebody may have moved the node to another image
      then = network.minimum_image(then);
      if (!(now.squaredNorm() <= limit && then.squaredNorm() <= limit))
        mine.push_back(i);
    }
  }
  return joined(found);
}

std::array<Sphere, 2> CandidateList::spheres_of(const Network &network, SegmentIndex s) const
{
  const Reference &a = references_[network.start(s).value], &b = references_[network.end(s).value];
  Vec3 d = b.position - a.position;
  if (!period_.isZero())
    d = network.minimum_image(d);
  const double radius = (0.25 * d.norm() + std::max(a.allowance, b.allowance)) * (1 + rounding);
  return {{{a.position + 0.25 * d, radius, s}, {a.position + 0.75 * d, radius, s}}};
}

void CandidateList::rebuild(const Network &network, std::span<const Vec3> displacement, double radius, bool expired)
{
  ++statistics_.builds;
  period_ = network.period();
  n_cleans_ = network.n_cleans();
  n_live_ = network.n_segments();
  radius_ = -1; // outdated until all is well
  const std::span<const NodeIndex> nodes = network.nodes();
  const std::span<const SegmentIndex> segments = network.segments();
  const double usual_displacement =
      usual_maximum(nodes.size(), [&](std::size_t k) { return norm_of(displacement, nodes[k]); });
  const double reach =
      radius + 0.5 * usual_maximum(segments.size(), [&](std::size_t k) { return network.length(segments[k]); });
  if (steps_of_build_ > 0)
    tuner_.retire(steps_of_build_, n_entered_, expired, usual_displacement);
  steps_of_build_ = 1;
  statistics_.skin = tuner_.choose(usual_displacement, reach);

  references_.resize(network.node_capacity());
  network.for_each_node([&](NodeIndex i) { set_reference(network, i, displacement); });
  radius_ = radius;
  number_.assign(network.segment_capacity(), 0);
  n_entered_ = 0;
  const std::vector<SegmentIndex> unusual = fill_grid(network);
  inserted_.reset(map_);
  in_step_.reset(map_);
  find_pairs_of_grid(network);
  enter(network, unusual);
}

std::vector<SegmentIndex> CandidateList::fill_grid(const Network &network)
{
  const std::span<const SegmentIndex> segments = network.segments();
  std::vector<Sphere> spheres(2 * segments.size());
#pragma omp parallel for schedule(static) if (segments.size() > least_for_threads)
  for (std::size_t k = 0; k < segments.size(); ++k)
  {
    const std::array<Sphere, 2> both = spheres_of(network, segments[k]);
    spheres[2 * k] = both[0];
    spheres[2 * k + 1] = both[1];
  }
  double limit = usual_maximum(segments.size(), [&](std::size_t k) { return spheres[2 * k].radius; }), largest = 0;
  Vec3 lower = spheres.empty() ? Vec3(Vec3::Zero()) : spheres[0].centre, upper = lower;
  for (const Sphere &s : spheres)
  {
    lower = lower.cwiseMin(s.centre);
    upper = upper.cwiseMax(s.centre);
    largest = std::max(largest, s.radius);
  }
  std::vector<SegmentIndex> unusual;
  if (largest <= 1.25 * limit)
    limit = largest;
  else
  {
    for (std::size_t k = 0; k < spheres.size(); k += 2)
      if (spheres[k].radius > limit)
        unusual.push_back(spheres[k].segment);
    std::erase_if(spheres, [limit](const Sphere &s) { return s.radius > limit; });
  }
  map_ = CellMap(lower, upper, period_, (2 * limit + radius_) * (1 + 1e-6));
  grid_.build(spheres, map_);
  return unusual;
}

void CandidateList::find_pairs_of_grid(const Network &network)
{
  std::vector<std::vector<CandidatePair>> found(static_cast<std::size_t>(omp_get_max_threads()));
  SkinTuner::Build build;
  build.n_segments = static_cast<double>(network.n_segments());
  build.skin = statistics_.skin;
  build.reach = grid_.largest_distance(radius_) - statistics_.skin;
  std::size_t tests = 0;
#pragma omp parallel reduction(+ : tests) if (grid_.size() > least_for_threads)
  {
    std::vector<CandidatePair> &mine = found[static_cast<std::size_t>(omp_get_thread_num())];
    std::array<std::size_t, SkinTuner::n_bins> bins{};
    SphereGrid::Memory memory;
    const auto accept = [&](std::uint32_t i, std::uint32_t j)
    {
      const SegmentIndex a = grid_.segment(i), b = grid_.segment(j);
      if (a == b || common_node(network, a, b))
        return;
      const double gap = grid_.nearest_gap(i, j);
      if (std::isnan(gap))
        return;
      mine.push_back(ordered(network, a, b));
      const double missing = (gap - radius_) / build.skin + 1; // the skin that the pair needs, in parts of this one
      ++bins[static_cast<std::size_t>(std::clamp(missing, 0.0, 0.999) * SkinTuner::n_bins)];
    };
#pragma omp for schedule(dynamic, 64)
    for (std::size_t block = 0; block < grid_.n_blocks(); ++block)
      tests += grid_.pairs_of_block(block, radius_, memory, accept);
#pragma omp critical(ddfem_candidate_bins)
    for (std::size_t k = 0; k < bins.size(); ++k)
      build.pairs[k] += bins[k];
  }
  pairs_ = merged(network, found);
  build.sphere_tests = static_cast<double>(tests);
  tuner_.record(build);
  statistics_.sphere_tests += tests;
}

std::vector<CandidatePair> CandidateList::pairs_of_inserted(const Network &network, SegmentIndex s, std::uint32_t first,
                                                            std::size_t &tests) const
{
  std::vector<SegmentIndex> others;
  SphereGrid::Memory memory;
  const auto take = [&](SegmentIndex t, std::uint32_t number)
  {
    // Of two segments entered together, the later one finds the other.
    if (is_current(network, t, number) && (number < first || number < number_[s.value]) && !common_node(network, s, t))
      others.push_back(t);
  };
  for (const Sphere &sphere : spheres_of(network, s))
  {
    tests +=
        grid_.near(sphere.centre, sphere.radius + radius_, memory, [&](std::uint32_t i) { take(grid_.segment(i), 0); });
    tests += inserted_.near(sphere.centre, sphere.radius + radius_, take);
  }
  remove_duplicates(others, 0);
  std::vector<CandidatePair> pairs;
  pairs.reserve(others.size());
  for (const SegmentIndex t : others)
    pairs.push_back(ordered(network, s, t));
  return pairs;
}

void CandidateList::enter(const Network &network, const std::vector<SegmentIndex> &segments)
{
  const std::uint32_t first = n_entered_ + 1;
  for (const SegmentIndex s : segments)
  {
    number_[s.value] = ++n_entered_;
    for (const Sphere &sphere : spheres_of(network, s))
      inserted_.add(sphere, n_entered_);
  }
  const auto is_void = [&](SegmentIndex s) { return !network.contains(s) || number_[s.value] >= first; };
  std::erase_if(pairs_, [&](const CandidatePair &p) { return is_void(p.first) || is_void(p.second); });
  std::vector<std::vector<CandidatePair>> found(static_cast<std::size_t>(omp_get_max_threads()));
  std::size_t tests = 0;
#pragma omp parallel for schedule(static) reduction(+ : tests) if (segments.size() > least_entered_for_threads)
  for (std::size_t k = 0; k < segments.size(); ++k)
  {
    std::vector<CandidatePair> &mine = found[static_cast<std::size_t>(omp_get_thread_num())];
    const std::vector<CandidatePair> pairs = pairs_of_inserted(network, segments[k], first, tests);
    mine.insert(mine.end(), pairs.begin(), pairs.end());
  }
  const std::vector<CandidatePair> fresh = merged(network, found);
  const auto middle = static_cast<std::ptrdiff_t>(pairs_.size());
  pairs_.insert(pairs_.end(), fresh.begin(), fresh.end());
  std::inplace_merge(pairs_.begin(), pairs_.begin() + middle, pairs_.end(), ById{network});
  statistics_.insertions += segments.size();
  statistics_.sphere_tests += tests;
}

void CandidateList::neighbours(const Network &network, const Vec3 &centre, double ball_radius, double radius,
                               std::vector<SegmentIndex> &found) const
{
  const auto old_size = static_cast<std::ptrdiff_t>(found.size());
  const double reach = (ball_radius + radius) * (1 + rounding);
  const auto take = [&](SegmentIndex s, std::uint32_t number)
  {
    if (is_current(network, s, number))
      found.push_back(s);
  };
  SphereGrid::Memory memory;
  grid_.near(centre, reach, memory, [&](std::uint32_t i) { take(grid_.segment(i), 0); });
  inserted_.near(centre, reach, take);
  in_step_.near(centre, reach,
                [&](SegmentIndex s, std::uint32_t)
                {
                  if (network.contains(s))
                    found.push_back(s);
                });
  remove_duplicates(found, old_size);
}

void CandidateList::insert_in_step(const Network &, SegmentIndex s, const Vec3 &centre, double ball_radius)
{
  in_step_.add({centre, ball_radius * (1 + rounding), s}, 0);
}
} // namespace ddfem
