#include "dd/fmm/multipole_sum.h"

#include "dd/common/parallel.h"
#include "dd/common/stopwatch.h"
#include "dd/fmm/accuracy.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace ddfem::fmm
{
namespace
{
TreeSettings tree_settings(const MultipoleSettings &settings, const int order, const double smallest_box,
                           const int n_antiderivatives)
{
  TreeSettings s;
  const auto cost = [&](const double distance)
  {
    return n_antiderivatives > 0
               ? half_line_translation_cost(order, order_at_distance(order - n_antiderivatives, distance))
               : translation_cost(order_at_distance(order, distance));
  };
  for (int distance2 = 0; distance2 <= 27; ++distance2)
    s.translation_cost.push_back(settings.translation_cost_factor * cost(std::sqrt(distance2)));
  if (n_antiderivatives == 0)
    s.longest_line = longest_line(settings.tolerance);
  s.smallest_box = smallest_box;
  s.depth = settings.depth;
  return s;
}

/// Order with which the nearest of distant boxes have the error that cubes have at @p order.
int order_for_shape(const int order, const Vec3 &edges)
{
  return order_at_distance(order, distance_in_cubes(Vec3(2 * edges.minCoeff(), 0, 0), edges));
}

/// Of the moments. Integration lowers the degree, and one more keeps the error that others have (measured).
int order_of(const MultipoleSettings &settings, const int n_antiderivatives)
{
  const int order = settings.order > 0 ? settings.order : expansion_order(settings.tolerance);
  return std::min(order + (n_antiderivatives > 0 ? n_antiderivatives + 1 : 0), max_order);
}
} // namespace

double best_lines_per_leaf(const MultipoleSettings &settings, const std::size_t n_lines, const std::size_t n_points)
{
  if (settings.depth > 0)
    return 0;
  const double points_per_line =
      static_cast<double>(std::max<std::size_t>(n_points, 1)) / static_cast<double>(std::max<std::size_t>(n_lines, 1));
  // 27 n p evaluations for each line, with p points in each of n, and 189 / n translations.
  const double cost = translation_cost(order_at_distance(order_of(settings, 0), std::sqrt(8.0)));
  return std::sqrt(189.0 / 27.0 * settings.translation_cost_factor * cost / points_per_line);
}

MultipoleSum::MultipoleSum(const MultipoleSettings &given, const RootGrid &grid,
                           const std::span<const SourceExtent> sources, const std::span<const Vec3> points,
                           const double smallest_box, const std::size_t n_values, const int n_antiderivatives_)
    : settings(given), n_antiderivatives(n_antiderivatives_), order_of_cubes(order_of(given, n_antiderivatives_)),
      expansion_order_(given.order > 0 ? order_of_cubes : order_for_shape(order_of_cubes, grid.edges)),
      tree(grid, sources, points, tree_settings(given, expansion_order_, smallest_box, n_antiderivatives_)),
      values(n_values)
{
  place_points(points);
  for (std::uint32_t i = 0; i < tree.boxes().size(); ++i)
    if (tree.boxes()[i].is_leaf() && tree.boxes()[i].n_points() > 0)
      leaves.push_back(i);
  std::sort(leaves.begin(), leaves.end(),
            [&](std::uint32_t a, std::uint32_t b)
            { return tree.boxes()[a].points_begin < tree.boxes()[b].points_begin; });
  passes = make_far_passes(tree, grid, {expansion_order_, order_of_cubes, n_antiderivatives},
                           single_precision() && n_antiderivatives == 0);
}

void MultipoleSum::place_points(const std::span<const Vec3> points)
{
  for (std::size_t c = 0; c < 3; ++c)
  {
    x[c].clear();
    x[c].reserve(points.size());
    for (const std::uint32_t i : tree.point_order())
      x[c].push_back(points[i][static_cast<int>(c)]);
  }
}

void MultipoleSum::move(const std::span<const SourceExtent> sources, const std::span<const std::uint32_t> box_of_source,
                        const std::span<const Vec3> points, const std::span<const std::uint32_t> leaf_of_point)
{
  tree.move(sources, box_of_source, leaf_of_point);
  place_points(points);
}

std::vector<std::size_t> MultipoleSum::points_of_leaves(const std::size_t stride) const
{
  std::vector<std::size_t> points;
  for (std::size_t k = 0; k < leaves.size(); k += stride)
    for (const Box &leaf = tree.boxes()[leaves[k]];
         const std::uint32_t i : std::span(tree.point_order()).subspan(leaf.points_begin, leaf.n_points()))
      points.push_back(i);
  return points;
}

std::vector<Vec3> MultipoleSum::points() const
{
  std::vector<Vec3> result(tree.point_order().size());
  for (std::size_t k = 0; k < result.size(); ++k)
    result[tree.point_order()[k]] = {x[0][k], x[1][k], x[2][k]};
  return result;
}

LeafWork MultipoleSum::work(const std::size_t leaf) const
{
  const auto n_points = static_cast<double>(tree.boxes()[leaf].n_points());
  LeafWork sum{0, n_points, 0};
  for (std::size_t i = leaf;; i = tree.boxes()[i].parent)
  {
    const Box &box = tree.boxes()[i];
    const double part = n_points / static_cast<double>(box.n_points());
    sum.translations += part * static_cast<double>(tree.n_far_links(i));
    if (box.level == 0)
      break;
  }
  sum.translations *= 0.4 * translation_cost(expansion_order_);
  tree.for_each_near_link(leaf, [&](const NearLink &, const std::uint32_t begin, const std::uint32_t end)
                          { sum.pairs += n_points * static_cast<double>(end - begin); });
  return sum;
}

UnitCosts MultipoleSum::unit_costs(MPI_Comm comm)
{
  const ThreadStopwatch watch(seconds.waiting);
  return settings.costs ? settings.costs->unit_costs(comm) : UnitCosts{};
}

void MultipoleSum::choose_share(MPI_Comm comm)
{
  const Rank rank = rank_of(comm);
  std::vector<double> until(leaves.size() + 1, 0.0);
  if (rank.n > 1)
  {
    const UnitCosts each = unit_costs(comm);
#pragma omp parallel for schedule(static)
    for (std::size_t k = 0; k < leaves.size(); ++k)
      until[k + 1] = each.of(work(leaves[k]));
    std::partial_sum(until.begin(), until.end(), until.begin());
  }
  share.clear();
  for (int r = 0; r <= rank.n; ++r)
  {
    const double limit = until.back() * r / rank.n;
    share.push_back(static_cast<std::size_t>(std::lower_bound(until.begin(), until.end(), limit) - until.begin()));
  }
  share.back() = leaves.size();
  first_leaf = share[static_cast<std::size_t>(rank.mine)];
  last_leaf = share[static_cast<std::size_t>(rank.mine) + 1];
  wanted.assign(tree.boxes().size(), 0);
  for (const std::uint32_t leaf : own_leaves())
    for (std::size_t i = leaf; wanted[i] == 0; i = tree.boxes()[i].parent)
      wanted[i] = 1;
  exchange = MomentExchange(tree, point_shares(), wanted, comm);
  seconds.waiting += exchange.seconds_waited();
}

void MultipoleSum::learn_costs(const std::span<const double> further_seconds)
{
  if (!settings.costs || share.size() <= 2) // one rank has nothing to divide
    return;
  const double translations = seconds.translations + seconds.downward + seconds.points;
  double n_translations = 0;
  for (const std::uint32_t leaf : own_leaves())
    n_translations += work(leaf).translations;
  settings.costs->begin_evaluation(n_translations, translations - std::exchange(seconds_learnt, translations));
  for (std::size_t k = 0; k < own_leaves().size(); k += WorkCosts::stride_of_leaves)
    settings.costs->add_leaf(work(own_leaves()[k]), leaf_seconds[k] + further_seconds[k]);
}

void MultipoleSum::far_passes(const LocalExpansions local)
{
  const double waited_before = exchange.seconds_waited();
  {
    const Stopwatch watch(seconds.upward);
    passes->upward(exchange, [this](const Box &box, const ExpansionView &moments) { add_own_moments(box, moments); });
  }
  const double waited = exchange.seconds_waited() - waited_before;
  seconds.upward -= waited;
  seconds.waiting += waited;
  FarPasses::Descent descent{wanted,
                             distant_level(),
                             [this](const Box &box, const ExpansionView &expansion) { add_distant(box, expansion); },
                             {}};
  if (local == LocalExpansions::used_once)
    descent.use_in_leaf = [this](const Box &leaf, const ExpansionView &expansion)
    {
      if (leaf.n_points() > 0)
        add_far(leaf, expansion.fields, expansion.q);
    };
  const FarPasses::DescentTimes times = passes->downward(descent);
  seconds.translations += times.translations;
  seconds.downward += times.downward;
  seconds.points += times.leaves;
}

void MultipoleSum::start_values()
{
  for (std::vector<double> &v : values)
    v.assign(tree.point_order().size(), 0.0);
  leaf_seconds.assign(own_leaves().size(), 0.0);
}

void MultipoleSum::add_kept_of(const std::size_t leaf, const double ahead)
{
  RowBuffer fields(n_harmonics(expansion_order_));
  std::vector<double> q(fields.size(), 0.0);
  passes->copy_local(leaf, ahead, {fields.rows(), q.data()});
  add_far(tree.boxes()[leaf], fields.rows(), q.data());
}

/// Calls add(number in the share, leaf) for every @p stride -th leaf, those of this rank.
template <class Add> void MultipoleSum::for_each_leaf_of_share(const std::size_t stride, Add &&add)
{
  const std::size_t first = (first_leaf + stride - 1) / stride * stride;
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t k = first; k < last_leaf; k += stride)
    if (tree.boxes()[leaves[k]].n_points() > 0)
      add(k - first_leaf, leaves[k]);
}

void MultipoleSum::compute(MPI_Comm comm, const Part part, const Recipient recipient, const LocalExpansions local)
{
  choose_share(comm);
  if (local == LocalExpansions::kept)
  {
    if (part != Part::near)
      far_passes(local);
    return evaluate(comm, {.part = part, .recipient = recipient});
  }
  start_values();
  if (part != Part::near)
    far_passes(local);
  if (part != Part::far)
    add_near_of_share(1);
  if (recipient == Recipient::every_rank)
    gather(comm);
}

void MultipoleSum::compute_again(MPI_Comm comm)
{
  passes->swap_local();
  far_passes(LocalExpansions::kept);
  evaluate(comm, {});
}

void MultipoleSum::compute_earlier()
{
  passes->swap_local();
  far_passes(LocalExpansions::kept);
  passes->swap_local();
}

void MultipoleSum::evaluate(MPI_Comm comm, const KeptExpansions &use)
{
  start_values();
  if (use.part != Part::near)
  {
    if (!passes->has_local())
      throw std::logic_error("MultipoleSum: no local expansions have been kept");
    const Stopwatch watch(seconds.points);
    for_each_leaf_of_share(use.stride, [&](std::size_t, const std::size_t leaf) { add_kept_of(leaf, use.ahead); });
  }
  if (use.part != Part::far)
    add_near_of_share(use.stride);
  if (use.recipient == Recipient::every_rank)
    gather(comm);
}

std::vector<std::size_t> MultipoleSum::point_shares() const
{
  std::vector<std::size_t> begin;
  for (const std::size_t leaf : share)
    begin.push_back(leaf < leaves.size() ? tree.boxes()[leaves[leaf]].points_begin : tree.point_order().size());
  return begin;
}

std::span<const std::uint32_t> MultipoleSum::points_with_values(const Recipient recipient) const
{
  const std::span<const std::uint32_t> all = tree.point_order();
  if (recipient == Recipient::every_rank)
    return all;
  if (own_leaves().empty())
    return all.first(0);
  const std::size_t begin = tree.boxes()[own_leaves().front()].points_begin;
  return all.subspan(begin, tree.boxes()[own_leaves().back()].points_end - begin);
}

void MultipoleSum::add_near_of_share(const std::size_t stride)
{
  const Stopwatch watch(seconds.near);
  for_each_leaf_of_share(stride, [this](const std::size_t k, const std::size_t leaf)
                         { WorkCosts::measure(k, leaf_seconds[k], [&] { add_near(leaf); }); });
}

void MultipoleSum::gather(MPI_Comm comm)
{
  for (std::vector<double> &v : values)
    gather_parts(v, point_shares(), comm);
}
} // namespace ddfem::fmm
