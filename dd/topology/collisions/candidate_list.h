// Which segments might meet: candidate pairs that live across steps.
#pragma once

#include "dd/network/network.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ddfem
{
/// Two segments without a common node at the time of the build, first < second by persistent id.
struct CandidatePair
{
  SegmentIndex first, second;
};

/// What the list has done since its construction.
struct CandidateStatistics
{
  std::size_t updates = 0;      ///< steps
  std::size_t builds = 0;       ///< steps in which everything was rebuilt
  std::size_t insertions = 0;   ///< segments inserted locally
  std::size_t sphere_tests = 0; ///< pairs of bounding spheres compared
  double skin = 0.0;            ///< present skin, nm
};

/// Candidate pairs by a Verlet list with a dynamic test.
///
/// Every segment is covered by two spheres about its quarter points (Durocher, thesis, Bordeaux 2018, section III.4.1.2),
/// sorted by the Morton index of their cell in a uniform grid. Two segments are candidates if spheres of theirs come
/// within radius + skin at the reference positions of their nodes. Before each step update() compares where the nodes will
/// be at its end with the reference positions: the list is rebuilt only if some node is farther than skin/2 from its
/// reference, and is then valid for the whole step. Segments that topology has inserted since are added one by one,
/// with the present position as the reference of their new nodes; those that have gone are skipped. The skin is chosen to
/// minimise the number of elementary operations per step (deterministic: counted, not timed).
class CandidateList
{
public:
  /// Makes the list cover everything that can happen in the coming step: pairs() then contains every pair of segments
  /// without a common node that comes within @p radius (nm) while each node moves straight, at any pace, by at most
  /// @p displacement (nm, by NodeIndex::value, shorter arrays count as zero). Rebuilds after Network::clean().
  void update(const Network &network, std::span<const Vec3> displacement, double radius);

  /// Pairs of live segments, in increasing order of the persistent ids (first, second); each pair once.
  std::span<const CandidatePair> pairs() const { return pairs_; }

  /// Appends every segment known to the list, live in @p network, that may come within @p radius of the ball
  /// (@p centre, @p ball_radius) during the present step; each once, in no particular order. Thread-safe.
  void neighbours(const Network &network, const Vec3 &centre, double ball_radius, double radius,
                  std::vector<SegmentIndex> &found) const;

  /// Makes a segment born within the step known to neighbours(): it stays within the ball until the end of the step.
  void insert_in_step(const Network &network, SegmentIndex s, const Vec3 &centre, double ball_radius);

  const CandidateStatistics &statistics() const { return statistics_; }

private:
  std::vector<CandidatePair> pairs_;
  CandidateStatistics statistics_;
};
} // namespace ddfem
