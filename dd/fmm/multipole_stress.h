// Stress of many dislocation lines at many points by a fast multipole method.
#pragma once

#include "dd/elasticity/line_table.h"
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
};

/**
 * Stress of lines at points: near pairs of boxes by the closed form (segment_stress.h), distant pairs by expansions of nine
 * harmonic potentials (stress_expansion.h), on an adaptive octree that is divided as long as that saves work. Long lines
 * stay in large boxes. All sums run in a fixed order: the result does not depend on the number of threads and ranks.
 */
class MultipoleStress
{
public:
  MultipoleStress(const IsotropicMedium &medium, const MultipoleSettings &settings, const RootGrid &grid,
                  std::span<const LineSource> lines, std::span<const RaySource> distant_rays,
                  std::span<const Vec3> points);

  /// What to sum: all of it, or one part, for tests and measurements.
  enum class Part : std::uint8_t
  {
    all,
    near,
    far
  };
  /// Stress at the points in the order given, MPa. Collective: every rank of @p comm computes a share of about equal cost and
  /// gets all values.
  std::vector<SymTensor> stress(MPI_Comm comm, Part part = Part::all);

  const Octree &octree() const { return tree; }
  /// The lines in the order of the tree.
  const std::vector<LineSource> &lines() const { return sources; }
  int order() const { return expansion_order_; }
  const PhaseTimes &times() const { return seconds; }

private:
  struct Task
  {
    std::uint32_t translation, target, source;
    bool operator<(const Task &o) const
    {
      return std::tie(translation, target, source) < std::tie(o.translation, o.target, o.source);
    }
  };

  void make_translations(const RootGrid &grid);
  std::uint32_t far_translation(const std::array<std::int16_t, 3> &offset) const;

  void choose_share(MPI_Comm comm);
  double work(std::size_t leaf) const;
  void compute_moments();
  void moments_of(std::size_t box);
  void translate_far();
  void translate_chunk(std::uint32_t begin, std::uint32_t end);
  void add_far_q(const Translation &translation, std::span<const Task> tasks);
  void pass_down();
  void pass_down_to(std::size_t box);
  void evaluate_far(std::size_t leaf);
  void evaluate_near(std::size_t leaf);
  StressBatch batch_of(const Box &box);
  std::vector<SymTensor> gather(MPI_Comm comm);

  IsotropicMedium medium;
  MultipoleSettings settings;
  int expansion_order_;
  Octree tree;
  LineTable line_table, ray_table; ///< of `sources` and `rays`
  std::vector<LineSource> sources; ///< in the tree's order
  std::vector<RaySource> rays;
  std::array<std::vector<double>, 3> x; ///< points in the tree's order
  std::array<std::vector<double>, 6> sigma;
  std::vector<Translation> far, to_parent, to_child;
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
