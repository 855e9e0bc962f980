#include "fem/boundary_load.h"

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ddfem::fem
{
namespace
{
/// Halvings in a direction: a millionth of a face is far below any core radius.
constexpr unsigned deepest = 20;

/// Gauss points and weights on the unit interval for 1 ... n_rules points.
const std::vector<dealii::QGauss<1>> &gauss_rules(unsigned n_rules)
{
  static const std::vector<dealii::QGauss<1>> rules = [n_rules]
  {
    std::vector<dealii::QGauss<1>> list;
    for (unsigned n = 1; n <= n_rules; ++n)
    {
      list.emplace_back(n);
    }
    return list;
  }();
  return rules;
}
} // namespace

double BoundaryLoad::ratio_for(double error, unsigned n)
{
  return std::sinh(-std::log(error) / (2. * (n - 1.)));
}

BoundaryLoad::BoundaryLoad(const NodalGrid &nodal_grid, const dealii::Point<3> &moment_centre,
                           double relative_tolerance)
    : grid(nodal_grid), centre(moment_centre), tolerance(relative_tolerance)
{
  for (unsigned n = 0; n <= most_points; ++n)
  {
    // Shape functions and area element of the whole face are integrated whatever the field.
    least_ratio[n] = n <= grid.degree ? std::numeric_limits<double>::infinity() : ratio_for(tolerance, n);
  }
  for (const auto &face : grid.faces)
  {
    nodes_of_face.emplace_back();
    for (const unsigned a : face_nodes(grid.degree, face.number))
    {
      nodes_of_face.back().push_back(grid.nodes_of(face.cell)[a]);
    }
  }
}

BoundaryLoad::Sample BoundaryLoad::sample(unsigned face, double s, double t) const
{
  const Lagrange1d in_s = lagrange_1d(grid.degree, s), in_t = lagrange_1d(grid.degree, t);
  Sample result;
  dealii::Tensor<1, 3> along_s, along_t;
  unsigned a = 0;
  for (unsigned j = 0; j <= grid.degree; ++j)
  {
    for (unsigned i = 0; i <= grid.degree; ++i, ++a)
    {
      const auto &node = grid.positions[nodes_of_face[face][a]];
      result.values[a] = in_s.value[i] * in_t.value[j];
      result.position += result.values[a] * node;
      along_s += in_s.derivative[i] * in_t.value[j] * node;
      along_t += in_s.value[i] * in_t.derivative[j] * node;
    }
  }
  const double outward = grid.faces[face].number % 2 == 0 ? -1. : 1.;
  result.area = outward * cross_product_3d(along_s, along_t);
  return result;
}

void BoundaryLoad::measure(Piece &piece) const
{
  std::array<std::array<dealii::Point<3>, 3>, 3> x;
  for (unsigned j = 0; j < 3; ++j)
  {
    for (unsigned i = 0; i < 3; ++i)
    {
      x[j][i] =
          sample(piece.face, piece.low[0] + 0.5 * i * piece.size[0], piece.low[1] + 0.5 * j * piece.size[1]).position;
    }
  }
  piece.centre = x[1][1];
  piece.radius = 0.;
  piece.length = {0., 0.};
  for (unsigned j = 0; j < 3; ++j)
  {
    piece.length[0] = std::max(piece.length[0], x[j][0].distance(x[j][1]) + x[j][1].distance(x[j][2]));
    piece.length[1] = std::max(piece.length[1], x[0][j].distance(x[1][j]) + x[1][j].distance(x[2][j]));
    for (unsigned i = 0; i < 3; ++i)
    {
      piece.radius = std::max(piece.radius, piece.centre.distance(x[j][i]));
    }
  }
}

unsigned BoundaryLoad::required_order(double length, double distance) const
{
  unsigned n = grid.degree + 1;
  while (n <= most_points && !(2. * distance >= least_ratio[n] * length))
  {
    ++n;
  }
  return n;
}

std::array<unsigned, 2> BoundaryLoad::divisions(const Piece &piece, double distance) const
{
  std::array<unsigned, 2> parts = {1, 1};
  for (unsigned d = 0; d < 2; ++d)
  {
    // The longer side is halved first, so that pieces become compact: the bound is for the ball around the piece.
    const bool is_long = 1.5 * piece.length[d] > piece.length[1 - d] || piece.depth[1 - d] == deepest;
    const bool too_long = required_order(piece.length[d], distance) > most_points;
    parts[d] = too_long && is_long && piece.depth[d] < deepest ? 2 : 1;
  }
  return parts;
}

void BoundaryLoad::descend(const TractionField &field, Piece piece, const std::vector<unsigned> &sources,
                           FaceIntegral &result, Workspace &work) const
{
  measure(piece);
  work.lengths.assign(sources.size(), 0.);
  field.smooth_lengths(piece.centre, piece.radius, sources, work.lengths);
  std::vector<unsigned> rest;
  double nearest = std::numeric_limits<double>::infinity();
  for (auto &group : work.groups)
  {
    group.clear();
  }
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    const double distance = work.lengths[i];
    const Orders orders = {required_order(piece.length[0], distance), required_order(piece.length[1], distance)};
    if (std::max(orders[0], orders[1]) > most_points)
    {
      rest.push_back(sources[i]);
      nearest = std::min(nearest, distance > 0. ? distance : 0.);
      continue;
    }
    work.groups[orders[0] * (most_points + 1) + orders[1]].push_back(sources[i]);
  }
  for (unsigned k = 0; k < work.groups.size(); ++k)
  {
    integrate(field, piece, {k / (most_points + 1), k % (most_points + 1)}, work.groups[k], result, work);
  }
  if (rest.empty())
  {
    return;
  }
  const auto parts = divisions(piece, nearest);
  if (parts[0] * parts[1] == 1)
  {
    ++result.n_unresolved;
    integrate(field, piece, {most_points, most_points}, rest, result, work);
    return;
  }
  for (unsigned k = 0; k < parts[0] * parts[1]; ++k)
  {
    Piece part = piece;
    const std::array<unsigned, 2> index = {k % parts[0], k / parts[0]};
    for (unsigned d = 0; d < 2; ++d)
    {
      part.size[d] = piece.size[d] / parts[d];
      part.low[d] += index[d] * part.size[d];
      part.depth[d] += parts[d] - 1;
    }
    descend(field, part, rest, result, work);
  }
}

void BoundaryLoad::append_points(const Piece &piece, const Orders &orders, std::vector<Sample> &samples) const
{
  const auto &rule_s = gauss_rules(most_points)[orders[0] - 1];
  const auto &rule_t = gauss_rules(most_points)[orders[1] - 1];
  for (unsigned j = 0; j < rule_t.size(); ++j)
  {
    for (unsigned i = 0; i < rule_s.size(); ++i)
    {
      samples.push_back(sample(piece.face, piece.low[0] + piece.size[0] * rule_s.point(i)[0],
                               piece.low[1] + piece.size[1] * rule_t.point(j)[0]));
      samples.back().area *= piece.size[0] * piece.size[1] * rule_s.weight(i) * rule_t.weight(j);
    }
  }
}

void BoundaryLoad::integrate(const TractionField &field, const Piece &piece, const Orders &orders,
                             const std::vector<unsigned> &sources, FaceIntegral &result, Workspace &work) const
{
  if (sources.empty())
  {
    return;
  }
  work.samples.clear();
  append_points(piece, orders, work.samples);
  work.points.clear();
  for (const Sample &s : work.samples)
  {
    work.points.push_back(s.position);
  }
  work.stresses.assign(work.points.size(), {});
  field.add_stress(sources, work.points, work.stresses);
  add_samples(piece.face, result, work);
  result.n_points += work.samples.size();
  result.n_evaluations += work.samples.size() * sources.size();
}

/// Adds the tractions of the stresses at the samples.
void BoundaryLoad::add_samples(unsigned face, FaceIntegral &result, const Workspace &work) const
{
  const std::size_t n_nodes = nodes_of_face[face].size();
  for (std::size_t i = 0; i < work.samples.size(); ++i)
  {
    const Sample &s = work.samples[i];
    const auto force = work.stresses[i] * s.area;
    result.force += force;
    result.moment += cross_product_3d(s.position - centre, force);
    for (std::size_t a = 0; a < n_nodes; ++a)
    {
      result.nodal[a] += s.values[a] * force;
    }
  }
}

BoundaryLoad::FaceIntegral BoundaryLoad::integrate_face(const TractionField &field, unsigned face, const Sum &sum,
                                                        Workspace &work) const
{
  FaceIntegral result;
  std::vector<unsigned> sources;
  if (sum.order > 0)
  {
    integrate_sum(field, face, sum, sources, result, work);
  }
  else
  {
    for (unsigned source = 0; source < field.n_sources(); ++source)
    {
      if (!field.vanishes_on(source, grid.faces[face].boundary))
      {
        sources.push_back(source);
      }
    }
  }
  if (!sources.empty())
  {
    descend(field, whole(face), sources, result, work);
  }
  return result;
}

TractionSummary BoundaryLoad::add_field(const TractionField &field, NodalVector &load) const
{
  const Sum summed = sum(field);
  std::vector<FaceIntegral> integrals(grid.faces.size());
#pragma omp parallel
  {
    Workspace work;
#pragma omp for schedule(dynamic)
    for (unsigned face = 0; face < integrals.size(); ++face)
    {
      integrals[face] = integrate_face(field, face, summed, work);
    }
  }
  TractionSummary summary;
  NodalVector sum(grid.partitioner);
  for (unsigned face = 0; face < integrals.size(); ++face)
  {
    add_face(face, integrals[face], summary, sum);
  }
  sum.compress(dealii::VectorOperation::add);
  load -= sum;
  reduce(summary);
  return summary;
}

void BoundaryLoad::add_face(unsigned face, const FaceIntegral &integral, TractionSummary &summary,
                            NodalVector &load) const
{
  summary.force += integral.force;
  summary.moment += integral.moment;
  summary.n_points += integral.n_points;
  summary.n_evaluations += integral.n_evaluations;
  summary.n_unresolved += integral.n_unresolved;
  const auto &nodes = nodes_of_face[face];
  for (unsigned a = 0; a < nodes.size(); ++a)
  {
    const double size = integral.nodal[a].norm();
    summary.absolute_force += size;
    summary.absolute_moment += size * grid.positions[nodes[a]].distance(centre);
    for (unsigned c = 0; c < 3; ++c)
    {
      load.local_element(3 * nodes[a] + c) += integral.nodal[a][c];
    }
  }
}

void BoundaryLoad::reduce(TractionSummary &summary) const
{
  std::array<double, 8> sums;
  for (unsigned d = 0; d < 3; ++d)
  {
    sums[d] = summary.force[d];
    sums[3 + d] = summary.moment[d];
  }
  sums[6] = summary.absolute_force;
  sums[7] = summary.absolute_moment;
  std::array<std::uint64_t, 3> counts = {summary.n_points, summary.n_evaluations, summary.n_unresolved};
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 8, MPI_DOUBLE, MPI_SUM, grid.communicator);
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), 3, MPI_UINT64_T, MPI_SUM, grid.communicator);
  for (unsigned d = 0; d < 3; ++d)
  {
    summary.force[d] = sums[d];
    summary.moment[d] = sums[3 + d];
  }
  summary.absolute_force = sums[6];
  summary.absolute_moment = sums[7];
  summary.n_points = counts[0];
  summary.n_evaluations = counts[1];
  summary.n_unresolved = counts[2];
}

std::vector<double> BoundaryLoad::mass(unsigned face) const
{
  const std::size_t n = nodes_of_face[face].size();
  std::vector<double> matrix(n * n, 0.);
  std::vector<Sample> samples;
  const unsigned n_points = 2 * grid.degree + 1; // exact on flat faces
  append_points(whole(face), {n_points, n_points}, samples);
  for (const Sample &s : samples)
  {
    const double area = s.area.norm();
    for (std::size_t k = 0; k < n * n; ++k)
    {
      matrix[k] += s.values[k / n] * s.values[k % n] * area;
    }
  }
  return matrix;
}

void BoundaryLoad::add_uniform(dealii::types::boundary_id boundary, const dealii::Tensor<1, 3> &traction,
                               NodalVector &load) const
{
  NodalVector integral(grid.partitioner);
  std::vector<Sample> samples;
  for (unsigned face = 0; face < grid.faces.size(); ++face)
  {
    if (grid.faces[face].boundary != boundary)
    {
      continue;
    }
    samples.clear();
    append_points(whole(face), {most_points, most_points}, samples);
    for (const Sample &s : samples)
    {
      for (unsigned k = 0; k < 3 * nodes_of_face[face].size(); ++k)
      {
        integral.local_element(3 * nodes_of_face[face][k / 3] + k % 3) +=
            s.values[k / 3] * s.area.norm() * traction[k % 3];
      }
    }
  }
  integral.compress(dealii::VectorOperation::add);
  load += integral;
}
} // namespace ddfem::fem
