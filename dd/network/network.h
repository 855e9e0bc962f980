// The dislocation network: nodes, straight directed segments and the glide planes they lie on.
#pragma once

#include "dd/common/types.h"
#include "dd/network/glide_plane.h"
#include "dd/network/index_lists.h"

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace ddfem
{
/// Index of a node. Between two calls of Network::clean() an index never changes its meaning.
struct NodeIndex
{
  std::uint32_t value = invalid;
  static constexpr std::uint32_t invalid = 0xffffffffU;
  bool is_valid() const { return value != invalid; }
  auto operator<=>(const NodeIndex &) const = default;
};

/// Index of a segment; same guarantees as NodeIndex.
struct SegmentIndex
{
  std::uint32_t value = invalid;
  static constexpr std::uint32_t invalid = 0xffffffffU;
  bool is_valid() const { return value != invalid; }
  auto operator<=>(const SegmentIndex &) const = default;
};

/// What restrains a node besides its glide planes.
enum class NodeConstraint : std::uint8_t
{
  free,    ///< moves in the glide planes of its segments
  pinned,  ///< never moves; Burgers vectors need not balance
  surface, ///< end of a line on the boundary of the grain: slides there, continues outside as a virtual ray
};

const char *name_of(NodeConstraint constraint);

/// Value type of a node, as inserted and as returned by get().
struct Node
{
  Vec3 position = Vec3::Zero(); ///< nm, sample frame
  NodeConstraint constraint = NodeConstraint::free;
};

/// Value type of a segment. Line sense start -> end, Burgers vector FS/RH; reversing the sense reverses b.
struct Segment
{
  NodeIndex start, end;
  Vec3 burgers = Vec3::Zero(); ///< nm, sample frame
  PlaneIndex plane;            ///< glide plane; invalid for a line without one (sessile)
};

/// One violated invariant; `message` names persistent ids and positions.
struct InvariantViolation
{
  std::string message;
};

/// Structure-of-arrays container of nodes and segments (interface after Durocher, thesis, Bordeaux 2018, annex A.1).
///
/// Erased slots are recycled only by clean(), so an index held across insertions and erasures stays valid or says that
/// its object is gone (contains()). Persistent ids are never reused. Not thread-safe for modification; the const
/// interface and set_position() on distinct nodes may be used concurrently.
///
/// References and spans that the class hands out are valid until the next insert(), erase(), clean() or assignment;
/// indices are values and outlive these (clean() excepted). To erase while walking over all objects, walk over a copy
/// of nodes() or segments() and test contains().
///
/// Periodic cell: nodes may lie anywhere, inside the cell or not. With a period set, a segment runs from its start to
/// the nearest image of its end, and direction(), length(), clean() and the checks follow that rule.
class Network
{
public:
  // --- size and existence
  std::size_t n_nodes() const { return node_of_id_.size(); }       ///< live nodes
  std::size_t n_segments() const { return segment_of_id_.size(); } ///< live segments
  /// One past the largest index in use, live or erased: the length for arrays indexed by NodeIndex::value.
  std::size_t node_capacity() const { return position_.size(); }
  std::size_t segment_capacity() const { return start_.size(); }
  bool contains(NodeIndex i) const { return i.value < node_alive_.size() && node_alive_[i.value] != 0; }
  bool contains(SegmentIndex s) const { return s.value < segment_alive_.size() && segment_alive_[s.value] != 0; }
  /// Index of the object with a persistent id; empty if it is gone.
  std::optional<NodeIndex> find_node(ObjectId id) const;
  std::optional<SegmentIndex> find_segment(ObjectId id) const;
  /// Segment that joins two nodes in either sense; empty if there is none.
  std::optional<SegmentIndex> find(NodeIndex a, NodeIndex b) const;
  /// Make room for this many nodes and segments in total.
  void reserve(std::size_t n_nodes, std::size_t n_segments);

  // --- insertion and erasure
  NodeIndex insert(const Node &node);
  /// For restart; throws std::invalid_argument if the id is taken. The next free id moves past @p id.
  NodeIndex insert(const Node &node, ObjectId id);
  /// Throws std::invalid_argument if an end is missing, both ends coincide, the two nodes are joined already, or the
  /// plane is neither invalid nor one of planes().
  SegmentIndex insert(const Segment &segment);
  SegmentIndex insert(const Segment &segment, ObjectId id);
  /// Throws std::invalid_argument if segments are still connected, std::out_of_range if the node is gone.
  void erase(NodeIndex i);
  /// Throws std::out_of_range if the segment is gone. Its nodes stay.
  void erase(SegmentIndex s);
  /// First id that will be given to the next node / segment; for restart.
  ObjectId next_node_id() const { return next_node_id_; }
  ObjectId next_segment_id() const { return next_segment_id_; }
  /// Throws std::invalid_argument if an id would be given a second time.
  void set_next_ids(ObjectId node, ObjectId segment);

  // --- access. `at` checks existence and throws std::out_of_range; `get` and [] do not check in release builds.
  Node get(NodeIndex i) const;
  Segment get(SegmentIndex s) const;
  Node at(NodeIndex i) const;
  Segment at(SegmentIndex s) const;
  Node operator[](NodeIndex i) const { return get(i); }
  Segment operator[](SegmentIndex s) const { return get(s); }
  void set(NodeIndex i, const Node &node);
  /// Ends must not change (std::invalid_argument): use erase and insert for that.
  void set(SegmentIndex s, const Segment &segment);

  const Vec3 &position(NodeIndex i) const { return position_[i.value]; }
  void set_position(NodeIndex i, const Vec3 &x) { position_[i.value] = x; }
  NodeConstraint constraint(NodeIndex i) const { return constraint_[i.value]; }
  void set_constraint(NodeIndex i, NodeConstraint c) { constraint_[i.value] = c; }
  ObjectId id(NodeIndex i) const { return node_id_[i.value]; }
  ObjectId id(SegmentIndex s) const { return segment_id_[s.value]; }
  NodeIndex start(SegmentIndex s) const { return start_[s.value]; }
  NodeIndex end(SegmentIndex s) const { return end_[s.value]; }
  NodeIndex other_end(SegmentIndex s, NodeIndex i) const { return start(s) == i ? end(s) : start(s); }
  const Vec3 &burgers(SegmentIndex s) const { return burgers_[s.value]; }
  /// Burgers vector of @p s for the line sense that leaves node @p i.
  Vec3 burgers_from(SegmentIndex s, NodeIndex i) const { return start(s) == i ? burgers(s) : Vec3(-burgers(s)); }
  PlaneIndex plane(SegmentIndex s) const { return plane_[s.value]; }
  /// Unit glide-plane normal, or zero for a segment without a plane.
  Vec3 normal(SegmentIndex s) const { return plane(s).is_valid() ? planes_[plane(s)].normal : Vec3(Vec3::Zero()); }
  /// end - start, nm; to the nearest image of the end in a periodic cell.
  Vec3 direction(SegmentIndex s) const
  {
    const Vec3 d = position(end(s)) - position(start(s));
    return is_periodic_ ? minimum_image(d) : d;
  }
  double length(SegmentIndex s) const { return direction(s).norm(); }

  // --- topology
  /// In the order of insertion; in the order of persistent ids after clean().
  std::span<const SegmentIndex> connected_segments(NodeIndex i) const { return arms_[i.value].view(); }
  std::size_t degree(NodeIndex i) const { return arms_[i.value].size(); }
  /// Physical node: degree other than two, constrained, or with two arms of different Burgers vector or glide plane
  /// (parallel planes that share a node are one; in a periodic cell they may be images of each other).
  bool is_physical(NodeIndex i) const;

  GlidePlanes &planes() { return planes_; }
  const GlidePlanes &planes() const { return planes_; }

  // --- periodic cell
  /// Edge lengths of the periodic cell along x, y, z, nm; zero along an axis that is not periodic.
  const Vec3 &period() const { return period_; }
  /// Throws std::invalid_argument if a component is negative or not finite.
  void set_period(const Vec3 &period);
  /// @p d less the multiple of the period that makes every component at most half a period long.
  Vec3 minimum_image(const Vec3 &d) const;

  // --- traversal. Ranges of live indices, random access, usable in `#pragma omp for` (by range-for too), in increasing
  // order of the index. The calls after an erase() cost a pass over the list: do not alternate the two in a loop.
  std::span<const NodeIndex> nodes() const { return live_nodes_.view(node_alive_); }
  std::span<const SegmentIndex> segments() const { return live_segments_.view(segment_alive_); }
  // The traversals visit every live object once, threaded, in no particular order. What they compute is independent of
  // the number of threads as long as f writes to the entries of the object it is given only. An exception that f throws
  // is thrown again after the traversal (one of them if there are several); some objects have not been visited then.
  /// Threaded: f(NodeIndex).
  template <class F> void for_each_node(F &&f) const;
  /// Threaded: f(SegmentIndex, NodeIndex start, NodeIndex end).
  template <class F> void for_each_segment(F &&f) const;
  /// Threaded: f(NodeIndex, std::span<const SegmentIndex>).
  template <class F> void for_each_node_with_segments(F &&f) const;

  /// Sort nodes and segments by the Morton index of their position (of the mid-point), ties by persistent id, compact
  /// the arrays and order the arms of every node by persistent id. All indices change, ids do not. Memory order is then
  /// a function of the content alone: inserting the same objects in another order and calling clean() gives the same
  /// arrays. Planes keep their indices.
  void clean();
  /// How often clean() has renumbered the objects: indices kept elsewhere are stale when this has changed.
  std::size_t n_cleans() const { return n_cleans_; }

  // --- checks
  /// All violated invariants (empty if sound): Burgers vectors balance at free nodes; no duplicate or zero-length
  /// segment; b.n = 0 and xi.n = 0 for segments with a plane; both ends on the plane; a surface node has degree one;
  /// no free node of degree below two; adjacency consistent. Position tolerance in nm.
  std::vector<InvariantViolation> violations(double tolerance = 1e-6) const;
  /// Throws std::runtime_error with the first few messages if violations() is not empty.
  void check_invariants(double tolerance = 1e-6) const;
  /// Order-independent hash of ids, topology, constraints, and the exact bits of positions, Burgers vectors and planes:
  /// equal networks have equal checksums.
  std::uint64_t checksum() const;

private:
  template <class Index, class F> static void parallel_for(std::span<const Index> range, F &&f);
  void require(NodeIndex i) const;
  void require(SegmentIndex s) const;
  void clean_nodes();
  void clean_segments();

  void check_node(NodeIndex i, double tolerance, std::vector<InvariantViolation> &found) const;
  void check_segment(SegmentIndex s, double tolerance, std::vector<InvariantViolation> &found) const;
  void check_plane(SegmentIndex s, double tolerance, std::vector<InvariantViolation> &found) const;
  std::string describe(NodeIndex i) const;
  std::string describe(SegmentIndex s) const;

  // Nodes: one entry per index, erased ones included until clean().
  std::vector<Vec3> position_;
  std::vector<NodeConstraint> constraint_;
  std::vector<ObjectId> node_id_;
  std::vector<std::uint8_t> node_alive_;
  std::vector<ShortList<SegmentIndex>> arms_;

  // Segments.
  std::vector<NodeIndex> start_, end_;
  std::vector<Vec3> burgers_;
  std::vector<PlaneIndex> plane_;
  std::vector<ObjectId> segment_id_;
  std::vector<std::uint8_t> segment_alive_;

  std::unordered_map<ObjectId, NodeIndex> node_of_id_; ///< live objects only
  std::unordered_map<ObjectId, SegmentIndex> segment_of_id_;
  LiveIndices<NodeIndex> live_nodes_;
  LiveIndices<SegmentIndex> live_segments_;
  ObjectId next_node_id_ = 0;
  ObjectId next_segment_id_ = 0;
  std::size_t n_cleans_ = 0;

  GlidePlanes planes_;
  Vec3 period_ = Vec3::Zero();
  bool is_periodic_ = false;
};

template <class Index, class F> void Network::parallel_for(std::span<const Index> range, F &&f)
{
  // Without gaps, which is the case after clean(), the list of indices need not be read.
  const bool is_dense = !range.empty() && range.back().value + std::size_t(1) == range.size();
  constexpr std::size_t block = 1024; // an exception must not leave the parallel region; caught once per block
  std::exception_ptr error;
#pragma omp parallel for schedule(static)
  for (std::size_t begin = 0; begin < range.size(); begin += block)
  {
    const std::size_t end = std::min(begin + block, range.size());
    try
    {
      if (is_dense)
        for (std::size_t k = begin; k < end; ++k)
          f(Index{static_cast<std::uint32_t>(k)});
      else
        for (std::size_t k = begin; k < end; ++k)
          f(range[k]);
    }
    catch (...)
    {
#pragma omp critical(ddfem_network_traversal)
      error = std::current_exception();
    }
  }
  if (error)
    std::rethrow_exception(error);
}

template <class F> void Network::for_each_node(F &&f) const
{
  parallel_for(nodes(), std::forward<F>(f));
}

template <class F> void Network::for_each_segment(F &&f) const
{
  parallel_for(segments(), [&](SegmentIndex s) { f(s, start(s), end(s)); });
}

template <class F> void Network::for_each_node_with_segments(F &&f) const
{
  parallel_for(nodes(), [&](NodeIndex i) { f(i, connected_segments(i)); });
}
} // namespace ddfem
