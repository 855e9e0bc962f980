// Defragmentation: sort by Morton index and compact (Durocher, thesis, Bordeaux 2018, section II.3.2.2).
#include "dd/common/morton.h"
#include "dd/network/network.h"

#include <algorithm>

namespace ddfem
{
namespace
{
/// Smallest cube with the lower corner of the bounding box of the points.
struct Cube
{
  Vec3 origin = Vec3::Zero();
  double width = 0;
};

template <class Index, class Position> Cube bounding_cube(std::span<const Index> range, Position &&position)
{
  if (range.empty())
    return {};
  Vec3 lower = position(range[0]), upper = lower;
  for (const Index i : range)
  {
    const Vec3 &x = position(i);
    lower = lower.cwiseMin(x);
    upper = upper.cwiseMax(x);
  }
  return {lower, (upper - lower).maxCoeff()};
}

struct SortKey
{
  std::uint64_t morton = 0;
  ObjectId id = 0;
  std::uint32_t old = 0;
  bool operator<(const SortKey &other) const { return morton != other.morton ? morton < other.morton : id < other.id; }
};

/// Old index values in the new order.
template <class Index, class Position, class Id>
std::vector<std::uint32_t> morton_order(std::span<const Index> range, Position &&position, Id &&id)
{
  const Cube cube = bounding_cube(range, position);
  std::vector<SortKey> keys(range.size());
#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < range.size(); ++k)
    keys[k] = {morton_index(position(range[k]), cube.origin, cube.width), id(range[k]), range[k].value};
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order(keys.size());
  std::transform(keys.begin(), keys.end(), order.begin(), [](const SortKey &key) { return key.old; });
  return order;
}

/// new[i] = old[order[i]]
template <class T> void permute(std::vector<T> &values, const std::vector<std::uint32_t> &order)
{
  std::vector<T> sorted;
  sorted.reserve(order.size());
  for (const std::uint32_t old : order)
    sorted.push_back(std::move(values[old]));
  values = std::move(sorted);
}

template <class Index> std::vector<Index> inverse(const std::vector<std::uint32_t> &order, std::size_t old_size)
{
  std::vector<Index> new_index(old_size);
  for (std::size_t i = 0; i < order.size(); ++i)
    new_index[order[i]] = Index{static_cast<std::uint32_t>(i)};
  return new_index;
}
} // namespace

void Network::clean_nodes()
{
  const auto order = morton_order(
      nodes(), [this](NodeIndex i) -> const Vec3 & { return position(i); }, [this](NodeIndex i) { return id(i); });
  const auto new_index = inverse<NodeIndex>(order, node_capacity());
  permute(position_, order);
  permute(constraint_, order);
  permute(node_id_, order);
  permute(arms_, order);
  node_alive_.assign(order.size(), 1);
  live_nodes_.reset(order.size());
  for (auto &[id, index] : node_of_id_)
    index = new_index[index.value];
  for (const SegmentIndex s : segments())
  {
    start_[s.value] = new_index[start(s).value];
    end_[s.value] = new_index[end(s).value];
  }
}

void Network::clean_segments()
{
  const auto order = morton_order(
      segments(), [this](SegmentIndex s) { return Vec3(position(start(s)) + 0.5 * direction(s)); },
      [this](SegmentIndex s) { return id(s); });
  const auto new_index = inverse<SegmentIndex>(order, segment_capacity());
  permute(start_, order);
  permute(end_, order);
  permute(burgers_, order);
  permute(plane_, order);
  permute(segment_id_, order);
  segment_alive_.assign(order.size(), 1);
  live_segments_.reset(order.size());
  for (auto &[id, index] : segment_of_id_)
    index = new_index[index.value];
  for (ShortList<SegmentIndex> &arms : arms_)
  {
    for (SegmentIndex &s : arms.view())
      s = new_index[s.value];
    std::ranges::sort(arms.view(), {}, [this](SegmentIndex s) { return id(s); });
  }
}

void Network::clean()
{
  clean_nodes();
  clean_segments();
  ++n_cleans_;
}
} // namespace ddfem
