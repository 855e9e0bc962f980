#include "fem/point_locator.h"

#include "fem/element.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace ddfem::fem
{
namespace
{
constexpr unsigned no_cell = std::numeric_limits<unsigned>::max();
constexpr double far = std::numeric_limits<double>::max();

/// Points this far outside a cell, in unit coordinates, still count as within.
constexpr double rounding = 1e-10;

double distance_outside(const dealii::Point<3> &xi)
{
  double outside = 0.;
  for (unsigned d = 0; d < 3; ++d)
  {
    outside = std::max({outside, -xi[d], xi[d] - 1.});
  }
  return outside <= rounding ? 0. : outside;
}

bool strictly_inside(const dealii::Point<3> &xi)
{
  constexpr double margin = 1e-8;
  return std::all_of(xi.begin_raw(), xi.end_raw(), [](double x) { return x > margin && x < 1. - margin; });
}
} // namespace

PointLocator::PointLocator(const NodalGrid &nodal_grid, double outside_tolerance)
    : grid(nodal_grid), tolerance(outside_tolerance)
{
  MPI_Comm_rank(grid.communicator, &rank);
  make_boxes();
  make_bins();
}

void PointLocator::make_boxes()
{
  for (unsigned cell = 0; cell < grid.n_cells(); ++cell)
  {
    dealii::Point<3> low(far, far, far), high(-far, -far, -far);
    for (unsigned a = 0; a < grid.nodes_per_cell; ++a)
    {
      for (unsigned d = 0; d < 3; ++d)
      {
        low[d] = std::min(low[d], grid.positions[grid.nodes_of(cell)[a]][d]);
        high[d] = std::max(high[d], grid.positions[grid.nodes_of(cell)[a]][d]);
      }
    }
    // Room for points outside and for what a curved cell reaches beyond its nodes.
    const double room = (2. * tolerance + 0.05) * low.distance(high);
    const dealii::Tensor<1, 3> margin({room, room, room});
    boxes.emplace_back(low - margin, high + margin);
  }
}

void PointLocator::make_bins()
{
  if (boxes.empty())
  {
    return;
  }
  lower = boxes[0].first;
  dealii::Point<3> upper = boxes[0].second;
  for (const auto &[low, high] : boxes)
  {
    for (unsigned d = 0; d < 3; ++d)
    {
      lower[d] = std::min(lower[d], low[d]);
      upper[d] = std::max(upper[d], high[d]);
    }
  }
  // About as many bins as cells, about cubic.
  const auto extent = upper - lower;
  const double size = std::cbrt(extent[0] * extent[1] * extent[2] / grid.n_cells());
  for (unsigned d = 0; d < 3; ++d)
  {
    n_bins[d] = static_cast<unsigned>(std::clamp(extent[d] / size, 1., 1000.));
    bin_size[d] = extent[d] / n_bins[d];
  }
  std::vector<std::vector<unsigned>> cells(std::size_t{n_bins[0]} * n_bins[1] * n_bins[2]);
  for (unsigned cell = 0; cell < grid.n_cells(); ++cell)
  {
    const auto first = bin_of(boxes[cell].first), last = bin_of(boxes[cell].second);
    std::array<unsigned, 3> bin;
    for (bin[2] = first[2]; bin[2] <= last[2]; ++bin[2])
    {
      for (bin[1] = first[1]; bin[1] <= last[1]; ++bin[1])
      {
        for (bin[0] = first[0]; bin[0] <= last[0]; ++bin[0])
        {
          cells[bin_index(bin)].push_back(cell);
        }
      }
    }
  }
  bin_start.push_back(0);
  for (const auto &bin : cells)
  {
    bin_cells.insert(bin_cells.end(), bin.begin(), bin.end());
    bin_start.push_back(static_cast<unsigned>(bin_cells.size()));
  }
}

std::array<unsigned, 3> PointLocator::bin_of(const dealii::Point<3> &x) const
{
  std::array<unsigned, 3> bin;
  for (unsigned d = 0; d < 3; ++d)
  {
    bin[d] = static_cast<unsigned>(std::clamp((x[d] - lower[d]) / bin_size[d], 0., n_bins[d] - 0.5));
  }
  return bin;
}

bool PointLocator::invert_mapping(unsigned cell, const dealii::Point<3> &x, dealii::Point<3> &xi) const
{
  const auto &[low, high] = boxes[cell];
  for (unsigned d = 0; d < 3; ++d)
  {
    // Written so that a coordinate that is not a number fails.
    if (!(x[d] >= low[d] && x[d] <= high[d]))
    {
      return false;
    }
  }
  const auto position = [&](unsigned a) -> const dealii::Point<3> & { return grid.positions[grid.nodes_of(cell)[a]]; };
  xi = dealii::Point<3>(0.5, 0.5, 0.5);
  constexpr unsigned most_steps = 20;
  constexpr double accuracy = 1e-13, lost = 3.;
  for (unsigned step = 0; step < most_steps; ++step)
  {
    const LagrangeCell shape = lagrange_cell(grid.degree, xi);
    dealii::Tensor<1, 3> residual = x;
    for (unsigned a = 0; a < grid.nodes_per_cell; ++a)
    {
      residual -= shape.value[a] * position(a);
    }
    const auto change = invert(jacobian(shape, grid.nodes_per_cell, position)) * residual;
    xi += change;
    if (!(xi.norm() < lost))
    {
      return false;
    }
    if (change.norm() < accuracy || (step > 6 && change.norm() < rounding))
    {
      return true;
    }
  }
  return false;
}

PointLocator::Place PointLocator::locate(const dealii::Point<3> &x, const std::array<unsigned, 2> &tried) const
{
  Place best{no_cell, {}, far};
  dealii::Point<3> xi;
  for (const unsigned hint : tried)
  {
    // Only where no other cell can claim the point: the result must not depend on the hint.
    if (hint != no_cell && invert_mapping(hint, x, xi) && strictly_inside(xi))
    {
      return {hint, xi, 0.};
    }
  }
  if (boxes.empty())
  {
    return best;
  }
  const std::size_t index = bin_index(bin_of(x));
  for (unsigned i = bin_start[index]; i < bin_start[index + 1] && best.outside > 0.; ++i)
  {
    if (invert_mapping(bin_cells[i], x, xi))
    {
      const double outside = distance_outside(xi);
      if (outside <= tolerance && outside < best.outside)
      {
        best = {bin_cells[i], xi, outside};
      }
    }
  }
  return best;
}

void PointLocator::elect(const std::vector<dealii::Point<3>> &points, const std::vector<Place> &places,
                         std::vector<int> &winners) const
{
  struct Candidate
  {
    double outside;
    int rank;
  };
  std::vector<Candidate> candidates;
  for (const Place &place : places)
  {
    candidates.push_back({place.outside, rank});
  }
  MPI_Allreduce(MPI_IN_PLACE, candidates.data(), static_cast<int>(candidates.size()), MPI_DOUBLE_INT, MPI_MINLOC,
                grid.communicator);
  winners.clear();
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (candidates[i].outside > tolerance)
    {
      std::ostringstream text;
      text.precision(10);
      text << "the point (" << points[i] << ") nm lies outside the mesh by more than " << tolerance << " of a cell";
      throw std::runtime_error(text.str());
    }
    winners.push_back(candidates[i].rank);
  }
}

std::vector<PointLocator::Place> PointLocator::locate(const std::vector<dealii::Point<3>> &points)
{
  // Shorter lists leave the rest of the hints as they are: lists of several kinds alternate.
  hints.resize(std::max(hints.size(), points.size()), no_cell);
  std::vector<Place> places(points.size());
#pragma omp parallel
  {
    unsigned previous = no_cell; // cell of the point before in this thread's part
#pragma omp for schedule(static)
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      places[i] = locate(points[i], {hints[i], previous});
      previous = places[i].cell;
      hints[i] = previous;
    }
  }
  return places;
}

std::vector<double> PointLocator::evaluate(const std::vector<dealii::Point<3>> &points, unsigned n_components,
                                           const std::vector<double> &fields)
{
  const std::vector<Place> places = locate(points);
  std::vector<int> winners;
  elect(points, places, winners);
  std::vector<double> values(points.size() * n_components, 0.);
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (winners[i] != rank)
    {
      continue;
    }
    dealii::Point<3> xi = places[i].xi;
    for (unsigned d = 0; d < 3; ++d)
    {
      xi[d] = std::clamp(xi[d], 0., 1.);
    }
    const LagrangeCell shape = lagrange_cell(grid.degree, xi);
    for (unsigned a = 0; a < grid.nodes_per_cell; ++a)
    {
      const double *const nodal = &fields[std::size_t{grid.nodes_of(places[i].cell)[a]} * n_components];
      for (unsigned c = 0; c < n_components; ++c)
      {
        values[i * n_components + c] += shape.value[a] * nodal[c];
      }
    }
  }
  // One rank contributes to each sum, so that it is exact.
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM, grid.communicator);
  return values;
}
} // namespace ddfem::fem
