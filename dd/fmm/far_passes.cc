#include "dd/fmm/far_passes.h"

#include "dd/fmm/far_translations.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

namespace ddfem::fmm
{
namespace
{
/// Boxes whose translations are sorted by direction together; the unit of work of a thread.
constexpr std::uint32_t boxes_per_chunk = 64;

/// Coefficients of one box, see ExpansionView.
template <class Scalar> struct BoxExpansion
{
  typename Precision<Scalar>::Narrow::Row *fields;
  Scalar *q;
};

/// Multipole or local coefficients of the boxes that this rank has some of.
template <class Scalar> class Expansions
{
public:
  void reset(std::span<const std::uint8_t> has, int order)
  {
    n = n_harmonics(order);
    std::size_t n_boxes = 0;
    place.assign(has.size(), 0);
    for (std::size_t box = 0; box < has.size(); ++box)
      if (has[box] != 0)
        place[box] = n * n_boxes++;
    fields.assign(n_boxes * n * row_width, Scalar{});
    q.assign(n_boxes * n, Scalar{});
  }
  BoxExpansion<Scalar> of(const std::size_t box)
  {
    using Row = typename Precision<Scalar>::Narrow::Row;
    return {reinterpret_cast<Row *>(fields.data() + place[box] * row_width), q.data() + place[box]};
  }

  /// Adds coefficients in double precision.
  void add(const std::size_t box, const ExpansionView &given)
  {
    const BoxExpansion<Scalar> sum = of(box);
    for (std::size_t k = 0; k < n; ++k)
    {
      for (std::size_t c = 0; c < row_width; ++c)
        sum.fields[k][c] += static_cast<Scalar>(given.fields[k][c]);
      sum.q[k] += static_cast<Scalar>(given.q[k]);
    }
  }
  /// Adds @p factor times the coefficients of a box to @p result.
  void add_to(const ExpansionView &result, const std::size_t box, const double factor) const
  {
    const Scalar *const of_fields = fields.data() + place[box] * row_width;
    for (std::size_t k = 0; k < n; ++k)
    {
      for (std::size_t c = 0; c < row_width; ++c)
        result.fields[k][c] += factor * static_cast<double>(of_fields[k * row_width + c]);
      result.q[k] += factor * static_cast<double>(q[place[box] + k]);
    }
  }
  bool empty() const { return q.empty(); }

  /// Of one box, as bytes.
  std::size_t n_bytes() const { return n * (row_width + 1) * sizeof(Scalar); }
  void pack(const std::size_t box, std::byte *const to) const
  {
    std::memcpy(to, fields.data() + place[box] * row_width, n * row_width * sizeof(Scalar));
    std::memcpy(to + n * row_width * sizeof(Scalar), q.data() + place[box], n * sizeof(Scalar));
  }
  void unpack(const std::size_t box, const std::byte *const from)
  {
    std::memcpy(fields.data() + place[box] * row_width, from, n * row_width * sizeof(Scalar));
    std::memcpy(q.data() + place[box], from + n * row_width * sizeof(Scalar), n * sizeof(Scalar));
  }

private:
  std::size_t n = 0;
  std::vector<std::size_t> place; ///< of the first coefficient of each box
  std::vector<Scalar, RowAllocator<Scalar>> fields;
  std::vector<Scalar> q;
};

/// Coefficients of one box in double precision, zero at first.
struct BoxBuffer
{
  RowBuffer fields;
  std::vector<double> q;

  explicit BoxBuffer(const int order) : fields(n_harmonics(order)), q(n_harmonics(order), 0.0) {}
  ExpansionView view() { return {fields.rows(), q.data()}; }
};

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
    multipole.reset(exchange.held(tree), orders.multipole);
    const auto unpack = [this](std::size_t box, const std::byte *from) { multipole.unpack(box, from); };
    for (std::size_t level = tree.levels().size() - 1; level-- > 0;)
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
      exchange.start(level, multipole.n_bytes(), [this](std::size_t box, std::byte *to) { multipole.pack(box, to); });
    }
    exchange.finish(unpack);
  }

  void translate(std::span<const std::uint8_t> wanted) override
  {
    local.reset(wanted, orders.multipole);
    for (std::size_t level = 0; level + 1 < tree.levels().size(); ++level)
    {
      const std::uint32_t begin = tree.levels()[level], end = tree.levels()[level + 1];
#pragma omp parallel for schedule(dynamic, 1)
      for (std::uint32_t b = begin; b < end; b += boxes_per_chunk)
        translate_chunk(b, std::min(b + boxes_per_chunk, end), wanted);
    }
  }

  void downward(std::span<const std::uint8_t> wanted, const int distant_level, const AddToBox &add_distant) override
  {
    for (std::size_t level = 0; level + 1 < tree.levels().size(); ++level)
    {
#pragma omp parallel for schedule(dynamic, 8)
      for (std::size_t i = tree.levels()[level]; i < tree.levels()[level + 1]; ++i)
        if (wanted[i] != 0)
          pass_down_to(i, distant_level, add_distant);
    }
  }

  void copy_local(const std::size_t box, const double ahead, const ExpansionView &result) const override
  {
    const bool extrapolated = ahead != 0 && !earlier.empty();
    local.add_to(result, box, extrapolated ? 1 + ahead : 1);
    if (extrapolated)
      earlier.add_to(result, box, -ahead);
  }

  void swap_local() override
  {
    std::swap(local, earlier);
  }

private:
  using Row = typename Precision<Scalar>::Narrow::Row;
  using WideRow = typename Precision<Scalar>::Wide::Row;
  static constexpr std::size_t wide = row_size / sizeof(Scalar); ///< numbers in a wide row

  struct Task
  {
    std::uint32_t translation, target, source;
  };

  void moments_of(const std::size_t index, const AddToBox &add_own_moments)
  {
    const Box &box = tree.boxes()[index];
    if (box.n_lines() == 0)
      return;
    if (box.own_lines_end > box.lines_begin)
    {
      BoxBuffer own(orders.multipole);
      add_own_moments(box, own.view());
      multipole.add(index, own.view());
    }
    const Vec3 centre = tree.centre(box);
    for (std::size_t i = box.first_child; i < box.first_child + box.n_children; ++i)
      if (const Box &child = tree.boxes()[i]; child.n_lines() > 0)
        translate_box(to_parent[child.octant()], centre - tree.centre(child), multipole.of(i), multipole.of(index));
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
    std::vector<std::uint32_t> place(across.size() + 1, 0); // of the first task of each translation
    const auto for_each_task = [&](auto &&visit)
    {
      for (std::uint32_t i = begin; i < end; ++i)
        if (wanted[i] != 0)
          for (const FarLink &l : tree.far_links(i))
            visit(across.number(l.offset), i, l.box);
    };
    for_each_task([&](std::uint32_t translation, std::uint32_t, std::uint32_t) { ++place[translation + 1]; });
    std::partial_sum(place.begin(), place.end(), place.begin());
    std::vector<Task> tasks(place.back());
    for_each_task(
        [&](std::uint32_t translation, std::uint32_t target, std::uint32_t source) {
          tasks[place[translation]++] = {translation, target, source};
        });
    return tasks;
  }

  void translate_chunk(const std::uint32_t begin, const std::uint32_t end, std::span<const std::uint8_t> wanted)
  {
    const std::vector<Task> tasks = tasks_by_translation(begin, end, wanted);
    for (std::size_t first = 0, last = 0; first < tasks.size(); first = last)
    {
      while (last < tasks.size() && last - first < wide && tasks[last].translation == tasks[first].translation)
        ++last;
      const auto some = std::span(tasks).subspan(first, last - first);
      if constexpr (std::is_same_v<Scalar, double>)
        if (orders.n_antiderivatives > 0)
        {
          add_far_integrals(across.integrals(some.front().translation), some);
          continue;
        }
      add_far(across.translation(some.front().translation), some);
    }
  }

  void add_far(const BasicTranslation<Scalar> &translation, std::span<const Task> tasks);
  void add_far_q(const BasicTranslation<Scalar> &translation, std::span<const Task> tasks);
  void add_far_integrals(const HalfLineTranslation &translation, std::span<const Task> tasks);

  void pass_down_to(const std::size_t index, const int distant_level, const AddToBox &add_distant)
  {
    const Box &box = tree.boxes()[index];
    if (box.level > 0)
      translate_box(to_child[box.octant()], tree.centre(box) - tree.centre(tree.boxes()[box.parent]),
                    local.of(box.parent), local.of(index));
    if (box.level == distant_level)
    {
      BoxBuffer distant(orders.multipole);
      add_distant(box, distant.view());
      local.add(index, distant.view());
    }
  }

  const Octree &tree;
  ExpansionOrders orders;
  FarTranslations<Scalar> across;
  std::vector<BasicTranslation<Scalar>> to_parent, to_child;
  Expansions<Scalar> multipole, local;
  Expansions<Scalar> earlier; ///< local ones
};

template <class Scalar>
void Passes<Scalar>::add_far(const BasicTranslation<Scalar> &translation, const std::span<const Task> tasks)
{
  std::size_t i = 0;
  for (; i + 1 < tasks.size(); i += 2)
    translation.add_two({multipole.of(tasks[i].source).fields, multipole.of(tasks[i + 1].source).fields},
                        {local.of(tasks[i].target).fields, local.of(tasks[i + 1].target).fields});
  if (i == tasks.size())
    return add_far_q(translation, tasks);
  if constexpr (std::is_same_v<Scalar, double>)
    translation.add(multipole.of(tasks[i].source).fields, local.of(tasks[i].target).fields);
  else
  {
    // In the left half of wide rows, too: in narrow ones products may be contracted differently, and who has a neighbour depends on the rank.
    alignas(row_size) Row unused[n_harmonics(max_order)];
    std::fill(unused, unused + n_harmonics(translation.order()), Row{});
    const auto source = multipole.of(tasks[i].source).fields;
    translation.add_two({source, source}, {local.of(tasks[i].target).fields, unused});
  }
  add_far_q(translation, tasks);
}

template <class Scalar>
void Passes<Scalar>::add_far_q(const BasicTranslation<Scalar> &translation, const std::span<const Task> tasks)
{
  const std::size_t n = n_harmonics(translation.order());
  const Vec3 shift = tree.size(tree.boxes()[tasks[0].target]) * translation.vector();
  alignas(row_size) WideRow in[n_harmonics(max_order)];
  alignas(row_size) WideRow out[n_harmonics(max_order)];
  std::fill(in, in + n, WideRow{});
  std::fill(out, out + n, WideRow{});
  for (std::size_t i = 0; i < tasks.size(); ++i)
    move_q(n, shift, multipole.of(tasks[i].source), in, i);
  translation.add_wide(in, out);
  for (std::size_t i = 0; i < tasks.size(); ++i)
  {
    Scalar *const q = local.of(tasks[i].target).q;
    for (std::size_t k = 0; k < n; ++k)
      q[k] += out[k][i];
  }
}

template <>
void Passes<double>::add_far_integrals(const HalfLineTranslation &translation, const std::span<const Task> tasks)
{
  const std::size_t n_in = n_harmonics(translation.source_order()), n_out = n_harmonics(translation.target_order());
  const double size = tree.size(tree.boxes()[tasks[0].target]), unit = std::pow(size, orders.n_antiderivatives);
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
      const BoxExpansion<double> source = multipole.of(pair[i].source);
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
      const BoxExpansion<double> target = local.of(pair[i].target);
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
