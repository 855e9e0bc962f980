#include "dd/topology/collisions/sphere_table.h"

#include <algorithm>

namespace ddfem
{
void SphereTable::reset(const CellMap &map)
{
  map_ = map;
  largest_ = 0;
  entries_.clear();
  make_chains(6);
}

void SphereTable::add(const Sphere &sphere, std::uint32_t number)
{
  if (4 * entries_.size() >= chains_.size()) // most cells asked for are empty: short chains
    make_chains(bits_ + 2);
  const Vec3 centre = map_.wrapped(sphere.centre);
  const std::uint64_t key = map_.key(centre);
  std::uint32_t &chain = chains_[chain_of(key)];
  entries_.push_back({{centre, sphere.radius, sphere.segment}, key, number, chain});
  chain = static_cast<std::uint32_t>(entries_.size() - 1);
  largest_ = std::max(largest_, sphere.radius);
}

void SphereTable::make_chains(unsigned bits)
{
  bits_ = bits;
  chains_.assign(std::size_t(1) << bits, none);
  for (std::uint32_t k = 0; k < entries_.size(); ++k)
  {
    std::uint32_t &chain = chains_[chain_of(entries_[k].key)];
    entries_[k].next = chain;
    chain = k;
  }
}
} // namespace ddfem
