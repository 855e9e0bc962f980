#pragma once

#include "fem/lagrange.h"
#include "fem/nodal_grid.h"

#include <array>
#include <utility>
#include <vector>

namespace ddfem::fem
{
/// Finds the cells of points and evaluates nodal fields there. Inverts the same isoparametric mapping as the elements
/// use.
///
/// Every rank looks in its own cells. A point is evaluated by the rank whose cell contains it (the lowest, if several
/// do), or for a point just outside the mesh by the one whose cell is nearest in unit coordinates, clamped to the cell.
/// The search starts in the cell where the point of the same number was in the last call, then in that of the point before
/// it in the list: a point of the same segment when the list has been renumbered.
class PointLocator
{
public:
  /// `tolerance`: how far outside, as a fraction of a cell, a point may be.
  PointLocator(const NodalGrid &grid, double tolerance);

  /// Values of fields at points: `fields` has n_components numbers for each local node; so has the result for each
  /// point, the same bits on all ranks. The result does not depend on earlier calls. Collective. Throws
  /// std::runtime_error for a point outside.
  std::vector<double> evaluate(const std::vector<dealii::Point<3>> &points, unsigned n_components,
                               const std::vector<double> &fields);

private:
  struct Place
  {
    unsigned cell;
    dealii::Point<3> xi;
    double outside; // how far outside the unit cube, zero within
  };

  void make_boxes();
  void make_bins();
  std::array<unsigned, 3> bin_of(const dealii::Point<3> &x) const;
  std::size_t bin_index(const std::array<unsigned, 3> &bin) const
  {
    return (std::size_t{bin[2]} * n_bins[1] + bin[1]) * n_bins[0] + bin[0];
  }
  std::vector<Place> locate(const std::vector<dealii::Point<3>> &points);
  /// `tried`: cells to look in first.
  Place locate(const dealii::Point<3> &x, const std::array<unsigned, 2> &tried) const;
  /// False when the point is not near the cell.
  bool invert_mapping(unsigned cell, const dealii::Point<3> &x, dealii::Point<3> &xi) const;
  void elect(const std::vector<dealii::Point<3>> &points, const std::vector<Place> &places,
             std::vector<int> &winners) const;

  const NodalGrid &grid;
  double tolerance;
  int rank = 0;
  dealii::Point<3> lower;
  std::array<double, 3> bin_size{};
  std::array<unsigned, 3> n_bins{};
  std::vector<std::pair<dealii::Point<3>, dealii::Point<3>>> boxes; // of cells, enlarged
  std::vector<unsigned> bin_start, bin_cells;                       // cells of each bin, ascending
  std::vector<unsigned> hints;                                      // cell of each point of the last call
};
} // namespace ddfem::fem
