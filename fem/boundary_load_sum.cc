// The part of BoundaryLoad that takes the sources together at common points.
#include "fem/boundary_load.h"

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

std::vector<BoundaryPoints> BoundaryLoad::sort_sources(const TractionField &field, unsigned n_summed, Sum &sum) const
{
  std::map<dealii::types::boundary_id, BoundaryPoints> boundaries;
  std::size_t next = 0;
  for (const auto &face : grid.faces)
  {
    const auto [entry, is_new] = boundaries.try_emplace(face.boundary, BoundaryPoints{face.boundary, {}, {}, {}});
    BoundaryPoints &b = entry->second;
    for (unsigned source = 0; is_new && source < field.n_sources(); ++source)
    {
      const bool is_zero = field.vanishes_on(source, face.boundary);
      if (source < n_summed && is_zero)
      {
        b.vanishing.push_back(source);
      }
      if (source >= n_summed && !is_zero)
      {
        b.others.push_back(source);
      }
    }
    const bool is_empty = b.vanishing.size() == n_summed && b.others.empty();
    sum.first_point.push_back(is_empty ? no_points : next);
    next += is_empty ? 0 : static_cast<std::size_t>(sum.order) * sum.order;
  }
  std::vector<BoundaryPoints> result;
  for (auto &[boundary, b] : boundaries)
  {
    result.push_back(std::move(b));
  }
  return result;
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
  std::vector<BoundaryPoints> boundaries = sort_sources(field, *n_summed, result);
  const std::vector<dealii::Point<3>> points = common_points(result);
  if (*n_summed > 0)
  {
    result.stress = field.sum(points);
  }
  result.stress.resize(points.size());

  std::map<dealii::types::boundary_id, std::vector<std::size_t>> numbers;
  for (unsigned face = 0; face < grid.faces.size(); ++face)
  {
    for (std::size_t k = 0; k < static_cast<std::size_t>(order) * order && result.first_point[face] != no_points; ++k)
    {
      numbers[grid.faces[face].boundary].push_back(result.first_point[face] + k);
    }
  }
  for (BoundaryPoints &b : boundaries)
  {
    for (const std::size_t k : numbers[b.boundary])
    {
      b.points.push_back(points[k]);
    }
  }
  const auto stress = field.complete_sum(boundaries);
  for (std::size_t i = 0; i < boundaries.size(); ++i)
  {
    const std::vector<std::size_t> &of_boundary = numbers[boundaries[i].boundary];
    for (std::size_t k = 0; k < of_boundary.size(); ++k)
    {
      result.stress[of_boundary[k]] += stress[i][k];
    }
  }
  return result;
}

void BoundaryLoad::integrate_sum(const TractionField &field, unsigned face, const Sum &sum, std::vector<unsigned> &rest,
                                 FaceIntegral &result, Workspace &work) const
{
  if (sum.first_point[face] == no_points)
  {
    return;
  }
  const auto boundary = grid.faces[face].boundary;
  Piece piece = whole(face);
  measure(piece);
  const double length = 0.5 * sum.near_ratio * std::max(piece.length[0], piece.length[1]);
  std::vector<unsigned> near;
  field.append_near(piece.centre, piece.radius, length, near);
  std::copy_if(near.begin(), near.end(), std::back_inserter(rest),
               [&](unsigned source) { return !field.vanishes_on(source, boundary); });

  work.samples.clear();
  append_points(piece, {sum.order, sum.order}, work.samples);
  work.points.clear();
  for (const Sample &s : work.samples)
  {
    work.points.push_back(s.position);
  }
  work.stresses.assign(work.points.size(), {});
  if (!rest.empty())
  {
    field.add_stress(rest, work.points, work.stresses);
  }
  for (std::size_t i = 0; i < work.stresses.size(); ++i)
  {
    work.stresses[i] = sum.stress[sum.first_point[face] + i] - work.stresses[i];
  }
  add_samples(face, result, work);
  result.n_points += work.samples.size();
  result.n_evaluations += work.samples.size() * rest.size();
}
} // namespace ddfem::fem
