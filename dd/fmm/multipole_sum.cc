#include "dd/fmm/multipole_sum.h"

#include "dd/fmm/accuracy.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

namespace ddfem::fmm
{
namespace
{
/// Boxes whose translations are sorted by direction together; the unit of work of a thread.
constexpr std::uint32_t boxes_per_chunk = 64;

/// Adds the processor time of a scope to a phase.
class Stopwatch
{
public:
  explicit Stopwatch(double &phase_) : phase(phase_) {}
  Stopwatch(const Stopwatch &) = delete;
  Stopwatch &operator=(const Stopwatch &) = delete;
  ~Stopwatch() { phase += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC; }

private:
  double &phase;
  std::clock_t start = std::clock();
};

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
  return s;
}

/// Of the moments. Integration lowers the degree, and one more keeps the error that others have (measured).
int order_of(const MultipoleSettings &settings, const int n_antiderivatives)
{
  const int order = settings.order > 0 ? settings.order : expansion_order(settings.tolerance);
  return std::min(order + (n_antiderivatives > 0 ? n_antiderivatives + 1 : 0), max_order);
}

/// Translates one box: fields, and Q with its new reference point; @p shift (nm) from the old one.
void translate_box(const Translation &t, const Vec3 &shift, const Row *fields, const double *q,
                   const ExpansionView &target)
{
  const std::size_t n = n_harmonics(t.order());
  t.add(fields, target.fields);
  RowBuffer in(n), out(n);
  std::vector<double> moved(n);
  move_reference_point(n, shift, fields, q, moved.data());
  for (std::size_t k = 0; k < n; ++k)
    in(k, 0) = moved[k];
  t.add(in.rows(), out.rows());
  for (std::size_t k = 0; k < n; ++k)
    target.q[k] += out(k, 0);
}

std::size_t octant_of(const Box &box)
{
  const int octant = (box.place[0] & 1) + 2 * (box.place[1] & 1) + 4 * (box.place[2] & 1);
  return static_cast<std::size_t>(octant);
}
} // namespace

MultipoleSum::MultipoleSum(const MultipoleSettings &given, const RootGrid &grid,
                           const std::span<const SourceExtent> sources, const std::span<const Vec3> points,
                           const double smallest_box, const std::size_t n_values, const int n_antiderivatives_)
    : settings(given), n_antiderivatives(n_antiderivatives_), expansion_order_(order_of(given, n_antiderivatives_)),
      tree(grid, sources, points, tree_settings(given, expansion_order_, smallest_box, n_antiderivatives_)),
      values(n_values), multipole(0, 0), local(0, 0)
{
  for (std::size_t c = 0; c < 3; ++c)
    for (const std::uint32_t i : tree.point_order())
      x[c].push_back(points[i][static_cast<int>(c)]);
  for (std::uint32_t i = 0; i < tree.boxes().size(); ++i)
    if (tree.boxes()[i].is_leaf() && tree.boxes()[i].n_points() > 0)
      leaves.push_back(i);
  std::sort(leaves.begin(), leaves.end(),
            [&](std::uint32_t a, std::uint32_t b)
            { return tree.boxes()[a].points_begin < tree.boxes()[b].points_begin; });
  make_translations(grid);
}

void MultipoleSum::make_translations(const RootGrid &grid)
{
  const Vec3 edges = grid.edges / grid.edges.maxCoeff();
  for (int k = 0; k < 8; ++k)
  {
    const auto side = [k](int axis) { return (k >> axis & 1) != 0 ? 0.25 : -0.25; };
    const Vec3 to_child_centre = edges.cwiseProduct(Vec3(side(0), side(1), side(2)));
    to_parent.emplace_back(Shift::child_to_parent, expansion_order_, to_child_centre);
    to_child.emplace_back(Shift::parent_to_child, expansion_order_, to_child_centre);
  }
  for (std::size_t root = 0; root < tree.levels()[1]; ++root)
    for (const FarLink &l : tree.far_links(root))
      for (const std::int16_t o : l.offset)
        largest_offset = std::max(largest_offset, std::abs(o));
  std::uint32_t n_translations = 0;
  const int n = 2 * largest_offset + 1, volume = n * n * n;
  far_number.assign(static_cast<std::size_t>(volume), std::numeric_limits<std::uint32_t>::max());
  for (std::size_t box = 0; box < tree.boxes().size(); ++box)
    for (const FarLink &l : tree.far_links(box))
    {
      const int k =
          ((l.offset[0] + largest_offset) * n + l.offset[1] + largest_offset) * n + l.offset[2] + largest_offset;
      std::uint32_t &number = far_number[static_cast<std::size_t>(k)];
      if (number != std::numeric_limits<std::uint32_t>::max())
        continue;
      number = n_translations++;
      add_far_translation(-edges.cwiseProduct(Vec3(l.offset[0], l.offset[1], l.offset[2])));
    }
}

void MultipoleSum::add_far_translation(const Vec3 &shift)
{
  if (n_antiderivatives == 0)
  {
    far.emplace_back(Shift::far, order_at_distance(expansion_order_, shift.norm()), shift);
    return;
  }
  // Boxes are cubes here, and shifts whole numbers.
  const long rho_squared = std::lround(shift[0] * shift[0] + shift[1] * shift[1]), z = std::lround(shift[2]);
  const int target_order = order_at_distance(local_order(), shift.norm());
  far_integrals.emplace_back(half_line_matrices(n_antiderivatives, expansion_order_, target_order, rho_squared, z),
                             shift);
}

std::uint32_t MultipoleSum::far_translation(const std::array<std::int16_t, 3> &offset) const
{
  const int n = 2 * largest_offset + 1;
  const int k = ((offset[0] + largest_offset) * n + offset[1] + largest_offset) * n + offset[2] + largest_offset;
  return far_number[static_cast<std::size_t>(k)];
}

void MultipoleSum::compute_moments()
{
  const Stopwatch watch(seconds.upward);
  for (std::size_t level = tree.levels().size() - 1; level-- > 0;)
  {
#pragma omp parallel for schedule(dynamic, 8)
    for (std::size_t i = tree.levels()[level]; i < tree.levels()[level + 1]; ++i)
      moments_of(i);
  }
}

void MultipoleSum::moments_of(const std::size_t index)
{
  const Box &box = tree.boxes()[index];
  if (box.n_lines() == 0)
    return;
  const Vec3 centre = tree.centre(box);
  add_own_moments(box, multipole.of(index));
  for (std::size_t i = box.first_child; i < box.first_child + box.n_children; ++i)
  {
    const Box &child = tree.boxes()[i];
    if (child.n_lines() > 0)
      translate_box(to_parent[octant_of(child)], centre - tree.centre(child), multipole.fields(i), multipole.q(i),
                    multipole.of(index));
  }
}

void MultipoleSum::translate_far()
{
  const Stopwatch watch(seconds.translations);
  for (std::size_t level = 0; level + 1 < tree.levels().size(); ++level)
  {
    const std::uint32_t begin = tree.levels()[level], end = tree.levels()[level + 1];
#pragma omp parallel for schedule(dynamic, 1)
    for (std::uint32_t b = begin; b < end; b += boxes_per_chunk)
      translate_chunk(b, std::min(b + boxes_per_chunk, end));
  }
}

void MultipoleSum::translate_chunk(const std::uint32_t begin, const std::uint32_t end)
{
  std::vector<Task> tasks;
  for (std::uint32_t i = begin; i < end; ++i)
    if (wanted[i] != 0)
      for (const FarLink &l : tree.far_links(i))
        tasks.push_back({far_translation(l.offset), i, l.box});
  std::sort(tasks.begin(), tasks.end());
  for (std::size_t first = 0, last = 0; first < tasks.size(); first = last)
  {
    while (last < tasks.size() && last - first < row_width && tasks[last].translation == tasks[first].translation)
      ++last;
    const auto some = std::span(tasks).subspan(first, last - first);
    if (n_antiderivatives > 0)
      add_far_integrals(far_integrals[some.front().translation], some);
    else
      add_far(far[some.front().translation], some);
  }
}

void MultipoleSum::add_far(const Translation &translation, const std::span<const Task> tasks)
{
  for (const Task &t : tasks)
    translation.add(multipole.fields(t.source), local.of(t.target).fields);
  add_far_q(translation, tasks);
}

void MultipoleSum::add_far_integrals(const HalfLineTranslation &translation, const std::span<const Task> tasks)
{
  const std::size_t n_in = n_harmonics(translation.source_order()), n_out = n_harmonics(translation.target_order());
  const double size = tree.size(tree.boxes()[tasks[0].target]), unit = std::pow(size, n_antiderivatives);
  const Vec3 shift = size * translation.vector();
  alignas(row_size) Row in[n_harmonics(max_order)];
  alignas(row_size) Row out[n_harmonics(max_order)];
  double moved[n_harmonics(max_order)];
  for (std::size_t first = 0; first < tasks.size(); first += 2) // P and Q of two boxes side by side
  {
    const auto pair = tasks.subspan(first, std::min<std::size_t>(2, tasks.size() - first));
    std::fill(in, in + n_in, Row{});
    std::fill(out, out + n_out, Row{});
    for (std::size_t i = 0; i < pair.size(); ++i)
    {
      const Row *const fields = multipole.fields(pair[i].source);
      move_reference_point(n_in, shift, fields, multipole.q(pair[i].source), moved);
      for (std::size_t k = 0; k < n_in; ++k)
      {
        for (std::size_t c = 0; c < 3; ++c)
          in[k][4 * i + c] = fields[k][c];
        in[k][4 * i + 3] = moved[k];
      }
    }
    translation.add(in, out);
    // The logarithm of the size is a translation of all points; it must be the same on all levels.
    for (const int m : {1, -1})
      out[harmonic_index(1, m)] += 0.5 * std::log(size) * in[harmonic_index(1, m)];
    for (std::size_t i = 0; i < pair.size(); ++i)
    {
      const ExpansionView target = local.of(pair[i].target);
      for (std::size_t k = 0; k < n_out; ++k)
      {
        for (std::size_t c = 0; c < 3; ++c)
          target.fields[k][c] += unit * out[k][4 * i + c];
        target.q[k] += unit * out[k][4 * i + 3];
      }
    }
  }
}

void MultipoleSum::add_far_q(const Translation &translation, const std::span<const Task> tasks)
{
  const std::size_t n = n_harmonics(translation.order());
  const Vec3 shift = tree.size(tree.boxes()[tasks[0].target]) * translation.vector();
  alignas(row_size) Row in[n_harmonics(max_order)] = {};
  alignas(row_size) Row out[n_harmonics(max_order)];
  std::fill(out, out + n, Row{});
  double moved[n_harmonics(max_order)];
  for (std::size_t i = 0; i < tasks.size(); ++i)
  {
    move_reference_point(n, shift, multipole.fields(tasks[i].source), multipole.q(tasks[i].source), moved);
    for (std::size_t k = 0; k < n; ++k)
      in[k][i] = moved[k];
  }
  translation.add(in, out);
  for (std::size_t i = 0; i < tasks.size(); ++i)
  {
    double *const q = local.of(tasks[i].target).q;
    for (std::size_t k = 0; k < n; ++k)
      q[k] += out[k][i];
  }
}

void MultipoleSum::pass_down()
{
  const Stopwatch watch(seconds.downward);
  for (std::size_t level = 0; level + 1 < tree.levels().size(); ++level)
  {
#pragma omp parallel for schedule(dynamic, 8)
    for (std::size_t i = tree.levels()[level]; i < tree.levels()[level + 1]; ++i)
      if (wanted[i] != 0)
        pass_down_to(i);
  }
}

void MultipoleSum::pass_down_to(const std::size_t index)
{
  const Box &box = tree.boxes()[index];
  const Vec3 centre = tree.centre(box);
  if (box.level > 0)
    translate_box(to_child[octant_of(box)], centre - tree.centre(tree.boxes()[box.parent]), local.fields(box.parent),
                  local.q(box.parent), local.of(index));
  add_distant(box, local.of(index));
}

double MultipoleSum::work(const std::size_t leaf) const
{
  const auto n_points = static_cast<double>(tree.boxes()[leaf].n_points());
  double sum = translation_cost(expansion_order_);
  for (std::size_t i = leaf;; i = tree.boxes()[i].parent)
  {
    for (const NearLink &l : tree.near_links(i))
      sum += n_points * static_cast<double>(tree.boxes()[l.box].n_lines());
    const double part = n_points / static_cast<double>(tree.boxes()[i].n_points());
    sum += 0.4 * part * translation_cost(expansion_order_) * static_cast<double>(tree.far_links(i).size());
    if (tree.boxes()[i].level == 0)
      return sum;
  }
}

void MultipoleSum::choose_share(MPI_Comm comm)
{
  int initialised = 0, rank = 0, n_ranks = 1;
  MPI_Initialized(&initialised);
  if (initialised != 0)
  {
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &n_ranks);
  }
  std::vector<double> until{0.0};
  for (const std::uint32_t leaf : leaves)
    until.push_back(until.back() + work(leaf));
  share.clear();
  for (int r = 0; r <= n_ranks; ++r)
  {
    const double limit = until.back() * r / n_ranks;
    share.push_back(static_cast<std::size_t>(std::lower_bound(until.begin(), until.end(), limit) - until.begin()));
  }
  share.back() = leaves.size();
  first_leaf = share[static_cast<std::size_t>(rank)];
  last_leaf = share[static_cast<std::size_t>(rank) + 1];
  wanted.assign(tree.boxes().size(), 0);
  for (std::size_t k = first_leaf; k < last_leaf; ++k)
    for (std::size_t i = leaves[k]; wanted[i] == 0; i = tree.boxes()[i].parent)
      wanted[i] = 1;
}

void MultipoleSum::compute(MPI_Comm comm, const Part part)
{
  choose_share(comm);
  for (std::vector<double> &v : values)
    v.assign(tree.point_order().size(), 0.0);
  if (part != Part::near)
  {
    multipole = local = Expansions(tree.boxes().size(), expansion_order_);
    compute_moments();
    translate_far();
    pass_down();
    const Stopwatch watch(seconds.points);
#pragma omp parallel for schedule(dynamic, 1)
    for (std::size_t k = first_leaf; k < last_leaf; ++k)
      add_far(tree.boxes()[leaves[k]], local.fields(leaves[k]), local.q(leaves[k]));
  }
  if (part != Part::far)
  {
    const Stopwatch watch(seconds.near);
#pragma omp parallel for schedule(dynamic, 1)
    for (std::size_t k = first_leaf; k < last_leaf; ++k)
      add_near(leaves[k]);
  }
  gather(comm);
}

void MultipoleSum::gather(MPI_Comm comm)
{
  if (share.size() <= 2)
    return;
  std::vector<int> counts, offsets;
  const auto first_point = [&](std::size_t leaf)
  { return leaf < leaves.size() ? tree.boxes()[leaves[leaf]].points_begin : tree.point_order().size(); };
  for (std::size_t r = 0; r + 1 < share.size(); ++r)
  {
    offsets.push_back(static_cast<int>(first_point(share[r])));
    counts.push_back(static_cast<int>(first_point(share[r + 1]) - first_point(share[r])));
  }
  for (std::vector<double> &v : values)
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, v.data(), counts.data(), offsets.data(), MPI_DOUBLE, comm);
}
} // namespace ddfem::fmm
