// The part of BoundaryLoad that takes the sources together at common points.
#include "fem/boundary_load.h"
#include "fem/interpolated_sum.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace ddfem::fem
{
std::vector<dealii::Point<3>> BoundaryLoad::common_points(const Sum &sum) const
{
  std::vector<Sample> samples;
  for (unsigned face = 0; face < grid.faces.size(); ++face)
  {
    if (sum.first_point[face] == samples.size())
    {
      append_points(whole(face), {sum.order, sum.order}, samples);
    }
  }
  std::vector<dealii::Point<3>> points;
  points.reserve(samples.size());
  for (const Sample &s : samples)
  {
    points.push_back(s.position);
  }
  return points;
}

BoundaryLoad::Sum BoundaryLoad::sum(const TractionField &field) const
{
  // The more points, the fewer sources are too near; beyond some two edges of a face that gains little.
  constexpr double near_enough = 5.1;
  const double error = std::max(tolerance, field.summation_error());
  Sum result;
  unsigned order = grid.degree + 1;
  while (ratio_for(error, order) > near_enough)
  {
    ++order;
  }
  const std::size_t n_points = dealii::Utilities::MPI::sum(grid.faces.size() * order * order, grid.communicator);
  const std::optional<unsigned> n_summed = field.n_summed(n_points);
  if (!n_summed)
  {
    return result;
  }
  result.order = order;
  result.near_ratio = ratio_for(error, order);
  std::size_t next = 0;
  for (const auto &face : grid.faces)
  {
    const auto boundary = face.boundary;
    if (result.vanishing.count(boundary) == 0)
    {
      auto &vanishing = result.vanishing[boundary], &others = result.others[boundary];
      for (unsigned source = 0; source < field.n_sources(); ++source)
      {
        const bool is_zero = field.vanishes_on(source, boundary);
        if (source < *n_summed && is_zero)
        {
          vanishing.push_back(source);
        }
        if (source >= *n_summed && !is_zero)
        {
          others.push_back(source);
        }
      }
    }
    const bool is_empty = result.vanishing[boundary].size() == *n_summed && result.others[boundary].empty();
    result.first_point.push_back(is_empty ? no_points : next);
    next += is_empty ? 0 : static_cast<std::size_t>(order) * order;
  }
  const std::vector<dealii::Point<3>> points = common_points(result);
  if (*n_summed > 0)
  {
    result.stress = field.sum(points);
  }
  result.stress.resize(points.size());
  add_others(field, error, points, result);
  return result;
}

/// Adds the sources that the field does not sum, boundary by boundary.
void BoundaryLoad::add_others(const TractionField &field, double error, const std::vector<dealii::Point<3>> &points,
                              Sum &sum) const
{
  for (const auto &[boundary, sources] : sum.others)
  {
    std::vector<std::size_t> numbers;
    std::vector<dealii::Point<3>> some;
    for (unsigned face = 0; face < grid.faces.size() && !sources.empty(); ++face)
    {
      if (grid.faces[face].boundary == boundary)
      {
        for (std::size_t k = 0; k < static_cast<std::size_t>(sum.order) * sum.order; ++k)
        {
          numbers.push_back(sum.first_point[face] + k);
          some.push_back(points[numbers.back()]);
        }
      }
    }
    const auto stress = interpolated_sum(field, sources, some, error);
    for (std::size_t k = 0; k < numbers.size(); ++k)
    {
      sum.stress[numbers[k]] += stress[k];
    }
  }
}

void BoundaryLoad::integrate_sum(const TractionField &field, unsigned face, const Sum &sum, std::vector<unsigned> &rest,
                                 FaceIntegral &result, Workspace &work) const
{
  if (sum.first_point[face] == no_points)
  {
    return;
  }
  const auto boundary = grid.faces[face].boundary;
  const std::vector<unsigned> &vanishing = sum.vanishing.at(boundary), &others = sum.others.at(boundary);
  Piece piece = whole(face);
  measure(piece);
  const double length = 0.5 * sum.near_ratio * std::max(piece.length[0], piece.length[1]);
  std::vector<unsigned> near, wrong;
  field.append_near(piece.centre, piece.radius, length, near);
  std::set_union(near.begin(), near.end(), vanishing.begin(), vanishing.end(), std::back_inserter(wrong));
  std::set_difference(near.begin(), near.end(), vanishing.begin(), vanishing.end(), std::back_inserter(rest));
  work.lengths.assign(others.size(), 0.);
  field.smooth_lengths(piece.centre, piece.radius, others, work.lengths);
  for (std::size_t i = 0; i < others.size(); ++i)
  {
    if (work.lengths[i] < length)
    {
      wrong.push_back(others[i]);
      rest.push_back(others[i]);
    }
  }

  work.samples.clear();
  append_points(piece, {sum.order, sum.order}, work.samples);
  work.points.clear();
  for (const Sample &s : work.samples)
  {
    work.points.push_back(s.position);
  }
  work.stresses.assign(work.points.size(), {});
  if (!wrong.empty())
  {
    field.add_stress(wrong, work.points, work.stresses);
  }
  for (std::size_t i = 0; i < work.stresses.size(); ++i)
  {
    work.stresses[i] = sum.stress[sum.first_point[face] + i] - work.stresses[i];
  }
  add_samples(face, result, work);
  result.n_points += work.samples.size();
  result.n_evaluations += work.samples.size() * wrong.size();
}
} // namespace ddfem::fem
