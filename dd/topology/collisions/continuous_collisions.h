// Collisions over a whole step, in the order in which they happen.
#pragma once

#include "dd/topology/collisions/candidate_list.h"
#include "dd/topology/topology_context.h"

#include <cstddef>

namespace ddfem
{
struct CollisionSettings
{
  /// Look again at what an event has changed. Off only to show what is missed without it.
  bool redetect = true;
  /// Handle events that cannot influence each other at the same time instead of one after the other.
  bool concurrent = true;
};

/// What happened in one step.
struct CollisionReport
{
  std::size_t detected = 0;  ///< contacts found before any was handled
  std::size_t handled = 0;   ///< merged pairs
  std::size_t refused = 0;   ///< contacts where no node can take both lines
  std::size_t exhausted = 0; ///< contacts refused because the pair had met as often as it may
  std::size_t rounds = 0;    ///< of independent events
};

/// Finds and handles every collision of the step and leaves the nodes where their last event put them: move_nodes(context, 1)
/// then takes all to the end of the step (the sequential algorithm without displacement, Durocher, thesis, Bordeaux 2018,
/// sections III.3.1.3 and III.3.1.4, annex B.3).
///
/// Every node moves straight by its `remaining` displacement. Contacts within the capture radius are events, handled in the
/// order of (time, persistent ids). A contact merges the two lines at the time and place where they meet; the new node
/// moves on with the mean of the displacements that the two points had at the start of the step, projected on its glide
/// planes (eqs. B.33, B.35, B.41: always those of the start, so that lines which meet front to front stay straight). After each
/// event the arms of the new node are looked at again. If no node can take both lines at the first contact, the pair is
/// tried once more where it is closest.
///
/// It ends: an event merges two nodes (then there is one node fewer), or a node and a segment, which is cut, or cuts two
/// segments (then there is one node more). Every piece of a segment carries the name of the segment of the start of the
/// step that it comes from, of which there are S. Two such names cut each other at most three times in a step, which is as
/// often as two straight segments in uniform motion can cross (their triple product is a cubic in time), and a node cuts a name
/// at most three times. So at most 3 S (S + 1) / 2 nodes are ever made, N + 3 S (S + 1) / 2 nodes cut at most 3 S names
/// each, and mergers of two nodes are fewer than nodes. `exhausted` counts how often the rule was needed.
///
/// With `concurrent` the events are handled in rounds, one of each island of segments that can influence each other; the
/// order in an island is that of the sequential algorithm, and so is the outcome, to the last bit, up to the numbering of
/// new objects. Neither depends on the number of threads.
CollisionReport collide_continuously(TopologyContext &context, CandidateList &candidates,
                                     const CollisionSettings &settings = {});
} // namespace ddfem
