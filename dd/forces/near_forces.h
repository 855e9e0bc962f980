// The stiff part of the forces on a segment: those that change when its neighbourhood moves.
#pragma once

#include "dd/elasticity/line_table.h"
#include "dd/elasticity/segment_force.h"
#include "dd/network/network.h"
#include "dd/topology/collisions/candidate_list.h"

#include <span>
#include <vector>

namespace ddfem
{
struct NearForceSettings
{
  IsotropicMedium medium;
  double core_cutoff_radius = 0.0; ///< nm, see CoreEnergy
  double pair_tolerance = 1e-5;    ///< as in ForceSettings
  /// Segments are near that are no farther apart than this at the start, in the middle or at the end of the expected motion, nm.
  double distance = 0.0;
};

/// Forces on single segments by themselves (elastic and core), by a uniform applied stress, by the segments that share a node with
/// them, and by those that update() has found near, in closed form. They are a part of what compute_nodal_forces() returns, which the rest
/// completes exactly, whatever the list of near segments.
class NearForces
{
public:
  /// Finds the near pairs of nodes that are expected to move by @p motion (nm, by NodeIndex::value; empty: to rest). Results do not depend on earlier calls.
  void update(const Network &network, const NearForceSettings &force_settings, const SymTensor &applied_stress,
              std::span<const Vec3> motion = {});

  /// Makes segments near that are within @p distance (nm) of those at the given nodes, in the present positions, besides those that are.
  void widen(const Network &network, std::span<const NodeIndex> around, double distance);

  /// MPa nm^2; safe to call from any thread. @p scratch: memory to use.
  SegmentForces on(const Network &network, SegmentIndex s, LineTable &scratch) const;

  /// The segments that act on @p s, itself not among them; in the order of arms, then of persistent ids.
  std::span<const SegmentIndex> sources(const SegmentIndex s) const
  {
    return std::span(source_list).subspan(first[s.value], first[s.value + 1] - first[s.value]);
  }

  /// Bound of the change of the force on a node when it approaches the near segments of its arms, by NodeIndex::value, MPa nm: parallel lines at
  /// the distance d attract each other by mu b b' / (2 pi (1-nu) d) per length (Hirth & Lothe, eq. 5-17), which changes
  /// by 1/d^2, with d^2 + a^2 in its place, on the common length or, of lines at an angle, about d / sin(angle). Segments with a
  /// common node do not count.
  std::vector<double> gradient_at_nodes(const Network &network) const;

private:
  void make_lists(const Network &network);
  double gradient(const Network &network, SegmentIndex s, SegmentIndex source) const;

  NearForceSettings settings;
  SymTensor applied = SymTensor::Zero(); ///< MPa
  CandidateList candidates;
  std::vector<CandidatePair> pairs; ///< near, without those that share a node, in the order of persistent ids
  std::vector<std::size_t> first;   ///< in source_list, by SegmentIndex::value
  std::vector<SegmentIndex> source_list;
};
} // namespace ddfem
