#include "dd/fmm/far_passes.h"

#include "dd/common/stopwatch.h"
#include "dd/fmm/box_expansions.h"
#include "dd/fmm/far_translations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

namespace ddfem::fmm
{
namespace
{
/// Boxes whose translations are sorted by direction together.
constexpr std::uint32_t boxes_per_chunk = 64;

template <class Scalar> class Passes final : public FarPasses
{
public:
  Passes(const Octree &tree_, const RootGrid &grid, const ExpansionOrders &orders_)
      : tree(tree_), orders(orders_), across(tree_, grid, orders_)
  {
    const Vec3 edges = grid.edges / grid.edges.maxCoeff();
    for (int k = 0; k < 8; ++k)
    {
      const auto side = [k](int axis) { return (k >> axis & 1) != 0 ? 0.25 : -0.25; };
      const Vec3 to_child_centre = edges.cwiseProduct(Vec3(side(0), side(1), side(2)));
      to_parent.emplace_back(Shift::child_to_parent, orders.multipole, to_child_centre);
      to_child.emplace_back(Shift::parent_to_child, orders.multipole, to_child_centre);
    }
  }

  void upward(MomentExchange &exchange, const AddToBox &add_own_moments) override
  {
    make_room(exchange.held(tree));
    const auto unpack = [this](const std::size_t box, const std::byte *from)
    { multipole[tree.boxes()[box].level].unpack(place_of_moments[box], from); };
    for (std::size_t level = n_levels(); level-- > 0;)
    {
      // Boxes that need children of other ranks come second, when these have had time to arrive.
      const auto add = [&](const bool with_others)
      {
#pragma omp parallel for schedule(dynamic, 8)
        for (std::size_t i = tree.levels()[level]; i < tree.levels()[level + 1]; ++i)
          if (exchange.is_own(i) && exchange.needs_others(tree, tree.boxes()[i]) == with_others)
            moments_of(i, add_own_moments);
      };
      add(false);
      exchange.finish(unpack);
      add(true);
      exchange.start(level, multipole[level].n_bytes(),
                     [&](const std::size_t box, std::byte *to) { multipole[level].pack(place_of_moments[box], to); });
    }
    exchange.finish(unpack);
  }

  DescentTimes downward(const Descent &descent) override
  {
    DescentTimes sum;
    const bool keeps = !descent.use_in_leaf;
    local.resize(n_levels());
    place.resize(tree.boxes().size());
    for (std::size_t level = 0; level < n_levels(); ++level)
    {
      const std::uint32_t begin = tree.levels()[level], end = tree.levels()[level + 1];
      local[level].reset(number_places(level, keeps), orders.multipole);
#pragma omp parallel
      {
        Chunk chunk{};
        DescentTimes times;
#pragma omp for schedule(dynamic, 1)
        for (std::uint32_t b = begin; b < end; b += boxes_per_chunk)
        {
          chunk.begin = b;
          chunk.end = std::min(b + boxes_per_chunk, end);
          chunk.level = level;
          descend_to(chunk, descent, times);
        }
#pragma omp critical
        sum += times;
      }
      multipole[level] = {};
      if (!keeps && level > 0)
        local[level - 1] = {};
    }
    if (!keeps)
      local.clear();
    return sum;
  }

  bool has_local() const override
  {
    return !local.empty();
  }

  void copy_local(const std::size_t box, const double ahead, const ExpansionView &result) const override
  {
    const bool extrapolated = ahead != 0 && !earlier.empty();
    const std::size_t level = tree.boxes()[box].level;
    local[level].add_to(result, place[box], extrapolated ? 1 + ahead : 1);
    if (extrapolated)
      earlier[level].add_to(result, place[box], -ahead);
  }

  void swap_local() override
  {
    std::swap(local, earlier);
  }

private:
  using Row = typename Precision<Scalar>::Narrow::Row;
  using WideRow = typename Precision<Scalar>::Wide::Row;
  static constexpr std::size_t wide = row_size / sizeof(Scalar); ///< numbers in a wide row

  /// Boxes [begin, end) of one level, the unit of work of a thread, and their local coefficients.
  struct Chunk
  {
    std::uint32_t begin, end;
    std::size_t level;
    Expansions<Scalar> local;
  };
  struct Task
  {
    std::uint32_t translation;
    std::uint32_t target, source; ///< from the first box of the chunk on, and place of the moments
  };

  std::size_t n_levels() const
  {
    return tree.levels().size() - 1;
  }
  BoxExpansion<Scalar> moments(const std::size_t box)
  {
    return multipole[tree.boxes()[box].level].of(place_of_moments[box]);
  }

  /// For the moments of the boxes with held[box] != 0, level by level.
  void make_room(std::span<const std::uint8_t> held)
  {
    multipole.resize(n_levels());
    place_of_moments.assign(held.size(), 0);
    for (std::size_t level = 0; level < n_levels(); ++level)
    {
      std::uint32_t n = 0;
      for (std::size_t i = tree.levels()[level]; i < tree.levels()[level + 1]; ++i)
        place_of_moments[i] = held[i] != 0 ? n++ : none;
      multipole[level].reset(n, orders.multipole);
    }
  }

  /// Gives a place among the kept local coefficients of a level to all boxes, or to those with children only.
  std::size_t number_places(const std::size_t level, const bool all)
  {
    std::uint32_t n = 0;
    for (std::size_t i = tree.levels()[level]; i < tree.levels()[level + 1]; ++i)
      place[i] = all || !tree.boxes()[i].is_leaf() ? n++ : none;
    return n;
  }

  /// Local coefficients of a chunk; those of its parents are complete.
  void descend_to(Chunk &chunk, const Descent &descent, DescentTimes &times)
  {
    chunk.local.reset(chunk.end - chunk.begin, orders.multipole);
    {
      const ThreadStopwatch watch(times.translations);
      translate_to(chunk, descent.wanted);
    }
    {
      const ThreadStopwatch watch(times.downward);
      for (std::uint32_t i = chunk.begin; i < chunk.end; ++i)
        if (descent.wanted[i] != 0)
          pass_down_to(chunk, i, descent);
    }
    if (!descent.use_in_leaf)
      return;
    const ThreadStopwatch watch(times.leaves);
    for (std::uint32_t i = chunk.begin; i < chunk.end; ++i)
      if (descent.wanted[i] != 0 && tree.boxes()[i].is_leaf())
      {
        BoxBuffer of_leaf(orders.multipole);
        chunk.local.add_to(of_leaf.view(), i - chunk.begin, 1);
        descent.use_in_leaf(tree.boxes()[i], of_leaf.view());
      }
  }

  void moments_of(const std::size_t index, const AddToBox &add_own_moments)
  {
    const Box &box = tree.boxes()[index];
    if (box.n_lines() == 0)
      return;
    if (box.own_lines_end > box.lines_begin)
    {
      BoxBuffer own(orders.multipole);
      add_own_moments(box, own.view());
      multipole[box.level].add(place_of_moments[index], own.view());
    }
    const Vec3 centre = tree.centre(box);
    for (std::size_t i = box.first_child; i < box.first_child + box.n_children; ++i)
      if (const Box &child = tree.boxes()[i]; child.n_lines() > 0)
        translate_box(to_parent[child.octant()], centre - tree.centre(child), moments(i), moments(index));
  }

  /// Fields, and Q with its new reference point; @p shift (nm) from the old one.
  void translate_box(const BasicTranslation<Scalar> &t, const Vec3 &shift, const BoxExpansion<Scalar> &source,
                     const BoxExpansion<Scalar> &target) const
  {
    const std::size_t n = n_harmonics(t.order());
    alignas(row_size) Row in[n_harmonics(max_order)];
    alignas(row_size) Row out[n_harmonics(max_order)];
    std::fill(in, in + n, Row{});
    std::fill(out, out + n, Row{});
    t.add(source.fields, target.fields);
    move_q(n, shift, source, in, 0);
    t.add(in, out);
    for (std::size_t k = 0; k < n; ++k)
      target.q[k] += out[k][0];
  }

  /// Q after a move of x0, to a column of @p rows.
  template <class AnyRow>
  static void move_q(const std::size_t n, const Vec3 &shift, const BoxExpansion<Scalar> &from, AnyRow *const rows,
                     const std::size_t column)
  {
    move_reference_point<Scalar>(n, shift, from.fields, from.q,
                                 [&](const std::size_t k, const Scalar q) { rows[k][column] = q; });
  }

  /// Of boxes [begin, end), in a fixed order.
  std::vector<Task> tasks_by_translation(const std::uint32_t begin, const std::uint32_t end,
                                         std::span<const std::uint8_t> wanted) const
  {
    std::vector<std::uint32_t> next(across.size() + 1, 0); // of the first task of each translation
    std::vector<Task> by_target;
    for (std::uint32_t i = begin; i < end; ++i)
      if (wanted[i] != 0)
        for (const FarLink &l : tree.far_links(i))
        {
          by_target.push_back({across.number(l.offset), i - begin, place_of_moments[l.box]});
          ++next[by_target.back().translation + 1];
        }
    std::partial_sum(next.begin(), next.end(), next.begin());
    std::vector<Task> tasks(by_target.size());
    for (const Task &task : by_target)
      tasks[next[task.translation]++] = task;
    return tasks;
  }

  /// Adds what distant boxes contribute.
  void translate_to(Chunk &chunk, std::span<const std::uint8_t> wanted)
  {
    const std::vector<Task> tasks = tasks_by_translation(chunk.begin, chunk.end, wanted);
    for (std::size_t first = 0, last = 0; first < tasks.size(); first = last)
    {
      while (last < tasks.size() && last - first < wide && tasks[last].translation == tasks[first].translation)
        ++last;
      const auto some = std::span(tasks).subspan(first, last - first);
      if constexpr (std::is_same_v<Scalar, double>)
        if (orders.n_antiderivatives > 0)
        {
          add_far_integrals(across.integrals(some.front().translation), some, chunk);
          continue;
        }
      add_far(across.translation(some.front().translation), some, chunk);
    }
  }

  void add_far(const BasicTranslation<Scalar> &translation, std::span<const Task> tasks, Chunk &chunk);
  void add_far_q(const BasicTranslation<Scalar> &translation, std::span<const Task> tasks, Chunk &chunk);
  void add_far_integrals(const HalfLineTranslation &translation, std::span<const Task> tasks, Chunk &chunk);

  void pass_down_to(Chunk &chunk, const std::size_t index, const Descent &descent)
  {
    const Box &box = tree.boxes()[index];
    const std::size_t i = index - chunk.begin;
    if (box.level > 0)
      translate_box(to_child[box.octant()], tree.centre(box) - tree.centre(tree.boxes()[box.parent]),
                    local[chunk.level - 1].of(place[box.parent]), chunk.local.of(i));
    if (box.level == descent.distant_level)
    {
      BoxBuffer distant(orders.multipole);
      descent.add_distant(box, distant.view());
      chunk.local.add(i, distant.view());
    }
    if (place[index] != none)
      local[chunk.level].copy(place[index], chunk.local, i);
  }

  const Octree &tree;
  ExpansionOrders orders;
  FarTranslations<Scalar> across;
  std::vector<BasicTranslation<Scalar>> to_parent, to_child;
  std::vector<Expansions<Scalar>> multipole, local; ///< by level
  std::vector<Expansions<Scalar>> earlier;          ///< local ones
  static constexpr auto none = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> place; ///< of boxes in `local`, and in `earlier`: both keep all boxes or are empty
  std::vector<std::uint32_t> place_of_moments; ///< of boxes in `multipole`
};

template <class Scalar>
void Passes<Scalar>::add_far(const BasicTranslation<Scalar> &translation, const std::span<const Task> tasks,
                             Chunk &chunk)
{
  Expansions<Scalar> &sources = multipole[chunk.level];
  std::size_t i = 0;
  for (; i + 1 < tasks.size(); i += 2)
    translation.add_two({sources.of(tasks[i].source).fields, sources.of(tasks[i + 1].source).fields},
                        {chunk.local.of(tasks[i].target).fields, chunk.local.of(tasks[i + 1].target).fields});
  if (i == tasks.size())
    return add_far_q(translation, tasks, chunk);
  if constexpr (std::is_same_v<Scalar, double>)
    translation.add(sources.of(tasks[i].source).fields, chunk.local.of(tasks[i].target).fields);
  else
  {
    // In the left half of wide rows, too: in narrow ones products may be contracted differently, and who has a neighbour depends on the rank.
    alignas(row_size) Row unused[n_harmonics(max_order)];
    std::fill(unused, unused + n_harmonics(translation.order()), Row{});
    const auto source = sources.of(tasks[i].source).fields;
    translation.add_two({source, source}, {chunk.local.of(tasks[i].target).fields, unused});
  }
  add_far_q(translation, tasks, chunk);
}

template <class Scalar>
void Passes<Scalar>::add_far_q(const BasicTranslation<Scalar> &translation, const std::span<const Task> tasks,
                               Chunk &chunk)
{
  Expansions<Scalar> &sources = multipole[chunk.level];
  const std::size_t n = n_harmonics(translation.order());
  const Vec3 shift = tree.size(tree.boxes()[chunk.begin]) * translation.vector();
  alignas(row_size) WideRow in[n_harmonics(max_order)];
  alignas(row_size) WideRow out[n_harmonics(max_order)];
  std::fill(in, in + n, WideRow{});
  std::fill(out, out + n, WideRow{});
  for (std::size_t i = 0; i < tasks.size(); ++i)
    move_q(n, shift, sources.of(tasks[i].source), in, i);
  translation.add_wide(in, out);
  for (std::size_t i = 0; i < tasks.size(); ++i)
  {
    Scalar *const q = chunk.local.of(tasks[i].target).q;
    for (std::size_t k = 0; k < n; ++k)
      q[k] += out[k][i];
  }
}

template <>
void Passes<double>::add_far_integrals(const HalfLineTranslation &translation, const std::span<const Task> tasks,
                                       Chunk &chunk)
{
  const std::size_t n_in = n_harmonics(translation.source_order()), n_out = n_harmonics(translation.target_order());
  const double size = tree.size(tree.boxes()[chunk.begin]), unit = std::pow(size, orders.n_antiderivatives);
  const Vec3 shift = size * translation.vector();
  alignas(row_size) Row in[n_harmonics(max_order)];
  alignas(row_size) Row out[n_harmonics(max_order)];
  for (std::size_t first = 0; first < tasks.size(); first += 2) // P and Q of two boxes side by side
  {
    const auto pair = tasks.subspan(first, std::min<std::size_t>(2, tasks.size() - first));
    std::fill(in, in + n_in, Row{});
    std::fill(out, out + n_out, Row{});
    for (std::size_t i = 0; i < pair.size(); ++i)
    {
      const BoxExpansion<double> source = multipole[chunk.level].of(pair[i].source);
      move_q(n_in, shift, source, in, 4 * i + 3);
      for (std::size_t k = 0; k < n_in; ++k)
        for (std::size_t c = 0; c < 3; ++c)
          in[k][4 * i + c] = source.fields[k][c];
    }
    translation.add(in, out);
    // The logarithm of the size is a translation of all points; it must be the same on all levels.
    for (const int m : {1, -1})
      out[harmonic_index(1, m)] += 0.5 * std::log(size) * in[harmonic_index(1, m)];
    for (std::size_t i = 0; i < pair.size(); ++i)
    {
      const BoxExpansion<double> target = chunk.local.of(pair[i].target);
      for (std::size_t k = 0; k < n_out; ++k)
      {
        for (std::size_t c = 0; c < 3; ++c)
          target.fields[k][c] += unit * out[k][4 * i + c];
        target.q[k] += unit * out[k][4 * i + 3];
      }
    }
  }
}
} // namespace

std::unique_ptr<FarPasses> make_far_passes(const Octree &tree, const RootGrid &grid, const ExpansionOrders &orders,
                                           const bool single_precision)
{
  if (single_precision)
    return std::make_unique<Passes<float>>(tree, grid, orders);
  return std::make_unique<Passes<double>>(tree, grid, orders);
}
} // namespace ddfem::fmm
