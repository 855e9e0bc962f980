#include "coupling/correction_update.h"

#include "coupling/energy_balance.h"
#include "dd/common/parallel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ddfem::coupling
{
namespace
{
std::size_t count_surface_nodes(const Network &network)
{
  std::size_t count = 0;
  for (const NodeIndex i : network.nodes())
    count += network.constraint(i) == NodeConstraint::surface ? 1 : 0;
  return count;
}

/// Where the change of the correction is estimated.
struct Receiver
{
  Vec3 position;
  double length, depth;
};

/// Sum of moments over the cubes of their distances from the images of the sources, 1 (no unit).
Mat3 image_field(const Receiver &at, const std::vector<ChangeSources::Source> &sources,
                 const std::vector<double> &depths, const double resolution)
{
  Mat3 sum = Mat3::Zero();
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    const double r2 = (sources[i].position - at.position).squaredNorm() + 4 * at.depth * depths[i] + resolution;
    sum += sources[i].moment / (r2 * std::sqrt(r2));
  }
  return sum;
}
} // namespace

void ChangeSources::add(const Vec3 &x, const Mat3 &moment)
{
  const double magnitude = moment.norm();
  if (magnitude == 0)
    return;
  std::array<int, 3> cube;
  for (int c = 0; c < 3; ++c)
    cube[static_cast<std::size_t>(c)] = static_cast<int>(std::floor(x[c] / edge));
  Sum &sum = cubes[cube];
  sum.weighted_position += magnitude * x;
  sum.weight += magnitude;
  sum.moment += moment;
}

std::vector<ChangeSources::Source> ChangeSources::sources() const
{
  std::vector<Source> result;
  for (const auto &[cube, sum] : cubes)
    result.push_back({sum.weighted_position / sum.weight, sum.moment});
  return result;
}

CorrectionUpdate::CorrectionUpdate(FiniteGrain &finite_grain, const IsotropicMedium &elastic_medium,
                                   const double allowed_error)
    : grain(finite_grain), medium(elastic_medium), tolerance(allowed_error),
      since_last(0.5 * finite_grain.element_size()), between(0.5 * finite_grain.element_size())
{
}

void CorrectionUpdate::add_swept(const SweptArea &area)
{
  if (!enabled())
    return;
  for (const SweptTriangle &t : area.triangles())
    if (t.inside)
    {
      const Vec3 &origin = t.vertices[0].value;
      const Vec3 normal_area = 0.5 * (t.vertices[1].value - origin).cross(t.vertices[2].value - origin);
      const Vec3 centre = (origin + t.vertices[1].value + t.vertices[2].value) / 3;
      since_last.add(centre, t.burgers * normal_area.transpose());
    }
  load_change += grain.load_of_swept_area(area);
}

double force_norm(const Network &network, const SegmentPoints &points, const std::vector<SymTensor> &stress)
{
  double sum = 0, length = 0;
  std::size_t i = 0;
  for (const SegmentIndex s : network.segments())
  {
    const Vec3 b = network.burgers(s).normalized(), xi = network.direction(s).normalized();
    const auto weights = points.weights(i);
    for (std::size_t q = 0; q < weights.size(); ++q)
      sum += network.length(s) * weights[q] * contract(stress[points.begin_of(i) + q], b).cross(xi).squaredNorm();
    length += network.length(s);
    ++i;
  }
  return length > 0 ? std::sqrt(sum / length) : 0.0;
}

void CorrectionUpdate::set_scale(const Network &network, const SegmentField &correction)
{
  if (!enabled())
    return;
  double burgers = 0;
  for (const SegmentIndex s : network.segments())
    burgers = std::max(burgers, network.burgers(s).norm());
  scale = std::max(force_norm(network, correction.points, correction.stress),
                   medium.mu * burgers / grain.shape().diameter());
}

CorrectionUpdate::ImageLines CorrectionUpdate::image_lines(const Network &network) const
{
  ImageLines lines;
  const auto &planes = grain.planes_with_images();
  const double depth = grain.depth_of_images();
  for (const SegmentIndex s : network.segments())
  {
    const Vec3 start = network.position(network.start(s)), line = network.direction(s);
    for (std::size_t p = 0; p < planes.size(); ++p)
    {
      const double d_start = (planes[p].point - start).dot(planes[p].outward);
      if (std::min(d_start, d_start - line.dot(planes[p].outward)) >= depth)
        continue;
      // A segment that gains an image takes the field of a strip from there into the depth from the finite elements; at
      // the strip's upper end that is the field of a loop half as high as it lies deep.
      const double height = std::max(0.0, 0.5 * (d_start - 0.5 * line.dot(planes[p].outward)));
      const Vec3 strip = height * line.cross(planes[p].outward);
      lines[{network.id(s), p}] = {start + 0.5 * line, network.burgers(s) * strip.transpose()};
    }
  }
  return lines;
}

ChangeSources CorrectionUpdate::all_since(const Network &network) const
{
  ChangeSources all = since_last;
  const ImageLines now = image_lines(network);
  for (const auto &[key, source] : now)
    if (!lines_with_image.contains(key))
      all.add(source.position, source.moment);
  for (const auto &[key, source] : lines_with_image)
    if (!now.contains(key))
      all.add(source.position, -source.moment);
  return all;
}

/// Means over the segments of the squares of the two fields of sources, and of their product: since . since, since . between,
/// between . between.
std::array<double, 3> CorrectionUpdate::products(const Network &network, const ChangeSources &since) const
{
  std::vector<Receiver> receivers;
  const std::size_t stride = network.n_segments() / most_receivers + 1;
  std::size_t i = 0;
  for (const SegmentIndex s : network.segments())
    if (i++ % stride == 0)
    {
      const Vec3 x = network.position(network.start(s)) + 0.5 * network.direction(s);
      receivers.push_back({x, network.length(s), grain.depth_for_elements(x)});
    }
  const std::array<std::vector<ChangeSources::Source>, 2> sources{since.sources(), between.sources()};
  std::array<std::vector<double>, 2> depths;
  for (std::size_t k = 0; k < 2; ++k)
    for (const auto &source : sources[k])
      depths[k].push_back(grain.depth_for_elements(source.position));
  const double resolution = grain.element_size() * grain.element_size();
  std::vector<std::array<double, 3>> terms(receivers.size());
#pragma omp parallel for schedule(static)
  for (std::size_t r = 0; r < receivers.size(); ++r)
  {
    const Mat3 a = image_field(receivers[r], sources[0], depths[0], resolution);
    const Mat3 b = image_field(receivers[r], sources[1], depths[1], resolution);
    terms[r] = {a.squaredNorm(), a.cwiseProduct(b).sum(), b.squaredNorm()};
  }
  std::array<double, 3> sums{};
  double length = 0;
  for (std::size_t r = 0; r < receivers.size(); ++r)
  {
    for (std::size_t k = 0; k < 3; ++k)
      sums[k] += receivers[r].length * terms[r][k];
    length += receivers[r].length;
  }
  for (double &s : sums)
    s /= std::max(length, 1e-300);
  return sums;
}

CorrectionUpdate::Prediction CorrectionUpdate::predict(const Network &network, const ChangeSources &since) const
{
  const auto [new_new, new_old, old_old] = products(network, since);
  const double theta = states.size() > 1 && old_old > 0 ? new_old / old_old : 0.0;
  const double rest = std::max(0.0, new_new - theta * new_old);
  const double amplitude = images_seen * medium.mu / (2 * std::numbers::pi * (1 - medium.nu));
  // What fits badly is not extrapolated.
  constexpr double good_fit = 0.5;
  if (rest > good_fit * good_fit * new_new)
    return {0, amplitude * std::sqrt(new_new)};
  return {theta, amplitude * (std::sqrt(rest) + distrust * std::sqrt(new_new))};
}

bool CorrectionUpdate::must_solve(const Network &network) const
{
  return !enabled() || states.empty() || skipped >= most_skips || count_surface_nodes(network) != surface_nodes;
}

GrainSolution CorrectionUpdate::solve_at_rest(const LineSystem &lines, const Network &network)
{
  if (!must_solve(network))
  {
    const Prediction p = predict(network, all_since(network));
    last_estimate = p.error / scale;
    if (last_estimate <= tolerance)
      return extrapolate(lines, p.theta);
  }
  return solve(lines, network);
}

GrainSolution CorrectionUpdate::solve(const LineSystem &lines, const Network &network)
{
  last_solution = grain.solve_at_rest(lines);
  ++n.solves;
  last_estimate = 0;
  if (!enabled())
    return last_solution;
  between = all_since(network);
  since_last = ChangeSources(0.5 * grain.element_size());
  lines_with_image = image_lines(network);
  surface_nodes = count_surface_nodes(network);
  load_change = 0;
  skipped = 0;
  states.insert(states.begin(), grain.element_state());
  if (states.size() > 2)
    states.pop_back();
  return last_solution;
}

GrainSolution CorrectionUpdate::extrapolate(const LineSystem &lines, const double theta)
{
  FiniteGrain::ElementState state = states[0];
  if (states.size() > 1)
  {
    for (std::size_t i = 0; i < state.unknowns.size(); ++i)
      state.unknowns[i] += theta * (states[0].unknowns[i] - states[1].unknowns[i]);
    for (std::size_t i = 0; i < state.load.size(); ++i)
      state.load[i] += theta * (states[0].load[i] - states[1].load[i]);
  }
  GrainSolution solution = last_solution;
  grain.extrapolate_to(lines, state, last_solution.load_at_rest + load_change, solution);
  ++n.skips;
  ++skipped;
  return solution;
}

void CorrectionUpdate::forget()
{
  states.clear();
}
} // namespace ddfem::coupling
