#include "fem/boundary_load.h"

#include "fem/lagrange.h"

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ddfem::fem
{
namespace
{
/// A piece is halved when it would need more Gauss points than this in a direction. Fewer points on smaller pieces cost
/// more near a line, more points on larger ones cost more where only a corner of the piece is near it.
constexpr unsigned most_points = 12;
/// Halvings in a direction: a millionth of a face is far below any core radius.
constexpr unsigned deepest = 20;

/// Gauss points and weights on the unit interval for 1 ... most_points points.
const std::vector<dealii::QGauss<1>> &gauss_rules()
{
  static const std::vector<dealii::QGauss<1>> rules = []
  {
    std::vector<dealii::QGauss<1>> list;
    for (unsigned n = 1; n <= most_points; ++n)
    {
      list.emplace_back(n);
    }
    return list;
  }();
  return rules;
}
} // namespace

BoundaryLoad::BoundaryLoad(const NodalGrid &nodal_grid, const dealii::Point<3> &moment_centre,
                           double relative_tolerance)
    : grid(nodal_grid), centre(moment_centre), tolerance(relative_tolerance)
{
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
  // Shape functions and area element of the whole face are integrated whatever the field.
  const unsigned least = grid.degree + 1;
  if (!(distance > 0.))
  {
    return most_points + 1;
  }
  const double ratio = 2. * distance / length;
  const double log_rho = std::asinh(ratio);
  const double n = std::ceil(-std::log(tolerance) / (2. * log_rho)) + 1.;
  return n > most_points ? most_points + 1 : std::max(least, static_cast<unsigned>(n));
}

bool BoundaryLoad::halve(Piece piece, double distance, std::vector<Piece> &next, std::vector<Piece> &done) const
{
  std::array<unsigned, 2> parts = {1, 1};
  bool resolved = true;
  for (unsigned d = 0; d < 2; ++d)
  {
    const unsigned order = required_order(piece.length[d], distance);
    piece.order[d] = std::min(order, most_points);
    // The longer side is halved first, so that pieces become compact: the bound is for the ball around the piece.
    const bool is_long = 1.5 * piece.length[d] > piece.length[1 - d] || piece.depth[1 - d] == deepest;
    parts[d] = order > most_points && is_long && piece.depth[d] < deepest ? 2 : 1;
    resolved = resolved && order <= most_points;
  }
  if (parts[0] * parts[1] == 1)
  {
    done.push_back(piece);
    return resolved;
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
    next.push_back(part);
  }
  return true;
}

std::vector<BoundaryLoad::Piece> BoundaryLoad::divide(const TractionField &field, std::uint64_t &n_unresolved) const
{
  std::vector<Piece> active, next, done;
  for (unsigned face = 0; face < grid.faces.size(); ++face)
  {
    active.push_back({face, {0., 0.}, {1., 1.}, {0, 0}, {0, 0}, {}, 0., {}});
  }
  std::vector<dealii::Point<3>> centres;
  std::vector<double> radii, lengths;
  while (!active.empty())
  {
    centres.clear();
    radii.clear();
    for (Piece &piece : active)
    {
      measure(piece);
      centres.push_back(piece.centre);
      radii.push_back(piece.radius);
    }
    lengths.assign(active.size(), 0.);
    std::vector<dealii::types::boundary_id> boundaries;
    for (const Piece &piece : active)
      boundaries.push_back(grid.faces[piece.face].boundary);
    field.smooth_lengths(centres, radii, boundaries, lengths);
    next.clear();
    for (std::size_t i = 0; i < active.size(); ++i)
    {
      n_unresolved += halve(active[i], lengths[i], next, done) ? 0 : 1;
    }
    active.swap(next);
  }
  return done;
}

void BoundaryLoad::append_points(const Piece &piece, std::vector<Sample> &samples) const
{
  const auto &rule_s = gauss_rules()[piece.order[0] - 1];
  const auto &rule_t = gauss_rules()[piece.order[1] - 1];
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

TractionSummary BoundaryLoad::add_field(const TractionField &field, NodalVector &load) const
{
  TractionSummary summary;
  const std::vector<Piece> pieces = divide(field, summary.n_unresolved);
  std::vector<Sample> samples;
  std::vector<unsigned> faces;
  for (const Piece &piece : pieces)
  {
    append_points(piece, samples);
    faces.resize(samples.size(), piece.face);
  }
  std::vector<dealii::Point<3>> points;
  points.reserve(samples.size());
  for (const Sample &s : samples)
  {
    points.push_back(s.position);
  }
  std::vector<dealii::SymmetricTensor<2, 3>> stresses(points.size());
  std::vector<dealii::types::boundary_id> boundaries;
  for (const unsigned face : faces)
    boundaries.push_back(grid.faces[face].boundary);
  field.stress(points, boundaries, stresses);
  NodalVector integral(grid.partitioner);
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    const auto force = stresses[i] * samples[i].area;
    const auto arm = samples[i].position - centre;
    summary.force += force;
    summary.moment += cross_product_3d(arm, force);
    summary.absolute_force += force.norm();
    summary.absolute_moment += arm.norm() * force.norm();
    const auto &nodes = nodes_of_face[faces[i]];
    for (unsigned a = 0; a < nodes.size(); ++a)
    {
      for (unsigned c = 0; c < 3; ++c)
      {
        integral.local_element(3 * nodes[a] + c) -= samples[i].values[a] * force[c];
      }
    }
  }
  integral.compress(dealii::VectorOperation::add);
  load += integral;
  summary.n_points = samples.size();
  reduce(summary);
  return summary;
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
  std::array<std::uint64_t, 2> counts = {summary.n_points, summary.n_unresolved};
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 8, MPI_DOUBLE, MPI_SUM, grid.communicator);
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), 2, MPI_UINT64_T, MPI_SUM, grid.communicator);
  for (unsigned d = 0; d < 3; ++d)
  {
    summary.force[d] = sums[d];
    summary.moment[d] = sums[3 + d];
  }
  summary.absolute_force = sums[6];
  summary.absolute_moment = sums[7];
  summary.n_points = counts[0];
  summary.n_unresolved = counts[1];
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
    append_points({face, {0., 0.}, {1., 1.}, {0, 0}, {most_points, most_points}, {}, 0., {}}, samples);
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
