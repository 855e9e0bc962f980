#pragma once

#include <mpi.h>

#include <type_traits>
#include <vector>

namespace ddfem::fem
{
/// Concatenates the ranks' vectors in the order of the ranks; every rank gets the result. Collective.
template <typename T> std::vector<T> gather(const std::vector<T> &local, MPI_Comm communicator)
{
  static_assert(std::is_trivially_copyable_v<T>);
  int n_ranks = 1;
  MPI_Comm_size(communicator, &n_ranks);
  const int n_bytes = static_cast<int>(local.size() * sizeof(T));
  std::vector<int> counts(static_cast<std::size_t>(n_ranks)), offsets(counts.size() + 1, 0);
  MPI_Allgather(&n_bytes, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator);
  for (std::size_t i = 0; i < counts.size(); ++i)
  {
    offsets[i + 1] = offsets[i] + counts[i];
  }
  std::vector<T> all(static_cast<std::size_t>(offsets.back()) / sizeof(T));
  MPI_Allgatherv(local.data(), n_bytes, MPI_BYTE, all.data(), counts.data(), offsets.data(), MPI_BYTE, communicator);
  return all;
}
} // namespace ddfem::fem
