#include "dd/topology/screw_runs.h"

#include "dd/topology/line_operations.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace ddfem
{
namespace
{
bool is_screw(const Network &network, const SegmentIndex s, const double cosine)
{
  const Vec3 t = network.direction(s);
  return network.plane(s).is_valid() &&
         std::abs(t.dot(network.burgers(s))) >= cosine * t.norm() * network.burgers(s).norm();
}

/// Appends what continues the run beyond its last node.
void extend(const Network &network, ScrewRun &run, const double cosine, std::vector<bool> &visited)
{
  while (is_discretisation_node(network, run.nodes.back()))
  {
    const auto arms = network.connected_segments(run.nodes.back());
    const SegmentIndex next = arms[0] == run.segments.back() ? arms[1] : arms[0];
    if (visited[next.value] || !is_screw(network, next, cosine))
      return;
    visited[next.value] = true;
    const NodeIndex far = network.other_end(next, run.nodes.back());
    run.segments.push_back(next);
    run.nodes.push_back(far);
  }
}

ScrewRun run_through(const Network &network, const SegmentIndex s, const double cosine, std::vector<bool> &visited)
{
  ScrewRun run;
  visited[s.value] = true;
  run.segments = {s};
  run.nodes = {network.end(s), network.start(s)};
  extend(network, run, cosine, visited);
  std::ranges::reverse(run.nodes);
  std::ranges::reverse(run.segments);
  extend(network, run, cosine, visited);
  return run;
}

void drop_end(ScrewRun &run, const bool first)
{
  if (first)
  {
    run.nodes.erase(run.nodes.begin());
    run.segments.erase(run.segments.begin());
  }
  else
  {
    run.nodes.pop_back();
    run.segments.pop_back();
  }
}

/// Positions of the nodes, unfolded along the line, nm.
std::vector<Vec3> positions(const Network &network, const ScrewRun &run)
{
  std::vector<Vec3> x{network.position(run.nodes[0])};
  for (std::size_t k = 0; k < run.segments.size(); ++k)
    x.emplace_back(x[k] + network.minimum_image(network.position(run.nodes[k + 1]) - network.position(run.nodes[k])));
  return x;
}

/// Which end must go before the run can be straight, if one must; otherwise the shifts are set.
enum class Misfit
{
  none,
  first,
  last
};

Misfit straighten(const Network &network, ScrewRun &run, const double largest_shift)
{
  const std::vector<Vec3> x = positions(network, run);
  const Vec3 e = run.burgers.normalized();
  const bool first_is_held = !is_discretisation_node(network, run.nodes.front());
  const bool last_is_held = !is_discretisation_node(network, run.nodes.back());
  Vec3 through = first_is_held ? x.front() : last_is_held ? x.back() : Vec3(Vec3::Zero());
  if (!first_is_held && !last_is_held)
    for (const Vec3 &point : x)
      through += point / static_cast<double>(x.size());
  run.shift.clear();
  for (const Vec3 &point : x)
  {
    const Vec3 away = through - point;
    run.shift.emplace_back(away - e * e.dot(away));
  }
  if (first_is_held && last_is_held && run.shift.back().norm() > GlidePlanes::offset_quantum)
    return Misfit::last;
  if (first_is_held)
    run.shift.front().setZero();
  if (last_is_held)
    run.shift.back().setZero();
  const auto farthest = std::ranges::max(run.shift, {}, [](const Vec3 &d) { return d.norm(); });
  if (farthest.norm() <= largest_shift)
    return Misfit::none;
  return run.shift.front().norm() > run.shift.back().norm() ? Misfit::first : Misfit::last;
}

/// Trims the run until it can be straight; whether something long enough remains.
bool finish(const TopologyContext &context, ScrewRun &run)
{
  const Network &network = context.network;
  run.burgers = network.burgers_from(run.segments[0], run.nodes[0]);
  Misfit misfit = straighten(network, run, context.settings.collision_radius);
  while (misfit != Misfit::none)
  {
    if (run.segments.size() == 1)
      return false;
    drop_end(run, misfit == Misfit::first);
    misfit = straighten(network, run, context.settings.collision_radius);
  }
  const std::vector<Vec3> x = positions(network, run);
  run.length = std::abs((x.back() - x.front()).dot(run.burgers.normalized()));
  run.id = network.id(*std::ranges::min_element(run.segments, {}, [&](const SegmentIndex s) { return network.id(s); }));
  return run.length >= 2 * context.settings.min_segment;
}
} // namespace

std::optional<ScrewRun> moved_onto_line(const Network &network, const ScrewRun &run, const Vec3 &point,
                                        const double largest_shift)
{
  ScrewRun moved = run;
  for (const bool first : {true, false})
    if (!is_discretisation_node(network, first ? moved.nodes.front() : moved.nodes.back()))
    {
      if (moved.segments.size() == 1)
        return std::nullopt;
      drop_end(moved, first);
    }
  const Vec3 e = run.burgers.normalized();
  moved.shift.clear();
  for (const NodeIndex i : moved.nodes)
  {
    const Vec3 away = network.minimum_image(point - network.position(i));
    moved.shift.emplace_back(away - e * e.dot(away));
    if (moved.shift.back().norm() > largest_shift)
      return std::nullopt;
  }
  return moved;
}

std::vector<ScrewRun> screw_runs(const TopologyContext &context, const double cosine)
{
  const Network &network = context.network;
  std::vector<SegmentIndex> segments(network.segments().begin(), network.segments().end());
  // The direction of a run is that of its first segment: it must not depend on the order in memory.
  std::ranges::sort(segments, {}, [&](const SegmentIndex s) { return network.id(s); });
  std::vector<bool> visited(network.segment_capacity(), false);
  std::vector<ScrewRun> runs;
  for (const SegmentIndex s : segments)
    if (!visited[s.value] && is_screw(network, s, cosine))
      if (ScrewRun run = run_through(network, s, cosine, visited); finish(context, run))
        runs.push_back(std::move(run));
  std::ranges::sort(runs, {}, &ScrewRun::id);
  return runs;
}
} // namespace ddfem
