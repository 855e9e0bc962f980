// Stresses that one rank has computed and another one needs.
#pragma once

#include "dd/common/types.h"
#include "dd/forces/line_shares.h"

#include <mpi.h>

#include <cstdint>
#include <span>
#include <vector>

namespace ddfem
{
/// Brings the stress at all points of its lines to each rank while other work is done: of lines that cross from one share of the
/// leaves to another, some points are computed elsewhere. What goes where follows from the tree, which all ranks have.
class StressExchange
{
public:
  /// Starts to send. Collective. @p stress: at the points that this rank of @p comm has computed.
  StressExchange(const PointsOfLines &points, const LineShares &lines, const fmm::MultipoleSum &sum,
                 std::span<const SymTensor> stress, MPI_Comm comm);
  StressExchange(const StressExchange &) = delete;
  StressExchange &operator=(const StressExchange &) = delete;
  ~StressExchange() { wait(); }

  /// Puts what has come to its points.
  void finish(std::span<SymTensor> stress);

  std::size_t n_sent() const { return sent.points.size(); }

private:
  /// What goes to the other ranks, or comes from them: rank by rank, in the order of the points in the tree.
  struct Messages
  {
    std::vector<std::uint32_t> points;
    std::vector<int> counts, offsets; ///< of numbers, by rank
    std::vector<SymTensor> values;
  };
  void choose_points(const PointsOfLines &points, const LineShares &lines, const fmm::MultipoleSum &sum, int rank);
  void wait();

  Messages sent, received;
  MPI_Request request = MPI_REQUEST_NULL;
};
} // namespace ddfem
