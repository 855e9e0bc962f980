// Division of replicated work among MPI ranks.
#pragma once

#include "dd/common/types.h"

#include <mpi.h>

#include <cstddef>
#include <span>
#include <vector>

namespace ddfem
{
struct IndexRange
{
  std::size_t begin = 0, end = 0;
};

/// The part of [0, n) that this rank of @p comm computes: contiguous, sizes differ by at most one.
IndexRange owned_range(std::size_t n, MPI_Comm comm);

/// Fills @p values, of which every rank has computed owned_range(), so that all ranks hold all of them, bit for bit.
/// T must be trivially copyable.
void gather_owned_bytes(void *values, std::size_t n, std::size_t item_size, MPI_Comm comm);

template <class T> void gather_owned(std::vector<T> &values, MPI_Comm comm)
{
  gather_owned_bytes(values.data(), values.size(), sizeof(T), comm);
}

struct GatheredPoints
{
  std::vector<Vec3> points; ///< of all ranks, one rank after the other
  std::size_t first;        ///< where those of this rank begin
};
GatheredPoints gather_points(std::span<const Vec3> mine, MPI_Comm comm);
} // namespace ddfem
