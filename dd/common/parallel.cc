#include "dd/common/parallel.h"

#include <utility>

namespace ddfem
{
namespace
{
IndexRange part_of(const std::size_t n, const int rank, const int size)
{
  const auto r = static_cast<std::size_t>(rank), s = static_cast<std::size_t>(size);
  return {n * r / s, n * (r + 1) / s};
}

/// Rank and number of ranks; a program that has not initialised MPI is one rank.
std::pair<int, int> rank_and_size(MPI_Comm comm)
{
  int initialised = 0, rank = 0, size = 1;
  MPI_Initialized(&initialised);
  if (initialised != 0)
  {
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &size);
  }
  return {rank, size};
}
} // namespace

IndexRange owned_range(const std::size_t n, MPI_Comm comm)
{
  const auto [rank, size] = rank_and_size(comm);
  return part_of(n, rank, size);
}

void gather_owned_bytes(void *values, const std::size_t n, const std::size_t item_size, MPI_Comm comm)
{
  const int size = rank_and_size(comm).second;
  if (size == 1)
    return;
  std::vector<int> counts, offsets;
  for (int r = 0; r < size; ++r)
  {
    const IndexRange part = part_of(n, r, size);
    counts.push_back(static_cast<int>((part.end - part.begin) * item_size));
    offsets.push_back(static_cast<int>(part.begin * item_size));
  }
  MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, values, counts.data(), offsets.data(), MPI_BYTE, comm);
}

GatheredPoints gather_points(const std::span<const Vec3> mine, MPI_Comm comm)
{
  const auto [rank, size] = rank_and_size(comm);
  if (size == 1)
    return {{mine.begin(), mine.end()}, 0};
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  std::vector<int> counts(static_cast<std::size_t>(size)), offsets{0};
  const auto n = static_cast<int>(3 * mine.size());
  MPI_Allgather(&n, 1, MPI_INT, counts.data(), 1, MPI_INT, comm);
  for (const int count : counts)
    offsets.push_back(offsets.back() + count);
  GatheredPoints all{std::vector<Vec3>(static_cast<std::size_t>(offsets.back() / 3)),
                     static_cast<std::size_t>(offsets[static_cast<std::size_t>(rank)] / 3)};
  MPI_Allgatherv(mine.data(), n, MPI_DOUBLE, all.points.data(), counts.data(), offsets.data(), MPI_DOUBLE, comm);
  return all;
}
} // namespace ddfem
