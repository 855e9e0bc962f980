// Far stress of dislocation lines by interpolation on equispaced grids: the second formulation, beside harmonic potentials.
//
// Grids of n x n x n points in the boxes hold the dislocation density spread over them and the stress at them
// (grid_interpolation.h); between boxes the stress is a convolution of the density with ten kernels (grid_kernel.h), done in Fourier space.
#pragma once

#include "dd/elasticity/point_batch.h"
#include "dd/fmm/grid_interpolation.h"
#include "dd/fmm/grid_kernel.h"
#include "dd/fmm/octree.h"

#include <span>
#include <vector>

namespace ddfem::fmm
{
/// Processor time of the phases, summed over the threads, s.
struct GridTimes
{
  double upward = 0, kernels = 0, transforms = 0, translations = 0, downward = 0;
};

/// The far links of a tree as interpolated stress. Sums run in a fixed order: the result does not depend on the number of threads.
class GridExpansions
{
public:
  /// @p lines: in the order of the tree (Octree::line_order()). Tree and lines must outlive the object. @throws
  /// std::invalid_argument unless fewest_grid_points <= @p n_points <= most_grid_points, and for a line that reaches too far out of
  /// a box with far links, which can be on level 0 only.
  GridExpansions(const IsotropicMedium &medium, int n_points, const Octree &tree, std::span<const LineSource> lines);

  /// Density on all grids, from the lines up; stress on all grids, by the far links and downward.
  void compute();

  /// Adds the far stress at points of leaf number @p leaf (nm, MPa). After compute().
  void add_stress(std::size_t leaf, const StressBatch &points) const;

  const GridTimes &times() const { return seconds; }
  /// Memory of compute() at its largest, bytes.
  std::size_t largest_memory() const { return most_bytes; }

private:
  /// Boxes of one level that take part in its far links, and these.
  struct Level
  {
    std::vector<std::uint32_t> sources, targets;
    std::vector<GridLink> links;      ///< target by target; kernels are numbered by kernel_of()
    std::vector<std::uint32_t> first; ///< of each target, and the end
    std::vector<Offset> offsets;      ///< that occur
  };

  void check_reach() const;
  void add_lines(std::size_t box);
  void add_up(std::size_t level);
  Level level_of(std::size_t level) const;
  void translate(std::size_t level);
  GridKernel kernel_of(Level &level);
  Spectra spectra_of_sources(const Level &level);
  Spectra convolve_all(const Level &level, const Spectra &kernels, const Spectra &sources);
  void add_to_stress(const Level &level, const Spectra &targets);
  void add_down(std::size_t level);

  IsotropicMedium medium;
  GridInterpolation grid;
  GridTransform transform;
  const Octree &tree;
  std::span<const LineSource> lines;
  std::size_t coarsest;      ///< level with far links
  RowBuffer density, stress; ///< of all boxes
  GridTimes seconds;
  std::size_t most_bytes = 0;
};
} // namespace ddfem::fmm
