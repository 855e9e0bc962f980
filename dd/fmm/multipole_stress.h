// Stress of many dislocation lines at many points by a fast multipole method.
#pragma once

#include "dd/elasticity/line_table.h"
#include "dd/fmm/grids_and_rays.h"
#include "dd/fmm/multipole_sum.h"

#include <vector>

namespace ddfem::fmm
{
/// A line, and the box that has it or had it.
struct PlacedLine
{
  LineSource line;
  std::uint32_t box;
};

/// What MultipoleStress::move() puts into the boxes.
struct MovedSources
{
  std::span<const LineSource> lines;
  std::span<const std::uint32_t> box_of_line;
  std::span<const RaySource> distant_rays;
  /// Summed in closed form at the points for which their box is distant: by how much the expansions are wrong.
  std::span<const PlacedLine> corrections;
  /// The same of distant rays, where these act by expansions.
  std::span<const RaySource> ray_corrections;
};

/// Stress of lines at points: near pairs of boxes by the closed form (segment_stress.h), distant pairs by nine harmonic potentials
/// (stress_expansion.h).
class MultipoleStress final : public MultipoleSum
{
public:
  MultipoleStress(const IsotropicMedium &medium, const MultipoleSettings &settings, const RootGrid &grid,
                  std::span<const LineSource> lines, std::span<const RaySource> distant_rays,
                  std::span<const Vec3> points);

  /// Stress at the points in the order given, MPa. Collective: see compute().
  std::vector<SymTensor> stress(MPI_Comm comm, Part part = Part::all, Recipient recipient = Recipient::every_rank,
                                LocalExpansions local = LocalExpansions::used_once);

  /// Puts other sources and points into the boxes; what distant boxes add stays as it was at the last stress(). See
  /// Octree::move().
  void move(const MovedSources &moved, std::span<const Vec3> points, std::span<const std::uint32_t> leaf_of_point);
  /// Stress after move(), MPa. Collective.
  std::vector<SymTensor> stress_with_kept_far_field(MPI_Comm comm, const KeptExpansions &use);
  /// The same with a new far field; the last one is kept for extrapolation.
  std::vector<SymTensor> stress_with_new_far_field(MPI_Comm comm);
  /// Replaces the far field that was kept for extrapolation by that of the same sources at other places, lines in the order given.
  void set_earlier(std::span<const LineSource> lines, std::vector<RaySource> distant_rays);

  /// The lines in the order of the tree.
  const LineTable &table() const { return line_table; }
  /// Number @p k of them.
  LineSource line(const std::size_t k) const
  {
    return {line_table.vector(k, LineTable::first_end), line_table.vector(k, LineTable::second_end),
            line_table.vector(k, LineTable::burgers)};
  }

private:
  LineTable in_order_of_tree(std::span<const LineSource> lines) const;
  void take_rays(std::span<const RaySource> distant_rays);
  void add_own_moments(const Box &box, const ExpansionView &moments) const override;
  int distant_level() const override { return rays.empty() ? -1 : level_of_distant_rays; }
  void add_distant(const Box &box, const ExpansionView &local) const override;
  void add_far(const Box &leaf, const Row *fields, const double *q) override;
  void add_near(std::size_t leaf) override;
  void add_corrections(std::size_t leaf, const StressBatch &batch) const;
  /// Stress of lines by their numbers in the tree's order, moved by @p shift (nm), at points of @p box moved back by it.
  void add_near_lines(std::span<const unsigned> near, std::span<const unsigned> distant, const Box &box,
                      const StressBatch &batch, const Vec3 &shift) const;

  IsotropicMedium medium;
  std::vector<RaySource> rays;
  LineTable line_table; ///< in the tree's order
  LineTable ray_table;
  std::vector<std::uint32_t> box_of_correction; ///< for which points corrections are distant
  LineTable corrections, ray_corrections;
};
} // namespace ddfem::fmm
