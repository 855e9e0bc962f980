// A few bounding spheres that come and go, found by the cell that they lie in.
#pragma once

#include "dd/topology/collisions/sphere_grid.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ddfem
{
/// Spheres added one by one, in chains of those whose cells have the same hash value. For the few that a SphereGrid
/// does not hold: slower by a factor, but nothing is sorted. Each carries a number of the caller's.
class SphereTable
{
public:
  /// Forgets all spheres.
  void reset(const CellMap &map);
  void add(const Sphere &sphere, std::uint32_t number);
  std::size_t size() const { return entries_.size(); }

  /// f(segment, number) for every sphere whose surface is no farther than @p reach (nm) from the point @p x.
  template <class F> std::size_t near(const Vec3 &x, double reach, F &&f) const;

private:
  struct Entry
  {
    Sphere sphere; ///< centre wrapped
    std::uint64_t key;
    std::uint32_t number, next;
  };
  static constexpr std::uint32_t none = 0xffffffffU;

  std::size_t chain_of(std::uint64_t key) const { return hash_of_neighbourhood(key, 6, bits_); }
  void make_chains(unsigned bits);

  CellMap map_;
  double largest_ = 0; ///< radius, nm
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> chains_; ///< newest entry of each
  unsigned bits_ = 0;                 ///< binary logarithm of their number
};

template <class F> std::size_t SphereTable::near(const Vec3 &x, double reach, F &&f) const
{
  if (entries_.empty())
    return 0;
  std::size_t tests = 0;
  const Vec3 centre = map_.wrapped(x);
  const auto test = [&](const Entry &e)
  {
    ++tests;
    const Vec3 d = e.sphere.centre - centre;
    const double sum = e.sphere.radius + reach;
    if (map_.squared_distance(d[0], d[1], d[2]) <= sum * sum)
      f(e.sphere.segment, e.number);
  };
  const CellMap::Range range = map_.around(centre, reach + largest_);
  if (range.n_cells() > static_cast<double>(size()))
    for (const Entry &e : entries_)
      test(e);
  else
    map_.for_each_key(range,
                      [&](std::uint64_t key)
                      {
                        for (std::uint32_t k = chains_[chain_of(key)]; k != none; k = entries_[k].next)
                          if (entries_[k].key == key)
                            test(entries_[k]);
                      });
  return tests;
}
} // namespace ddfem
