#include "dd/mobility/consistent_velocities.h"

#include "dd/mobility/damped_newton.h"
#include "dd/mobility/local_velocities.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace ddfem
{
namespace
{
constexpr unsigned most_gradients = 1000, most_newton = 100;
/// Below this many rows threads cost more than they save.
constexpr std::size_t worth_threads = 2000;

/// Calls f(row) for all rows.
template <class F> void for_each_row(const std::size_t n, F &&f)
{
#pragma omp parallel for schedule(static) if (n > worth_threads)
  for (std::size_t i = 0; i < n; ++i)
    f(i);
}

/// Sum of x_i . y_i in an order that does not depend on the number of threads.
double dot(const std::vector<Vec3> &x, const std::vector<Vec3> &y)
{
  constexpr std::size_t block = 512;
  const std::size_t n_blocks = (x.size() + block - 1) / block;
  std::vector<double> sums(n_blocks, 0.0);
#pragma omp parallel for schedule(static) if (x.size() > worth_threads)
  for (std::size_t k = 0; k < n_blocks; ++k)
  {
    double sum = 0;
    for (std::size_t i = k * block; i < std::min(x.size(), (k + 1) * block); ++i)
      sum += x[i].dot(y[i]);
    sums[k] = sum;
  }
  double total = 0;
  for (const double s : sums)
    total += s;
  return total;
}

struct GaussPoint
{
  double at, weight; ///< in [0, 1]
};
const std::array<GaussPoint, 3> gauss{
    {{0.5 - 0.5 * std::sqrt(0.6), 5.0 / 18.0}, {0.5, 4.0 / 9.0}, {0.5 + 0.5 * std::sqrt(0.6), 5.0 / 18.0}}};
} // namespace

ConsistentVelocities::ConsistentVelocities(const Network &present, const MobilityLaw &mobility_law,
                                           const GrainShape *shape, const double sliding_drag)
    : network(present), law(mobility_law), sliding(sliding_drag), nodes(present.nodes())
{
  number_rows(shape);
  if (law.is_linear())
    set_linear_blocks();
}

void ConsistentVelocities::number_rows(const GrainShape *shape)
{
  std::vector<std::uint32_t> row_of_node(network.node_capacity(), 0), row_of_segment(network.segment_capacity(), 0);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    row_of_node[nodes[k].value] = static_cast<std::uint32_t>(k);
  const auto segments = network.segments();
  pieces.resize(segments.size());
  blocks.resize(segments.size());
  for (std::size_t k = 0; k < segments.size(); ++k)
    row_of_segment[segments[k].value] = static_cast<std::uint32_t>(k);
  for_each_row(segments.size(),
               [&](const std::size_t k)
               {
                 const SegmentIndex s = segments[k];
                 const LineState line = line_state(network, s);
                 pieces[k] = {line, network.length(s), sliding * law.drag(line), row_of_node[network.start(s).value],
                              row_of_node[network.end(s).value]};
               });
  first_arm.assign(nodes.size() + 1, 0);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    first_arm[k + 1] = first_arm[k] + static_cast<std::uint32_t>(network.degree(nodes[k]));
  arms.resize(first_arm.back());
  directions.resize(nodes.size());
  inverse.resize(nodes.size());
  for_each_row(
      nodes.size(),
      [&](const std::size_t k)
      {
        const NodeIndex i = nodes[k];
        directions[k] = directions_of_motion(network, i, law, shape);
        std::uint32_t at = first_arm[k];
        for (const SegmentIndex s : network.connected_segments(i))
          arms[at++] = {row_of_segment[s.value], row_of_node[network.other_end(s, i).value], network.start(s) == i};
      });
}

void ConsistentVelocities::set_linear_blocks()
{
  for_each_row(pieces.size(),
               [&](const std::size_t k)
               {
                 const Piece &p = pieces[k];
                 const Mat3 along = p.line.direction * p.line.direction.transpose();
                 const Mat3 slope = law.drag(p.line) * (Mat3::Identity() - along) + p.along * along;
                 blocks[k].start_start = p.length / 3 * slope;
                 blocks[k].start_end = p.length / 6 * slope;
                 blocks[k].end_end = blocks[k].start_start;
               });
  set_preconditioner();
}

ConsistentVelocities::Field ConsistentVelocities::residual(const Field &force, const Field &v, const bool with_blocks)
{
  std::vector<std::array<Vec3, 2>> taken(pieces.size());
  for_each_row(pieces.size(),
               [&](const std::size_t k)
               {
                 const Piece &p = pieces[k];
                 const Mat3 along = p.along * p.line.direction * p.line.direction.transpose();
                 Blocks sum{Mat3::Zero(), Mat3::Zero(), Mat3::Zero()};
                 std::array<Vec3, 2> ends{Vec3::Zero(), Vec3::Zero()};
                 for (const GaussPoint &g : gauss)
                 {
                   const Vec3 here = (1 - g.at) * v[p.start] + g.at * v[p.end];
                   const Resistance r = law.resistance(p.line, here);
                   const double w = g.weight * p.length;
                   ends[0] += w * (1 - g.at) * (r.force + along * here);
                   ends[1] += w * g.at * (r.force + along * here);
                   if (!with_blocks)
                     continue;
                   const Mat3 slope = r.slope + along;
                   sum.start_start += w * (1 - g.at) * (1 - g.at) * slope;
                   sum.start_end += w * g.at * (1 - g.at) * slope;
                   sum.end_end += w * g.at * g.at * slope;
                 }
                 taken[k] = ends;
                 if (with_blocks)
                   blocks[k] = sum;
               });
  Field rest(nodes.size());
  for_each_row(nodes.size(),
               [&](const std::size_t i)
               {
                 Vec3 sum = force[i];
                 for (std::uint32_t a = first_arm[i]; a < first_arm[i + 1]; ++a)
                   sum -= taken[arms[a].segment][arms[a].is_start ? 0 : 1];
                 rest[i] = directions[i] * sum;
               });
  return rest;
}

void ConsistentVelocities::set_preconditioner()
{
  for_each_row(nodes.size(),
               [&](const std::size_t i)
               {
                 Mat3 diagonal = Mat3::Zero();
                 for (std::uint32_t a = first_arm[i]; a < first_arm[i + 1]; ++a)
                   diagonal += arms[a].is_start ? blocks[arms[a].segment].start_start : blocks[arms[a].segment].end_end;
                 const Mat3 &p = directions[i];
                 const double scale = std::max(diagonal.trace(), 1e-300);
                 const Mat3 full = p * diagonal * p + scale * (Mat3::Identity() - p);
                 inverse[i] = p * full.inverse() * p;
               });
}

ConsistentVelocities::Field ConsistentVelocities::times_matrix(const Field &x) const
{
  Field y(nodes.size());
  for_each_row(nodes.size(),
               [&](const std::size_t i)
               {
                 Vec3 sum = Vec3::Zero();
                 for (std::uint32_t a = first_arm[i]; a < first_arm[i + 1]; ++a)
                 {
                   const Blocks &b = blocks[arms[a].segment];
                   sum += (arms[a].is_start ? b.start_start : b.end_end) * x[i] + b.start_end * x[arms[a].neighbour];
                 }
                 y[i] = directions[i] * sum;
               });
  return y;
}

ConsistentVelocities::Field ConsistentVelocities::preconditioned(const Field &x) const
{
  Field y(x.size());
  for_each_row(x.size(), [&](const std::size_t i) { y[i] = inverse[i] * x[i]; });
  return y;
}

ConsistentVelocities::Field ConsistentVelocities::conjugate_gradients(const Field &y, const double target)
{
  Field x(y.size(), Vec3::Zero()), rest = y, z = preconditioned(rest), direction = z;
  double norm = dot(rest, z);
  for (unsigned k = 0; norm > target; ++k)
  {
    if (k == most_gradients)
      throw std::runtime_error("the consistent velocities did not converge in " + std::to_string(most_gradients) +
                               " iterations");
    ++count.gradients;
    const Field a = times_matrix(direction);
    const double step = norm / dot(direction, a);
    for_each_row(x.size(),
                 [&](const std::size_t i)
                 {
                   x[i] += step * direction[i];
                   rest[i] -= step * a[i];
                   z[i] = inverse[i] * rest[i];
                 });
    const double next = dot(rest, z), ratio = next / norm;
    norm = next;
    for_each_row(x.size(), [&](const std::size_t i) { direction[i] = z[i] + ratio * direction[i]; });
  }
  return x;
}

ConsistentVelocities::Field ConsistentVelocities::newton(const Field &force, Field v, const double accuracy)
{
  for (unsigned k = 0; k < most_newton; ++k)
  {
    const Field rest = residual(force, v, true);
    set_preconditioner();
    const double norm = dot(rest, preconditioned(rest)), scale = dot(force, preconditioned(force));
    if (norm <= accuracy * scale)
      return v;
    ++count.newton;
    constexpr double inexact = 1e-6; // squared: the step need not be better than the linearisation
    const Field step = conjugate_gradients(rest, std::max(inexact * norm, 0.1 * accuracy * scale));
    const auto at = [&](const double s)
    {
      Field there(v.size());
      for (std::size_t i = 0; i < v.size(); ++i)
        there[i] = v[i] + s * step[i];
      return there;
    };
    v = at(damped_step(dot(step, rest), [&](const double s) { return dot(step, residual(force, at(s), false)); }));
  }
  throw std::runtime_error("the consistent velocities did not converge in " + std::to_string(most_newton) +
                           " steps of Newton's method");
}

std::vector<Vec3> ConsistentVelocities::solve(const std::vector<Vec3> &force, const std::vector<Vec3> &start)
{
  count = {};
  Field f(nodes.size()), v(nodes.size(), Vec3::Zero());
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const std::uint32_t node = nodes[i].value;
    f[i] = directions[i] * force[node];
    if (node < start.size())
      v[i] = directions[i] * start[node];
  }
  if (law.is_linear())
  {
    const Field taken = times_matrix(v);
    Field rest(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      rest[i] = f[i] - taken[i];
    count.newton = 1;
    const Field step = conjugate_gradients(rest, tolerance * tolerance * dot(f, preconditioned(f)));
    for (std::size_t i = 0; i < nodes.size(); ++i)
      v[i] += step[i];
  }
  else
    v = newton(f, std::move(v), tolerance * tolerance);
  std::vector<Vec3> velocity(network.node_capacity(), Vec3::Zero());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    velocity[nodes[i].value] = directions[i] * v[i];
  return velocity;
}
} // namespace ddfem
