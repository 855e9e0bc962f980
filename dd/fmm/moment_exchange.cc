#include "dd/fmm/moment_exchange.h"

#include "dd/common/parallel.h"
#include "dd/common/stopwatch.h"

#include <algorithm>

namespace ddfem::fmm
{
MomentExchange::MomentExchange(const Octree &tree, const std::span<const std::size_t> point_limits,
                               const std::span<const std::uint8_t> wanted, MPI_Comm comm_)
    : comm(comm_), mine(static_cast<std::uint32_t>(rank_of(comm_).mine))
{
  const std::size_t n_ranks = point_limits.size() - 1;
  if (n_ranks == 1)
    return;
  for (const Box &box : tree.boxes())
    owner.push_back(static_cast<std::uint32_t>(part_with(point_limits, box.points_begin)));
  const BoxesByRank boxes = needed(tree, wanted, n_ranks);
  received = by_level(tree, boxes);
  const ThreadStopwatch watch(waited);
  sent = by_level(tree, asked_for(boxes));
}

bool MomentExchange::needs_others(const Octree &tree, const Box &box) const
{
  for (std::size_t i = box.first_child; i < box.first_child + box.n_children; ++i)
    if (!is_own(i) && tree.boxes()[i].n_lines() > 0)
      return true;
  return false;
}

std::vector<std::uint8_t> MomentExchange::held(const Octree &tree) const
{
  std::vector<std::uint8_t> is_held(tree.boxes().size());
  for (std::size_t i = 0; i < is_held.size(); ++i)
    is_held[i] = is_own(i) ? 1 : 0;
  for (const Messages &of_level : received)
    for (const std::uint32_t box : of_level.boxes)
      is_held[box] = 1;
  return is_held;
}

/// Boxes of others, by their owners, in their order.
MomentExchange::BoxesByRank MomentExchange::needed(const Octree &tree, const std::span<const std::uint8_t> wanted,
                                                   const std::size_t n_ranks) const
{
  std::vector<std::uint8_t> is_needed(tree.boxes().size(), 0);
  for (std::size_t i = 0; i < tree.boxes().size(); ++i)
  {
    if (wanted[i] != 0)
      for (const FarLink &l : tree.far_links(i))
        is_needed[l.box] = 1;
    if (const Box &box = tree.boxes()[i]; i >= tree.levels()[1] && is_own(box.parent) && box.n_lines() > 0)
      is_needed[i] = 1;
  }
  BoxesByRank boxes(n_ranks);
  for (std::uint32_t i = 0; i < is_needed.size(); ++i)
    if (is_needed[i] != 0 && !is_own(i))
      boxes[owner[i]].push_back(i);
  return boxes;
}

/// Tells the others what this rank needs of them. Returns what they need of this one.
MomentExchange::BoxesByRank MomentExchange::asked_for(const BoxesByRank &needed) const
{
  std::vector<int> n_needed, n_asked(needed.size()), to, from;
  std::vector<std::uint32_t> all_needed, all_asked;
  for (const std::vector<std::uint32_t> &boxes : needed)
  {
    to.push_back(static_cast<int>(all_needed.size()));
    n_needed.push_back(static_cast<int>(boxes.size()));
    all_needed.insert(all_needed.end(), boxes.begin(), boxes.end());
  }
  MPI_Alltoall(n_needed.data(), 1, MPI_INT, n_asked.data(), 1, MPI_INT, comm);
  std::size_t n = 0;
  for (const int count : n_asked)
  {
    from.push_back(static_cast<int>(n));
    n += static_cast<std::size_t>(count);
  }
  all_asked.resize(n);
  MPI_Alltoallv(all_needed.data(), n_needed.data(), to.data(), MPI_UINT32_T, all_asked.data(), n_asked.data(),
                from.data(), MPI_UINT32_T, comm);
  BoxesByRank asked;
  for (std::size_t r = 0; r < needed.size(); ++r)
    asked.emplace_back(all_asked.begin() + from[r], all_asked.begin() + from[r] + n_asked[r]);
  return asked;
}

std::vector<MomentExchange::Messages> MomentExchange::by_level(const Octree &tree, const BoxesByRank &boxes)
{
  std::vector<Messages> messages(tree.levels().size() - 1);
  for (std::size_t level = 0; level < messages.size(); ++level)
    for (const std::vector<std::uint32_t> &of_rank : boxes)
    {
      Messages &m = messages[level];
      const auto begin = std::lower_bound(of_rank.begin(), of_rank.end(), tree.levels()[level]);
      const auto end = std::lower_bound(begin, of_rank.end(), tree.levels()[level + 1]);
      m.offsets.push_back(static_cast<int>(m.boxes.size()));
      m.counts.push_back(static_cast<int>(end - begin));
      m.boxes.insert(m.boxes.end(), begin, end);
    }
  return messages;
}

void MomentExchange::start(const std::size_t level, const std::size_t size, const Pack &pack)
{
  if (owner.empty())
    return;
  started = level;
  item_size = size;
  const Messages &to = sent[level], &from = received[level];
  out.resize(to.boxes.size() * size);
  in.resize(from.boxes.size() * size);
  bytes_sent += out.size();
  for (std::size_t k = 0; k < to.boxes.size(); ++k)
    pack(to.boxes[k], out.data() + k * size);
  MPI_Type_contiguous(static_cast<int>(size), MPI_BYTE, &item);
  MPI_Type_commit(&item);
  MPI_Ialltoallv(out.data(), to.counts.data(), to.offsets.data(), item, in.data(), from.counts.data(),
                 from.offsets.data(), item, comm, &request);
}

void MomentExchange::finish(const Unpack &unpack)
{
  if (request == MPI_REQUEST_NULL)
    return;
  {
    const ThreadStopwatch watch(waited);
    MPI_Wait(&request, MPI_STATUS_IGNORE);
  }
  MPI_Type_free(&item);
  const std::vector<std::uint32_t> &boxes = received[started].boxes;
  for (std::size_t k = 0; k < boxes.size(); ++k)
    unpack(boxes[k], in.data() + k * item_size);
}
} // namespace ddfem::fmm
