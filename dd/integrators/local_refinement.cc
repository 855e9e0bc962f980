#include "dd/integrators/local_refinement.h"

#include "dd/integrators/chebyshev_steps.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ddfem
{
namespace
{
/// Halvings of the step at most, a node more than that is a failure of the whole.
constexpr unsigned deepest = 10;
/// Parts into which a step is divided at most at once.
constexpr double most_parts = 8;
/// One node in this many may be stiffer than the stages of a set bear.
constexpr std::size_t one_in_stiff = 10;
constexpr unsigned most_stages = 250;
/// With more than this share of the nodes to be integrated again, all are.
constexpr double largest_share = 0.5;
/// Rings of neighbours that are integrated again with a node.
constexpr int n_rings = 2;
/// Segments whose forces are worth waking other threads.
constexpr std::size_t worth_a_team = 48;
} // namespace

Vec3 LocalRefinement::Path::at(const double time) const
{
  if (duration == 0)
    return start;
  const double s = (time - begin) / duration, h = duration;
  return start + s * s * (3 - 2 * s) * displacement + s * (1 - s) * (1 - s) * h * velocity_at_start -
         s * s * (1 - s) * h * velocity_at_end;
}

LocalRefinement::LocalRefinement(Network &network_, const SplitForces &forces_, const NearForces &near_,
                                 const std::vector<double> &stiffness_, const std::vector<double> &tolerance_,
                                 const double step)
    : network(network_), forces(forces_), near(near_), stiffness(stiffness_), tolerance(tolerance_), whole(step),
      path_of(network_.node_capacity()), node_mark(network_.node_capacity(), 0),
      segment_mark(network_.segment_capacity(), 0), number(network_.segment_capacity(), 0),
      is_refined(network_.node_capacity(), 0)
{
}

std::size_t LocalRefinement::refined_nodes() const
{
  return static_cast<std::size_t>(std::count(is_refined.begin(), is_refined.end(), 1));
}

bool LocalRefinement::solve(const FarForces &far_forces, const std::vector<Vec3> &positions)
{
  far = &far_forces;
  y = positions;
  way.clear();
  for (const NodeIndex i : network.nodes())
  {
    network.set_position(i, y[i.value]);
    path_of[i.value] = Path{.start = y[i.value]};
  }
  std::vector<NodeIndex> moving = moving_nodes();
  return moving.empty() || advance(group_of(std::move(moving)), {0.0, whole}, 0, false);
}

bool LocalRefinement::solve_again(const FarForces &far_forces, const std::vector<Vec3> &positions,
                                  std::vector<NodeIndex> changed)
{
  far = &far_forces;
  const std::vector<NodeIndex> moving = moving_nodes();
  // A node with shorter steps has left no path over the whole step that others could follow.
  for (const NodeIndex i : moving)
    if (is_refined[i.value])
      changed.push_back(i);
  changed = with_neighbours(moving, changed);
  if (changed.empty())
    return true;
  for (const NodeIndex i : changed)
    y[i.value] = positions[i.value];
  way.clear();
  return advance(group_of(std::move(changed)), {0.0, whole}, 0, false);
}

std::vector<NodeIndex> LocalRefinement::moving_nodes() const
{
  std::vector<NodeIndex> moving;
  for (const NodeIndex i : network.nodes())
    if (stiffness[i.value] > 0)
      moving.push_back(i);
  return moving;
}

LocalRefinement::Group LocalRefinement::group_of(std::vector<NodeIndex> nodes)
{
  Group g;
  g.nodes = std::move(nodes);
  ++mark;
  for (const NodeIndex i : g.nodes)
    node_mark[i.value] = mark;
  const auto add_boundary = [&](const SegmentIndex s)
  {
    for (const NodeIndex i : {network.start(s), network.end(s)})
      if (std::exchange(node_mark[i.value], mark) != mark)
        g.boundary.push_back(i);
  };
  g.first_arm.push_back(0);
  for (const NodeIndex i : g.nodes)
  {
    for (const SegmentIndex s : network.connected_segments(i))
    {
      if (std::exchange(segment_mark[s.value], mark) != mark)
      {
        number[s.value] = static_cast<std::uint32_t>(g.segments.size());
        g.segments.push_back(s);
      }
      g.arms.push_back(number[s.value]);
    }
    g.first_arm.push_back(static_cast<std::uint32_t>(g.arms.size()));
  }
  for (const SegmentIndex s : g.segments)
  {
    add_boundary(s);
    for (const SegmentIndex r : near.sources(s))
      add_boundary(r);
  }
  // What stands still has its place already.
  std::erase_if(g.boundary, [&](const NodeIndex i) { return !(stiffness[i.value] > 0); });
  return g;
}

/// Those that are in @p nodes or near them along the lines, in the order of @p among.
std::vector<NodeIndex> LocalRefinement::with_neighbours(const std::vector<NodeIndex> &among,
                                                        const std::vector<NodeIndex> &nodes)
{
  ++mark;
  std::vector<NodeIndex> ring = nodes;
  for (const NodeIndex i : ring)
    node_mark[i.value] = mark;
  for (int k = 0; k < n_rings; ++k)
  {
    std::vector<NodeIndex> next;
    for (const NodeIndex i : ring)
      for (const SegmentIndex s : network.connected_segments(i))
        if (const NodeIndex j = network.other_end(s, i); std::exchange(node_mark[j.value], mark) != mark)
          next.push_back(j);
    ring = std::move(next);
  }
  std::vector<NodeIndex> result;
  for (const NodeIndex i : among)
    if (node_mark[i.value] == mark)
      result.push_back(i);
  return result;
}

void LocalRefinement::place_boundary(const Group &group, const double time)
{
  for (const NodeIndex i : group.boundary)
    network.set_position(i, path_of[i.value].at(time));
}

/// Of the nodes of the group where they are now. @p fastest: stiffness to which nodes are slowed down, 1/ns.
std::vector<Vec3> LocalRefinement::velocities(const Group &group, const double time, const double fastest)
{
  const std::size_t n = group.segments.size();
  n_evaluated += n;
  std::vector<SegmentForces> on_segments(n);
  std::vector<Vec3> v(group.nodes.size());
  const double part = time / whole;
#pragma omp parallel if (n > worth_a_team)
  {
    LineTable scratch;
#pragma omp for schedule(dynamic, 16)
    for (std::size_t k = 0; k < n; ++k)
    {
      const SegmentIndex s = group.segments[k];
      on_segments[k] = near.on(network, s, scratch);
      const SegmentForces g = far->on(network, s, part);
      on_segments[k].start += g.start;
      on_segments[k].end += g.end;
    }
#pragma omp for schedule(static)
    for (std::size_t k = 0; k < group.nodes.size(); ++k)
    {
      const NodeIndex i = group.nodes[k];
      Vec3 f = Vec3::Zero();
      for (std::uint32_t a = group.first_arm[k]; a < group.first_arm[k + 1]; ++a)
      {
        const SegmentForces &on_arm = on_segments[group.arms[a]];
        f += network.start(group.segments[group.arms[a]]) == i ? on_arm.start : on_arm.end;
      }
      v[k] = std::min(1.0, fastest / stiffness[i.value]) * forces.velocity(network, i, f);
    }
  }
  return v;
}

/// One step of the group from where its nodes have come to. Sets their paths and where they end.
LocalRefinement::Outcome LocalRefinement::step(const Group &group, const Interval &interval, const unsigned n_stages)
{
  const ChebyshevSteps method(n_stages);
  const double h = interval.duration, fastest = ChebyshevSteps::stability_bound(n_stages) / h;
  const std::size_t n = group.nodes.size();
  std::vector<Vec3> d_old(n, Vec3::Zero()), d(n), d_new(n);
  const auto velocity_at = [&](const double time)
  {
    place_boundary(group, time);
    for (std::size_t k = 0; k < n; ++k)
      network.set_position(group.nodes[k], y[group.nodes[k].value] + d[k]);
    return velocities(group, time, fastest);
  };
  std::fill(d.begin(), d.end(), Vec3::Zero());
  const std::vector<Vec3> f0 = velocity_at(interval.begin);
  for (std::size_t k = 0; k < n; ++k)
    d[k] = method[1].mu_tilde * h * f0[k];
  for (unsigned j = 2; j <= n_stages; ++j)
  {
    const ChebyshevSteps::Coefficients &c = method[j];
    const std::vector<Vec3> f = velocity_at(interval.begin + method.time(j - 1) * h);
    for (std::size_t k = 0; k < n; ++k)
      d_new[k] = c.mu * d[k] + c.nu * d_old[k] + c.mu_tilde * h * f[k] + c.gamma_tilde * h * f0[k];
    std::swap(d_old, d);
    std::swap(d, d_new);
  }
  const std::vector<Vec3> f1 = velocity_at(interval.begin + h);
  Outcome outcome;
  for (std::size_t k = 0; k < n; ++k)
  {
    const NodeIndex i = group.nodes[k];
    const double error = ChebyshevSteps::error<Vec3>(d[k], h, f0[k], f1[k]).norm() / tolerance[i.value];
    path_of[i.value] = {interval.begin, h, y[i.value], d[k], f0[k], f1[k]};
    y[i.value] += d[k];
    outcome.worst = std::isfinite(error) ? std::max(outcome.worst, error) : 1e300;
    if (!(error <= 1))
      outcome.inaccurate.push_back(i);
    if (stiffness[i.value] > fastest)
      outcome.slowed.push_back(i);
  }
  return outcome;
}

/// Largest of the group, or such that few are larger.
double LocalRefinement::stiffness_of(const Group &group, const bool of_most) const
{
  std::vector<double> all;
  for (const NodeIndex i : group.nodes)
    all.push_back(stiffness[i.value]);
  const auto rank = static_cast<std::ptrdiff_t>(all.size() - 1 - (of_most ? all.size() / one_in_stiff : 0));
  std::nth_element(all.begin(), all.begin() + rank, all.end());
  return all[static_cast<std::size_t>(rank)];
}

void LocalRefinement::restore(const Group &group, const std::vector<Vec3> &places)
{
  for (std::size_t k = 0; k < group.nodes.size(); ++k)
    y[group.nodes[k].value] = places[k];
}

/// Takes the group over an interval. @p all_stages: as many as its stiffest node needs.
bool LocalRefinement::advance(const Group &group, const Interval &interval, const unsigned depth, const bool all_stages)
{
  std::vector<Vec3> before;
  for (const NodeIndex i : group.nodes)
    before.push_back(y[i.value]);
  const double largest = stiffness_of(group, !all_stages);
  const unsigned stages = std::min(most_stages, ChebyshevSteps::stages_for(interval.duration * largest));
  Outcome outcome = step(group, interval, stages);
  if (outcome.inaccurate.empty() && outcome.slowed.empty())
    return true;
  const bool needs_parts = !outcome.inaccurate.empty() || stages == most_stages;
  std::vector<NodeIndex> again = std::move(outcome.inaccurate);
  again.insert(again.end(), outcome.slowed.begin(), outcome.slowed.end());
  again = with_neighbours(group.nodes, again);
  const bool all = static_cast<double>(again.size()) > largest_share * static_cast<double>(group.nodes.size());
  std::vector<Vec3> start;
  for (std::size_t k = 0, r = 0; k < group.nodes.size() && r < again.size(); ++k)
    if (group.nodes[k] == again[r])
    {
      y[again[r].value] = before[k];
      ++r;
    }
  if (all)
    restore(group, before);
  const Group next = all ? group : group_of(std::move(again));
  for (const NodeIndex i : next.nodes)
    is_refined[i.value] = 1;
  return needs_parts ? advance_in_parts(next, interval, depth, outcome.worst) : advance(next, interval, depth, true);
}

bool LocalRefinement::advance_in_parts(const Group &group, const Interval &interval, const unsigned depth,
                                       const double worst)
{
  const double n = std::clamp(std::ceil(1.25 * std::cbrt(worst)), 2.0, most_parts);
  const unsigned deeper = depth + static_cast<unsigned>(std::ceil(std::log2(n)));
  if (deeper > deepest)
    return false;
  for (double k = 0; k < n; ++k)
  {
    if (!advance(group, {interval.begin + k / n * interval.duration, interval.duration / n}, deeper, false))
      return false;
    for (const NodeIndex i : group.nodes)
      way.add(i, (interval.begin + (k + 1) / n * interval.duration) / whole, y[i.value]);
  }
  return true;
}
} // namespace ddfem
