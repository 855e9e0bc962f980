#include "dd/forces/stress_exchange.h"

#include "dd/common/parallel.h"

#include <algorithm>

namespace ddfem
{
namespace
{
constexpr int numbers_per_stress = 6;
static_assert(sizeof(SymTensor) == numbers_per_stress * sizeof(double));

/// Points of the messages to or from each rank, by their places in the tree.
using PlacesByRank = std::vector<std::vector<std::uint32_t>>;

std::vector<std::uint32_t> inverse(const std::vector<std::uint32_t> &order)
{
  std::vector<std::uint32_t> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    place[order[k]] = static_cast<std::uint32_t>(k);
  return place;
}
} // namespace

StressExchange::StressExchange(const PointsOfLines &points, const LineShares &lines, const fmm::MultipoleSum &sum,
                               const std::span<const SymTensor> stress, MPI_Comm comm)
{
  const Rank rank = rank_of(comm);
  if (rank.n == 1)
    return;
  choose_points(points, lines, sum, rank.mine);
  for (const std::uint32_t i : sent.points)
    sent.values.push_back(stress[i]);
  received.values.resize(received.points.size());
  MPI_Ialltoallv(sent.values.data(), sent.counts.data(), sent.offsets.data(), MPI_DOUBLE, received.values.data(),
                 received.counts.data(), received.offsets.data(), MPI_DOUBLE, comm, &request);
}

void StressExchange::choose_points(const PointsOfLines &points, const LineShares &lines, const fmm::MultipoleSum &sum,
                                   const int rank)
{
  const std::vector<std::size_t> limits = sum.point_shares();
  const auto mine = static_cast<std::size_t>(rank);
  const std::vector<std::uint32_t> &order = sum.octree().point_order(), place = inverse(order);
  PlacesByRank to(limits.size() - 1), from(limits.size() - 1);
  for (std::size_t k = limits[mine]; k < limits[mine + 1]; ++k)
    if (const std::size_t owner = part_with(limits, place[points.begin(points.line_of(order[k]))]); owner != mine)
      to[owner].push_back(static_cast<std::uint32_t>(k));
  for (const std::uint32_t line : lines.of(rank))
    for (std::size_t i = points.begin(line); i < points.end(line); ++i)
      if (const std::size_t computed_by = part_with(limits, place[i]); computed_by != mine)
        from[computed_by].push_back(place[i]);
  const auto list = [&](Messages &messages, PlacesByRank &places)
  {
    for (std::vector<std::uint32_t> &of_rank : places)
    {
      std::sort(of_rank.begin(), of_rank.end());
      messages.offsets.push_back(numbers_per_stress * static_cast<int>(messages.points.size()));
      messages.counts.push_back(numbers_per_stress * static_cast<int>(of_rank.size()));
      for (const std::uint32_t k : of_rank)
        messages.points.push_back(order[k]);
    }
  };
  list(sent, to);
  list(received, from);
}

void StressExchange::finish(const std::span<SymTensor> stress)
{
  wait();
  for (std::size_t k = 0; k < received.points.size(); ++k)
    stress[received.points[k]] = received.values[k];
}

void StressExchange::wait()
{
  if (request != MPI_REQUEST_NULL)
    MPI_Wait(&request, MPI_STATUS_IGNORE);
}
} // namespace ddfem
