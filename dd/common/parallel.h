// Division of replicated work among MPI ranks.
#pragma once

#include "dd/common/types.h"

#include <mpi.h>

#include <cstddef>
#include <span>
#include <vector>

namespace ddfem
{
/// This rank of a communicator; a program that has not initialised MPI is one rank.
struct Rank
{
  int mine = 0, n = 1;
};
Rank rank_of(MPI_Comm comm);

struct IndexRange
{
  std::size_t begin = 0, end = 0;
};

/// The part of [0, n) that this rank of @p comm computes: contiguous, sizes differ by at most one.
IndexRange owned_range(std::size_t n, MPI_Comm comm);

/// First item of the owned_range() of every rank, and one past the last.
std::vector<std::size_t> owned_ranges(std::size_t n, MPI_Comm comm);

/// Fills @p values, of which rank r has computed [begin[r], begin[r + 1]), so that all ranks hold all of them, bit for bit.
void gather_parts_of_bytes(void *values, std::span<const std::size_t> begin, std::size_t item_size, MPI_Comm comm);

/// T must be trivially copyable.
template <class T> void gather_parts(std::vector<T> &values, const std::span<const std::size_t> begin, MPI_Comm comm)
{
  gather_parts_of_bytes(values.data(), begin, sizeof(T), comm);
}

/// The same where every rank has computed owned_range().
template <class T> void gather_owned(std::vector<T> &values, MPI_Comm comm)
{
  gather_parts(values, owned_ranges(values.size(), comm), comm);
}

/// The values of all ranks, in their order.
template <class T> std::vector<T> gather_one(const T &mine, MPI_Comm comm)
{
  const Rank rank = rank_of(comm);
  std::vector<T> values(static_cast<std::size_t>(rank.n), mine);
  gather_owned(values, comm);
  return values;
}

/// Number r of the part [begin[r], begin[r + 1]) that has @p item; the last one for items behind all.
std::size_t part_with(std::span<const std::size_t> begin, std::size_t item);

struct GatheredPoints
{
  std::vector<Vec3> points; ///< of all ranks, one rank after the other
  std::size_t first;        ///< where those of this rank begin
};
GatheredPoints gather_points(std::span<const Vec3> mine, MPI_Comm comm);
} // namespace ddfem
