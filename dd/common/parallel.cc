#include "dd/common/parallel.h"

#include <algorithm>

namespace ddfem
{
namespace
{
IndexRange part_of(const std::size_t n, const int rank, const int size)
{
  const auto r = static_cast<std::size_t>(rank), s = static_cast<std::size_t>(size);
  return {n * r / s, n * (r + 1) / s};
}
} // namespace

Rank rank_of(MPI_Comm comm)
{
  int initialised = 0;
  Rank rank;
  MPI_Initialized(&initialised);
  if (initialised != 0)
  {
    MPI_Comm_rank(comm, &rank.mine);
    MPI_Comm_size(comm, &rank.n);
  }
  return rank;
}

IndexRange owned_range(const std::size_t n, MPI_Comm comm)
{
  const Rank rank = rank_of(comm);
  return part_of(n, rank.mine, rank.n);
}

std::vector<std::size_t> owned_ranges(const std::size_t n, MPI_Comm comm)
{
  const Rank rank = rank_of(comm);
  std::vector<std::size_t> begin(static_cast<std::size_t>(rank.n) + 1, n);
  for (int r = 0; r < rank.n; ++r)
    begin[static_cast<std::size_t>(r)] = part_of(n, r, rank.n).begin;
  return begin;
}

void gather_parts_of_bytes(void *values, const std::span<const std::size_t> begin, const std::size_t item_size,
                           MPI_Comm comm)
{
  if (begin.size() <= 2)
    return;
  std::vector<int> counts, offsets;
  for (std::size_t r = 0; r + 1 < begin.size(); ++r)
  {
    counts.push_back(static_cast<int>(begin[r + 1] - begin[r]));
    offsets.push_back(static_cast<int>(begin[r]));
  }
  // Numbers of bytes would not always fit into an int.
  MPI_Datatype item = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(static_cast<int>(item_size), MPI_BYTE, &item);
  MPI_Type_commit(&item);
  MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, values, counts.data(), offsets.data(), item, comm);
  MPI_Type_free(&item);
}

std::size_t part_with(const std::span<const std::size_t> begin, const std::size_t item)
{
  const auto between = begin.subspan(1, begin.size() - 2);
  return static_cast<std::size_t>(std::upper_bound(between.begin(), between.end(), item) - between.begin());
}

GatheredPoints gather_points(const std::span<const Vec3> mine, MPI_Comm comm)
{
  const auto [rank, size] = rank_of(comm);
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
