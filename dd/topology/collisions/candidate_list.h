// Which segments might meet: candidate pairs that live across steps.
#pragma once

#include "dd/network/network.h"
#include "dd/topology/collisions/skin_tuner.h"
#include "dd/topology/collisions/sphere_grid.h"
#include "dd/topology/collisions/sphere_table.h"

#include <array>
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
/// Every segment is covered by two spheres about its quarter points (Durocher, thesis, Bordeaux 2018, section
/// III.4.1.2), sorted by the Morton index of their cell in a uniform grid. Two segments are candidates if spheres of
/// theirs come within radius + skin at the reference positions of their nodes. Before each step update() compares where
/// the nodes will be at its end with the reference positions: while all nodes are within skin/2 of them, the list is
/// valid for the whole step. Segments that topology has inserted since are added one by one, with the present position
/// as the reference of their new nodes; those that have gone are skipped. Segments with a node beyond skin/2 are added
/// anew, too, with room for three steps of a node that is faster than the skin allows: a few racing nodes cost neither
/// a build nor a wide skin for all. When an eighth of the segments has been added, everything is rebuilt. The skin is
/// chosen to minimise the number of elementary operations per step (deterministic: counted, not timed), see SkinTuner.
///
/// A list belongs to one network; after an assignment to the network start with a new list. It uses threads; the
/// results do not depend on how many.
class CandidateList
{
public:
  /// Makes the list cover everything that can happen in the coming step: pairs() then contains every pair of segments
  /// without a common node that comes within @p radius (nm) while each node moves straight, at any pace, by at most
  /// @p displacement (nm, by NodeIndex::value, shorter arrays count as zero). Rebuilds after Network::clean(). Throws
  /// std::invalid_argument if a position or displacement is not finite.
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
  /// Where a node was when its segments got their spheres, and how far from there it may go.
  struct Reference
  {
    Vec3 position = Vec3::Zero(); ///< nm
    double allowance = 0;         ///< nm: half the skin, more for the few nodes that move faster than the others
  };

  bool is_outdated(const Network &network, double radius) const;
  void rebuild(const Network &network, std::span<const Vec3> displacement, double radius, bool expired);
  void set_reference(const Network &network, NodeIndex i, std::span<const Vec3> displacement);
  std::vector<NodeIndex> nodes_out_of_reach(const Network &network, std::span<const Vec3> displacement) const;
  std::array<Sphere, 2> spheres_of(const Network &network, SegmentIndex s) const;
  std::vector<SegmentIndex> fill_grid(const Network &network);
  void find_pairs_of_grid(const Network &network);
  std::vector<CandidatePair> pairs_of_inserted(const Network &network, SegmentIndex s, std::uint32_t first,
                                               std::size_t &tests) const;
  /// Drops the pairs of segments that have gone, and enters @p segments, new ones or known ones with new references.
  void enter(const Network &network, const std::vector<SegmentIndex> &segments);
  /// Whether a sphere entered with this number is the present one of its segment.
  bool is_current(const Network &network, SegmentIndex s, std::uint32_t number) const
  {
    return network.contains(s) && number_[s.value] == number;
  }

  std::vector<CandidatePair> pairs_;
  CandidateStatistics statistics_;
  SkinTuner tuner_;

  std::vector<Reference> references_; ///< by NodeIndex::value
  SphereGrid grid_;                   ///< segments present at the build
  SphereTable inserted_;              ///< those entered since, with their number
  SphereTable in_step_;               ///< those born within the step
  /// By SegmentIndex::value: 0 for those in the grid, running number of its latest entry for those in the table.
  std::vector<std::uint32_t> number_;
  std::uint32_t n_entered_ = 0;

  CellMap map_;
  Vec3 period_ = Vec3::Zero();
  double radius_ = -1;             ///< for which the pairs were searched, nm
  std::size_t n_cleans_ = 0;       ///< of the network, at the build
  std::size_t n_live_ = 0;         ///< segments of the network, at the last update
  std::size_t steps_of_build_ = 0; ///< that the present list has served
};
} // namespace ddfem
