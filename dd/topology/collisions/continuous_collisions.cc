#include "dd/topology/collisions/continuous_collisions.h"

#include "dd/mobility/glide_constraints.h"
#include "dd/topology/collisions/collision_events.h"
#include "dd/topology/collisions/contact.h"
#include "dd/topology/collisions/islands.h"
#include "dd/topology/collisions/merging.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace ddfem
{
namespace
{
/// How often two lines may cut each other within a step.
constexpr unsigned most_meetings = 3;

/// What an event has changed: everything around one node, from some time on.
struct Change
{
  NodeIndex node;
  double time;
  SegmentIndex island; ///< one segment of it, perhaps gone
};

class CollisionHandler
{
public:
  CollisionHandler(TopologyContext &c, CandidateList &list, const CollisionSettings &s)
      : context(c), network(c.network), candidates(list), settings(s)
  {
  }

  CollisionReport run();

private:
  using Queue = std::set<CollisionEvent>;
  /// A node (first true) or a lineage, and a lineage.
  using Meeting = std::tuple<bool, ObjectId, ObjectId>;

  void push(CollisionEvent event);
  std::uint32_t unite(std::uint32_t a, std::uint32_t b);
  std::vector<CollisionEvent> next_round();
  bool is_stale(const CollisionEvent &event) const;
  std::optional<Change> handle(const CollisionEvent &event);
  bool use_up(const MergePlan &plan);
  void retry_at_closest(CollisionEvent event);
  void set_motion(NodeIndex i, const MergePlan &plan);
  void announce(const Change &change);
  void detect_again(const std::vector<Change> &changes);

  TopologyContext &context;
  Network &network;
  CandidateList &candidates;
  const CollisionSettings &settings;
  Islands islands;
  std::map<std::uint32_t, Queue> queues; ///< by island
  std::map<Meeting, unsigned> meetings;
  std::vector<std::uint64_t> changed_at; ///< stamp of the last change, by NodeIndex::value
  std::uint64_t stamp = 0;
  CollisionReport report;
};

void CollisionHandler::push(CollisionEvent event)
{
  event.stamp = stamp;
  queues[unite(islands.of(event.first), islands.of(event.second))].insert(event);
}

/// Makes two islands one, with their events.
std::uint32_t CollisionHandler::unite(const std::uint32_t a, const std::uint32_t b)
{
  const std::uint32_t kept = islands.unite(a, b), gone = std::max(a, b);
  if (const auto found = queues.find(gone); kept != gone && found != queues.end())
  {
    Queue moved = std::move(found->second);
    queues.erase(found);
    queues[kept].merge(moved);
  }
  return kept;
}

bool CollisionHandler::is_stale(const CollisionEvent &event) const
{
  for (const SegmentIndex s : {event.first, event.second})
  {
    if (!network.contains(s))
      return true;
    for (const NodeIndex i : {network.start(s), network.end(s)})
      if (i.value < changed_at.size() && changed_at[i.value] > event.stamp)
        return true;
  }
  return false;
}

/// The earliest event of every island, in the order of events.
std::vector<CollisionEvent> CollisionHandler::next_round()
{
  std::vector<CollisionEvent> round;
  for (auto q = queues.begin(); q != queues.end();)
  {
    Queue &queue = q->second;
    while (!queue.empty() && is_stale(*queue.begin()))
      queue.erase(queue.begin());
    if (queue.empty())
      q = queues.erase(q);
    else
    {
      round.push_back(*queue.begin());
      queue.erase(queue.begin());
      ++q;
    }
  }
  std::sort(round.begin(), round.end());
  return round;
}

bool CollisionHandler::use_up(const MergePlan &plan)
{
  const auto lineage = [&](const MergePlan::End &e) { return context.origin(e.point.segment).lineage; };
  const auto &[a, b] = plan.ends;
  if (!a.is_cut() && !b.is_cut())
    return true;
  Meeting meeting;
  if (a.is_cut() && b.is_cut())
  {
    const ObjectId p = lineage(a), q = lineage(b);
    meeting = {false, std::min(p, q), std::max(p, q)};
  }
  else
    meeting =
        a.is_cut() ? Meeting{true, network.id(b.node), lineage(a)} : Meeting{true, network.id(a.node), lineage(b)};
  return ++meetings[meeting] <= most_meetings;
}

void CollisionHandler::retry_at_closest(CollisionEvent event)
{
  if (event.at_closest || event.closest_time <= event.time)
  {
    ++report.refused;
    return;
  }
  const auto later = nearest_fractions(context, event.first, event.second, event.closest_time);
  event.time = event.closest_time;
  event.first_fraction = later.first;
  event.second_fraction = later.second;
  event.at_closest = true;
  queues[islands.of(event.first)].insert(event);
}

/// Annex B.3: the mean of the displacements at the start of the step, for the rest of it.
void CollisionHandler::set_motion(const NodeIndex i, const MergePlan &plan)
{
  const Vec3 mean = 0.5 * (plan.ends[0].displacement + plan.ends[1].displacement);
  context.remaining[i.value] = (1 - plan.time) * (glide_projector(network, i, context.shape) * mean);
}

std::optional<Change> CollisionHandler::handle(const CollisionEvent &event)
{
  const auto plan =
      plan_merge(context, {event.first, event.first_fraction}, {event.second, event.second_fraction}, event.time);
  if (!plan)
  {
    retry_at_closest(event);
    return std::nullopt;
  }
  if (!use_up(*plan))
  {
    ++report.exhausted;
    return std::nullopt;
  }
  const NodeIndex i = perform_merge(context, *plan);
  ++context.counts.collisions;
  ++report.handled;
  changed_at.resize(std::max(changed_at.size(), network.node_capacity()), 0);
  changed_at[i.value] = stamp;
  if (network.contains(i))
    set_motion(i, *plan);
  return Change{i, event.time, event.first};
}

/// Tells the candidate list and the islands what the arms of the changed node will do.
void CollisionHandler::announce(const Change &change)
{
  if (!network.contains(change.node))
    return;
  for (const SegmentIndex s : network.connected_segments(change.node))
  {
    islands.add(s);
    unite(islands.of(s), islands.of(change.island));
    const SweptBall ball = swept_ball(context, s, change.time);
    candidates.insert_in_step(network, s, ball.centre, ball.radius);
  }
}

void CollisionHandler::detect_again(const std::vector<Change> &changes)
{
  std::vector<std::vector<CollisionEvent>> found(changes.size());
  constexpr std::size_t worth_a_team = 8;
#pragma omp parallel for schedule(dynamic, 1) if (changes.size() > worth_a_team)
  for (std::size_t k = 0; k < changes.size(); ++k)
    detect_around(context, candidates, changes[k].node, changes[k].time, found[k]);
  for (const auto &events : found)
    for (const CollisionEvent &event : events)
      push(event);
}

CollisionReport CollisionHandler::run()
{
  candidates.update(network, context.remaining, (1 + 2 * contact_margin) * context.settings.collision_radius);
  const auto initial = detect_all(context, candidates);
  report.detected = initial.size();
  if (initial.empty())
    return report;
  context.begin_tracking();
  if (settings.concurrent)
    islands = Islands(network, candidates.pairs(), initial);
  for (const CollisionEvent &event : initial)
    push(event);
  for (auto round = next_round(); !round.empty(); round = next_round())
  {
    ++stamp;
    ++report.rounds;
    std::vector<Change> changes;
    for (const CollisionEvent &event : round)
      if (!is_stale(event))
        if (const auto change = handle(event))
          changes.push_back(*change);
    for (const Change &change : changes)
      announce(change);
    if (settings.redetect)
      detect_again(changes);
  }
  context.end_tracking();
  return report;
}
} // namespace

CollisionReport collide_continuously(TopologyContext &context, CandidateList &candidates,
                                     const CollisionSettings &settings)
{
  return CollisionHandler(context, candidates, settings).run();
}
} // namespace ddfem
