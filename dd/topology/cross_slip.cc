#include "dd/topology/cross_slip.h"

#include "dd/common/random.h"
#include "dd/topology/line_operations.h"
#include "dd/topology/screw_runs.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace ddfem
{
namespace
{
/// Number of the crystal's plane on which segment @p s lies, among those of its Burgers vector.
std::optional<std::size_t> plane_number(const Network &network, const SlipSystems &systems, const SegmentIndex s,
                                        const std::vector<std::size_t> &planes)
{
  constexpr double parallel_sine = 1e-4;
  const auto found =
      std::ranges::find_if(planes, [&](const std::size_t p)
                           { return systems.planes()[p].normal.cross(network.normal(s)).norm() < parallel_sine; });
  return found == planes.end() ? std::nullopt : std::optional(*found);
}

/// A run that may go to other planes.
struct Candidate
{
  ScrewRun run;
  std::size_t present;             ///< plane, as a number of SlipSystems::planes()
  std::vector<std::size_t> others; ///< likewise
};

std::vector<Candidate> candidates(const TopologyContext &context, const CrossSlipSettings &settings,
                                  const SlipSystems &systems)
{
  std::vector<Candidate> found;
  for (ScrewRun &run : screw_runs(context, std::cos(settings.screw_angle)))
  {
    std::vector<std::size_t> planes = systems.glissile_planes(run.burgers);
    const auto present = plane_number(context.network, systems, run.segments[0], planes);
    if (!present)
      continue;
    std::erase(planes, *present);
    if (!planes.empty())
      found.push_back({std::move(run), *present, std::move(planes)});
  }
  return found;
}

/// Mean stress on each run.
std::vector<SymTensor> mean_stresses(const Network &network, const std::vector<Candidate> &found,
                                     const StressFunction &stress)
{
  std::vector<Vec3> points;
  for (const Candidate &c : found)
    for (std::size_t k = 0; k < c.run.segments.size(); ++k)
      points.push_back(c.run.middle_of(network, k));
  const std::vector<SymTensor> at_points = stress(points);
  std::vector<SymTensor> means;
  std::size_t point = 0;
  for (const Candidate &c : found)
  {
    SymTensor sum = SymTensor::Zero();
    double length = 0;
    for (const SegmentIndex s : c.run.segments)
    {
      sum += network.length(s) * at_points[point++];
      length += network.length(s);
    }
    means.emplace_back(sum / length);
  }
  return means;
}

/// The plane to which the run goes in this step, if to any.
std::optional<std::size_t> new_plane(const Candidate &c, const SymTensor &stress, const CrossSlipSettings &settings,
                                     const SlipSystems &systems, const CrossSlipStep &step)
{
  const auto on_plane = [&](const std::size_t p)
  { return screw_stress(systems, stress, c.run.burgers, systems.planes()[p].normal); };
  const ScrewStress present = on_plane(c.present);
  const std::size_t best =
      *std::ranges::max_element(c.others, {}, [&](const std::size_t p) { return on_plane(p).schmid; });
  const ScrewStress there = on_plane(best);
  const bool at_once = settings.model == CrossSlipModel::largest_stress;
  if (!(there.schmid > (at_once ? settings.hysteresis : settings.stress_ratio) * present.schmid))
    return std::nullopt;
  if (at_once)
    return best;
  const double rate = settings.law.rate(c.run.length, present, there);
  const double probability = -std::expm1(-rate * step.dt);
  const CounterRandom random(step.seed, c.run.id, step.number, RandomPurpose::cross_slip);
  return random.uniform() < probability ? std::optional(best) : std::nullopt;
}

/// A point of the nearest other run with the opposite Burgers vector that passes beside this one within a collision radius; empty if
/// there is none.
std::optional<Vec3> opposite_screw(const TopologyContext &context, const std::vector<Candidate> &found,
                                   const std::size_t number)
{
  const Network &network = context.network;
  const ScrewRun &run = found[number].run;
  const Vec3 e = run.burgers.normalized(), middle = network.position(run.nodes[run.nodes.size() / 2]);
  double nearest = context.settings.collision_radius;
  std::optional<Vec3> point;
  for (const Candidate &c : found)
  {
    const bool is_opposite = c.run.is_right_handed(network) != run.is_right_handed(network);
    if (!is_opposite || c.run.burgers.cross(e).norm() > 1e-6 * c.run.burgers.norm())
      continue;
    for (const NodeIndex i : c.run.nodes)
    {
      const Vec3 away = network.minimum_image(network.position(i) - middle);
      const double along = e.dot(away), distance = (away - along * e).norm();
      if (distance < nearest && std::abs(along) < 0.5 * run.length)
      {
        nearest = distance;
        point = network.position(i);
      }
    }
  }
  return point;
}

/// Run number @p number where it is to lie when it changes to @p plane.
ScrewRun placed_run(const TopologyContext &context, const std::vector<Candidate> &found, const std::size_t number,
                    const SlipPlane &plane)
{
  const ScrewRun &run = found[number].run;
  if (const auto other = opposite_screw(context, found, number))
  {
    // In the present plane to where the new one holds the other line.
    const Network &network = context.network;
    const Vec3 n = network.normal(run.segments[0]), across = n.cross(run.burgers).normalized();
    const Vec3 &x = network.position(run.nodes[run.nodes.size() / 2]);
    const double way = plane.normal.dot(network.minimum_image(*other - x)) / plane.normal.dot(across);
    if (auto moved = moved_onto_line(network, run, x + way * across, 2 * context.settings.collision_radius))
      return *moved;
  }
  return run;
}

/// Whether the nodes of the run are still free to be moved to where it is straight, and would be inside the grain.
bool can_be_straightened(const TopologyContext &context, const ScrewRun &run)
{
  const Network &network = context.network;
  for (std::size_t k = 0; k < run.nodes.size(); ++k)
    if (!run.shift[k].isZero(0))
      if (!is_discretisation_node(network, run.nodes[k]) ||
          (context.shape && context.shape->signed_distance(network.position(run.nodes[k]) + run.shift[k]) > 0))
        return false;
  return true;
}

void perform(TopologyContext &context, const ScrewRun &run, const SlipPlane &plane)
{
  Network &network = context.network;
  const bool is_closed = run.nodes.front() == run.nodes.back(); // through a periodic cell
  for (std::size_t k = is_closed ? 1 : 0; k < run.nodes.size(); ++k)
    move_node(context, run.nodes[k], network.position(run.nodes[k]) + run.shift[k]);
  std::vector<SegmentIndex> segments = run.segments;
  if (segments.size() == 1) // a straight line between two nodes on both planes could not bow out
  {
    const NodeIndex m = split_segment(context, segments[0], run.middle_of(network, 0), Vec3::Zero());
    const auto halves = network.connected_segments(m);
    segments.assign(halves.begin(), halves.end());
  }
  for (const SegmentIndex s : segments)
  {
    Segment moved = network.get(s);
    moved.plane = network.planes().find_or_insert(plane.miller, plane.normal, network.position(moved.start));
    network.set(s, moved);
  }
  ++context.counts.cross_slips;
}
} // namespace

void cross_slip(TopologyContext &context, const CrossSlipSettings &settings, const SlipSystems &systems,
                const CrossSlipStep &step, const StressFunction &stress)
{
  if (settings.model == CrossSlipModel::off)
    return;
  const std::vector<Candidate> found = candidates(context, settings, systems);
  if (found.empty())
    return;
  const std::vector<SymTensor> stresses = mean_stresses(context.network, found, stress);
  for (std::size_t k = 0; k < found.size(); ++k)
    if (const auto plane = new_plane(found[k], stresses[k], settings, systems, step))
    {
      const ScrewRun run = placed_run(context, found, k, systems.planes()[*plane]);
      if (can_be_straightened(context, run))
        perform(context, run, systems.planes()[*plane]);
    }
}
} // namespace ddfem
