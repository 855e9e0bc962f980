// Fields of many sources at many points by a fast multipole method: what stress and displacement share.
#pragma once

#include "dd/fmm/far_passes.h"
#include "dd/fmm/octree.h"
#include "dd/fmm/work_costs.h"

#include <mpi.h>

#include <array>
#include <memory>
#include <vector>

namespace ddfem::fmm
{
/// Processor time of the phases on this rank, summed over its threads, s.
struct PhaseTimes
{
  double upward = 0, translations = 0, downward = 0, points = 0, near = 0;
  double waiting = 0; ///< of one thread, for other ranks
};

struct MultipoleSettings
{
  /// Requested error of the far stress, relative to its rms over the points; 1e-8 to 0.1.
  double tolerance = 1e-3;
  /// Order of the expansions; 0: from the tolerance.
  int order = 0;
  /// Factor to the assumed cost of a translation: smaller for a deeper tree.
  double translation_cost_factor = 1.0;
  /// Of all boxes with lines or points, for comparison; 0: by cost.
  int depth = 0;
  /// By which leaves are divided among ranks, see MultipoleSum::learn_costs(); null: assumed ones.
  std::shared_ptr<WorkCosts> costs = nullptr;
};

/// Number of lines in a leaf at which direct work and translations cost about the same; 0 if the depth of the tree is given.
double best_lines_per_leaf(const MultipoleSettings &settings, std::size_t n_lines, std::size_t n_points);

/// Requested error from which on single precision suffices for what is not near.
inline constexpr double single_precision_from = 1e-5;

/// What to sum: all of it, or one part, for tests and measurements.
enum class Part : std::uint8_t
{
  all,
  near,
  far
};

/// Which ranks get the values at a point.
enum class Recipient : std::uint8_t
{
  every_rank,
  owner ///< the one that computes them; elsewhere they are zero
};

/// What becomes of the local expansions.
enum class LocalExpansions : std::uint8_t
{
  used_once, ///< each given up when the field at its points is known
  kept       ///< for evaluations after move(): some 250 bytes more for each segment (docs/benchmarks.md)
};

/// How the local expansions of an earlier time are used.
struct KeptExpansions
{
  double ahead = 0;       ///< extrapolated by so many times the change before
  std::size_t stride = 1; ///< at the points of every so many leaves; zero elsewhere
  Part part = Part::all;
  Recipient recipient = Recipient::every_rank;
};

/**
 * Near pairs of boxes by closed forms, distant pairs by expansions of harmonic potentials, on an adaptive octree that is divided
 * as long as that saves work. Large sources stay in large boxes. All sums run in a fixed order: the result does not depend on the
 * number of threads and ranks.
 */
class MultipoleSum
{
public:
  virtual ~MultipoleSum() = default;
  MultipoleSum(const MultipoleSum &) = delete;
  MultipoleSum &operator=(const MultipoleSum &) = delete;

  const Octree &octree() const { return tree; }
  int order() const { return expansion_order_; }
  /// Degree of the local expansions.
  int local_order() const { return expansion_order_ - n_antiderivatives; }
  const PhaseTimes &times() const { return seconds; }
  /// Multipole coefficients sent to other ranks so far.
  std::size_t n_bytes_sent() const { return exchange.n_bytes_sent(); }
  /// Leaves that had points when the tree was made.
  std::size_t n_leaves() const { return leaves.size(); }
  /// Points of every @p stride -th leaf, in the order given.
  std::vector<std::size_t> points_of_leaves(std::size_t stride) const;
  /// In the order given, nm.
  std::vector<Vec3> points() const;

  /// First point of each rank in the tree's order, and one past the last: what compute() has divided.
  std::vector<std::size_t> point_shares() const;
  /// Numbers of the points whose values this rank has after a call with @p recipient.
  std::span<const std::uint32_t> points_with_values(Recipient recipient) const;
  /// Boxes that this rank evaluates, in the order of their points.
  std::span<const std::uint32_t> own_leaves() const
  {
    return std::span(leaves).subspan(first_leaf, last_leaf - first_leaf);
  }
  /// Hands what the last evaluation took to MultipoleSettings::costs, for the shares of the next tree. @p further_seconds: processor
  /// time of each of own_leaves() besides the field, s.
  void learn_costs(std::span<const double> further_seconds);

protected:
  /// @p smallest_box: boxes are not divided below this edge length, nm. @p n_values: components of the field. @p n_antiderivatives: how
  /// often the potentials of the moments are integrated over z, 0 or 3; then all points must lie above all sources, with a
  /// face of boxes between them (half_line_translation.h), and only P and Q are translated.
  MultipoleSum(const MultipoleSettings &settings, const RootGrid &grid, std::span<const SourceExtent> sources,
               std::span<const Vec3> points, double smallest_box, std::size_t n_values, int n_antiderivatives = 0);

  /// Collective: every rank of @p comm computes a share of about equal cost.
  void compute(MPI_Comm comm, Part part, Recipient recipient = Recipient::every_rank,
               LocalExpansions local = LocalExpansions::used_once);
  /// Puts other sources and points into the boxes, see Octree::move(); local expansions stay those of the last compute().
  void move(std::span<const SourceExtent> sources, std::span<const std::uint32_t> box_of_source,
            std::span<const Vec3> points, std::span<const std::uint32_t> leaf_of_point);
  /// As compute() after move(), with the shares of the last time, whose local expansions become the earlier ones.
  void compute_again(MPI_Comm comm);
  /// Makes the earlier local expansions those of the moments as they are now. Collective.
  void compute_earlier();
  /// Evaluates the local expansions that the last compute() has kept and what acts directly. Collective, with the shares of that
  /// time. @throws std::logic_error if none are kept.
  void evaluate(MPI_Comm comm, const KeptExpansions &use);
  /// Values at the points in the order given; they are kept nowhere else.
  template <class Value> std::vector<Value> take_in_given_order(const Recipient recipient = Recipient::every_rank)
  {
    const std::span<const std::uint32_t> order = points_with_values(recipient);
    const auto first = static_cast<std::size_t>(order.data() - tree.point_order().data());
    std::vector<Value> result(tree.point_order().size(), Value(Value::Zero()));
#pragma omp parallel for schedule(static)
    for (std::size_t k = 0; k < order.size(); ++k)
      for (std::size_t c = 0; c < values.size(); ++c)
        result[order[k]][static_cast<Eigen::Index>(c)] = values[c][first + k];
    for (std::vector<double> &v : values)
      v = {};
    return result;
  }
  double tolerance() const
  {
    return settings.tolerance;
  }
  /// Whether distant lines and expansions are computed in single precision.
  bool single_precision() const
  {
    return settings.tolerance >= single_precision_from;
  }

  template <std::size_t n> PointBatch<n> batch_of(const Box &box)
  {
    PointBatch<n> batch{box.n_points(), {}, {}};
    for (std::size_t c = 0; c < 3; ++c)
      batch.x[c] = x[c].data() + box.points_begin;
    for (std::size_t c = 0; c < n; ++c)
      batch.value[c] = values[c].data() + box.points_begin;
    return batch;
  }

private:
  /// Adds the moments of the sources that @p box holds itself.
  virtual void add_own_moments(const Box &box, const ExpansionView &moments) const = 0;
  /// Level of the boxes to which sources at infinity are added; -1: none.
  virtual int distant_level() const
  {
    return -1;
  }
  /// Adds them to the local expansion of @p box.
  virtual void add_distant(const Box & /*box*/, const ExpansionView & /*local*/) const {}
  /// Adds a local expansion at the points of a leaf.
  virtual void add_far(const Box &leaf, const Row *fields, const double *q) = 0;
  /// Adds what acts directly on the points of leaf number @p leaf.
  virtual void add_near(std::size_t leaf) = 0;

  void choose_share(MPI_Comm comm);
  LeafWork work(std::size_t leaf) const;
  UnitCosts unit_costs(MPI_Comm comm);
  void far_passes(LocalExpansions local);
  void place_points(std::span<const Vec3> points);
  void start_values();
  void add_kept_of(std::size_t leaf, double ahead);
  void add_near_of_share(std::size_t stride);
  template <class Add> void for_each_leaf_of_share(std::size_t stride, Add &&add);
  void gather(MPI_Comm comm);

  MultipoleSettings settings;
  int n_antiderivatives;
  int order_of_cubes; ///< see ExpansionOrders
  int expansion_order_;
  Octree tree;
  std::array<std::vector<double>, 3> x;    ///< points in the tree's order
  std::vector<std::vector<double>> values; ///< component by component, in the tree's order
  std::unique_ptr<FarPasses> passes;
  std::vector<std::uint32_t> leaves;         ///< with points, in the order of their points
  std::vector<std::size_t> share;            ///< first leaf of each rank
  std::size_t first_leaf = 0, last_leaf = 0; ///< of this rank
  std::vector<std::uint8_t> wanted;          ///< boxes whose local expansion this rank needs
  MomentExchange exchange;                   ///< with whom multipole coefficients are shared
  PhaseTimes seconds;
  std::vector<double> leaf_seconds; ///< of own_leaves() in the last evaluation
  double seconds_learnt = 0;        ///< of translations, handed to the costs already
};
} // namespace ddfem::fmm
