// Fields of many sources at many points by a fast multipole method: what stress and displacement share.
#pragma once

#include "dd/fmm/half_line_translation.h"
#include "dd/fmm/octree.h"
#include "dd/fmm/translation.h"

#include <mpi.h>

#include <array>
#include <tuple>
#include <vector>

namespace ddfem::fmm
{
/// Multipole or local coefficients of all boxes: eight fields and Q, see ExpansionView.
class Expansions
{
public:
  Expansions(std::size_t n_boxes, int order) : n(n_harmonics(order)), fields_(n_boxes * n), q_(n_boxes * n, 0.0) {}
  ExpansionView of(std::size_t box) { return {fields_.rows() + box * n, q_.data() + box * n}; }
  const Row *fields(std::size_t box) const { return fields_.rows() + box * n; }
  const double *q(std::size_t box) const { return q_.data() + box * n; }

private:
  std::size_t n;
  RowBuffer fields_;
  std::vector<double> q_;
};

/// Processor time of the phases on this rank, summed over its threads, s.
struct PhaseTimes
{
  double upward = 0, translations = 0, downward = 0, points = 0, near = 0;
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
};

/// What to sum: all of it, or one part, for tests and measurements.
enum class Part : std::uint8_t
{
  all,
  near,
  far
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

protected:
  /// @p smallest_box: boxes are not divided below this edge length, nm. @p n_values: components of the field. @p n_antiderivatives: how
  /// often the potentials of the moments are integrated over z, 0 or 3; then all points must lie above all sources, with a
  /// face of boxes between them (half_line_translation.h), and only P and Q are translated.
  MultipoleSum(const MultipoleSettings &settings, const RootGrid &grid, std::span<const SourceExtent> sources,
               std::span<const Vec3> points, double smallest_box, std::size_t n_values, int n_antiderivatives = 0);

  /// Collective: every rank of @p comm computes a share of about equal cost; all get all values.
  void compute(MPI_Comm comm, Part part);
  /// Values at the points in the order given.
  template <class Value> std::vector<Value> in_given_order() const
  {
    const std::vector<std::uint32_t> &order = tree.point_order();
    std::vector<Value> result(order.size());
    for (std::size_t k = 0; k < order.size(); ++k)
      for (std::size_t c = 0; c < values.size(); ++c)
        result[order[k]][static_cast<Eigen::Index>(c)] = values[c][k];
    return result;
  }
  double tolerance() const { return settings.tolerance; }

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
  /// Adds sources at infinity to the local expansion of @p box.
  virtual void add_distant(const Box & /*box*/, const ExpansionView & /*local*/) const {}
  /// Adds a local expansion at the points of a leaf.
  virtual void add_far(const Box &leaf, const Row *fields, const double *q) = 0;
  /// Adds what acts directly on the points of leaf number @p leaf.
  virtual void add_near(std::size_t leaf) = 0;

  struct Task
  {
    std::uint32_t translation, target, source;
    bool operator<(const Task &o) const
    {
      return std::tie(translation, target, source) < std::tie(o.translation, o.target, o.source);
    }
  };

  void make_translations(const RootGrid &grid);
  void add_far_translation(const Vec3 &shift);
  std::uint32_t far_translation(const std::array<std::int16_t, 3> &offset) const;

  void choose_share(MPI_Comm comm);
  double work(std::size_t leaf) const;
  void compute_moments();
  void moments_of(std::size_t box);
  void translate_far();
  void translate_chunk(std::uint32_t begin, std::uint32_t end);
  void add_far(const Translation &translation, std::span<const Task> tasks);
  void add_far_q(const Translation &translation, std::span<const Task> tasks);
  void add_far_integrals(const HalfLineTranslation &translation, std::span<const Task> tasks);
  void pass_down();
  void pass_down_to(std::size_t box);
  void gather(MPI_Comm comm);

  MultipoleSettings settings;
  int n_antiderivatives;
  int expansion_order_;
  Octree tree;
  std::array<std::vector<double>, 3> x;    ///< points in the tree's order
  std::vector<std::vector<double>> values; ///< component by component, in the tree's order
  std::vector<Translation> far, to_parent, to_child;
  std::vector<HalfLineTranslation> far_integrals; ///< instead of far
  int largest_offset = 3;
  std::vector<std::uint32_t> far_number; ///< translation by offset, a cube
  Expansions multipole, local;
  std::vector<std::uint32_t> leaves;         ///< with points, in the order of their points
  std::vector<std::size_t> share;            ///< first leaf of each rank
  std::size_t first_leaf = 0, last_leaf = 0; ///< of this rank
  std::vector<std::uint8_t> wanted;          ///< boxes whose local expansion this rank needs
  PhaseTimes seconds;
};
} // namespace ddfem::fmm
