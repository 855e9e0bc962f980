// Multipole coefficients of boxes that one rank has computed and others need.
#pragma once

#include "dd/fmm/octree.h"

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace ddfem::fmm
{
/**
 * Divides the multipole coefficients of the boxes of a tree among ranks: those of a box are computed by the rank that evaluates its first
 * point. They are sent to ranks that translate them, and to those that compute the box around it, level by level; a level travels while
 * the next one is computed.
 */
class MomentExchange
{
public:
  /// Of one rank alone.
  MomentExchange() = default;
  /// Collective. @p point_limits: first point of each rank of @p comm in the tree's order, and one past the last. @p wanted: boxes whose
  /// local coefficients this rank computes.
  MomentExchange(const Octree &tree, std::span<const std::size_t> point_limits, std::span<const std::uint8_t> wanted,
                 MPI_Comm comm);

  /// Whether this rank computes those of @p box.
  bool is_own(const std::size_t box) const { return owner.empty() || owner[box] == mine; }
  /// Whether it needs those of children of others for it.
  bool needs_others(const Octree &tree, const Box &box) const;

  /// For each box of the tree whether its coefficients come to be on this rank, computed or received.
  std::vector<std::uint8_t> held(const Octree &tree) const;

  /// Copies coefficients of a box to or from a message.
  using Pack = std::function<void(std::size_t box, std::byte *to)>;
  using Unpack = std::function<void(std::size_t box, const std::byte *from)>;
  /// Starts to send those of the boxes of @p level, of @p size bytes each. Collective; what was started before must be finished.
  void start(std::size_t level, std::size_t size, const Pack &pack);
  /// Waits for them, and hands over those of others.
  void finish(const Unpack &unpack);

  /// By start(), so far.
  std::size_t n_bytes_sent() const { return bytes_sent; }
  /// Processor time of this rank's thread while it waited for others so far, s.
  double seconds_waited() const { return waited; }

private:
  /// To or from other ranks, rank by rank.
  struct Messages
  {
    std::vector<std::uint32_t> boxes;
    std::vector<int> counts, offsets; ///< of boxes
  };
  using BoxesByRank = std::vector<std::vector<std::uint32_t>>;
  BoxesByRank needed(const Octree &tree, std::span<const std::uint8_t> wanted, std::size_t n_ranks) const;
  BoxesByRank asked_for(const BoxesByRank &needed) const;
  static std::vector<Messages> by_level(const Octree &tree, const BoxesByRank &boxes);

  MPI_Comm comm = MPI_COMM_NULL;
  std::uint32_t mine = 0;
  std::vector<std::uint32_t> owner;     ///< rank, of each box; empty: all are own
  std::vector<Messages> sent, received; ///< of each level
  std::vector<std::byte> out, in;
  MPI_Datatype item = MPI_DATATYPE_NULL;  ///< coefficients of a box under way
  std::size_t started = 0, item_size = 0; ///< level under way
  MPI_Request request = MPI_REQUEST_NULL;
  std::size_t bytes_sent = 0;
  double waited = 0;
};
} // namespace ddfem::fmm
