#include "dd/topology/collisions/sphere_grid.h"

#include <omp.h>

#include <algorithm>
#include <bit>
#include <utility>

namespace ddfem
{
namespace
{
struct Entry
{
  std::uint64_t key;
  std::uint32_t sphere;
};

constexpr unsigned digit_bits = 11;
constexpr std::size_t n_digits = 1U << digit_bits;

/// One pass of a stable radix sort by the bits of the key from @p shift on. Every thread sorts a part of its own to
/// places that the parts before it leave free: the result does not depend on the number of threads.
void sort_by_digit(const std::vector<Entry> &from, std::vector<Entry> &to, unsigned shift)
{
  const auto digit = [shift](const Entry &e) { return (e.key >> shift) & (n_digits - 1); };
  std::vector<std::vector<std::uint32_t>> places;
#pragma omp parallel if (from.size() > least_for_threads)
  {
    const auto thread = static_cast<std::size_t>(omp_get_thread_num());
    const auto n_threads = static_cast<std::size_t>(omp_get_num_threads());
    const std::size_t begin = from.size() * thread / n_threads, end = from.size() * (thread + 1) / n_threads;
#pragma omp single
    places.resize(n_threads);
    std::vector<std::uint32_t> &place = places[thread];
    place.assign(n_digits, 0);
    for (std::size_t k = begin; k < end; ++k)
      ++place[digit(from[k])];
#pragma omp barrier
#pragma omp single
    {
      std::uint32_t next = 0;
      for (std::size_t d = 0; d < n_digits; ++d)
        for (std::vector<std::uint32_t> &p : places)
          next += std::exchange(p[d], next);
    }
    for (std::size_t k = begin; k < end; ++k)
      to[place[digit(from[k])]++] = from[k];
  }
}

/// Spheres in the order of their cells, within a cell in the order given.
std::vector<Entry> sorted_entries(const std::vector<Sphere> &spheres, const CellMap &map)
{
  std::vector<Entry> entries(spheres.size()), other(spheres.size());
#pragma omp parallel for schedule(static) if (spheres.size() > least_for_threads)
  for (std::size_t k = 0; k < spheres.size(); ++k)
    entries[k] = {map.key(map.wrapped(spheres[k].centre)), static_cast<std::uint32_t>(k)};
  for (unsigned shift = 0; shift < map.key_bits(); shift += digit_bits)
  {
    sort_by_digit(entries, other, shift);
    entries.swap(other);
  }
  return entries;
}
} // namespace

void SphereGrid::build(const std::vector<Sphere> &spheres, const CellMap &map)
{
  map_ = map;
  const std::vector<Entry> entries = sorted_entries(spheres, map);
  const std::size_t n = spheres.size();
  for (std::vector<double> *values : {&x_, &y_, &z_, &r_})
    values->resize(n);
  segment_.resize(n);
  partner_.resize(n);
  largest_ = 0;
  std::vector<std::uint32_t> place(n);
  double largest = 0;
#pragma omp parallel for schedule(static) reduction(max : largest) if (n > least_for_threads)
  for (std::size_t i = 0; i < n; ++i)
  {
    const Sphere &s = spheres[entries[i].sphere];
    const Vec3 x = map.wrapped(s.centre);
    x_[i] = x[0];
    y_[i] = x[1];
    z_[i] = x[2];
    r_[i] = s.radius;
    segment_[i] = s.segment;
    place[entries[i].sphere] = static_cast<std::uint32_t>(i);
    largest = std::max(largest, s.radius);
  }
  largest_ = largest;
#pragma omp parallel for schedule(static) if (n > least_for_threads)
  for (std::size_t i = 0; i < n; ++i)
    partner_[i] = place[entries[i].sphere ^ 1U];
  cells_.clear();
  blocks_.clear();
  for (std::size_t i = 0; i < n; ++i)
    if (i == 0 || entries[i].key != entries[i - 1].key)
      add_cell(entries[i].key, static_cast<std::uint32_t>(i));
  blocks_.push_back({0, 0, static_cast<std::uint32_t>(cells_.size())});
  cells_.push_back(static_cast<std::uint32_t>(n));
  make_table();
}

void SphereGrid::add_cell(std::uint64_t key, std::uint32_t first_sphere)
{
  if (blocks_.empty() || blocks_.back().key != key >> block_bits)
    blocks_.push_back({key >> block_bits, 0, static_cast<std::uint32_t>(cells_.size())});
  blocks_.back().occupied |= std::uint64_t(1) << (key & 63U);
  cells_.push_back(first_sphere);
}

void SphereGrid::make_table()
{
  const std::size_t slots = std::bit_ceil(2 * blocks_.size());
  table_bits_ = static_cast<unsigned>(std::bit_width(slots - 1));
  table_.assign(slots, none);
  for (std::size_t b = 0; b < n_blocks(); ++b)
  {
    std::size_t slot = first_slot(blocks_[b].key);
    while (table_[slot] != none)
      slot = (slot + 1) & (slots - 1);
    table_[slot] = static_cast<std::uint32_t>(b);
  }
}

double SphereGrid::nearest_gap(std::uint32_t i, std::uint32_t j) const
{
  const std::uint32_t k = partner_[i], l = partner_[j];
  const auto gap = [this](std::uint32_t a, std::uint32_t b)
  { return std::sqrt(squared_distance(a, b)) - (r_[a] + r_[b]); };
  const double own = gap(i, j);
  // Equal distances: the combination with the lowest numbers counts.
  const auto precedes = [&](std::uint32_t a, std::uint32_t b)
  {
    const double other = gap(a, b);
    return other < own || (other == own && std::minmax(a, b) < std::minmax(i, j));
  };
  return precedes(i, l) || precedes(k, j) || precedes(k, l) ? NAN : own;
}

std::uint32_t SphereGrid::find_block(std::uint64_t key) const
{
  for (std::size_t slot = first_slot(key);; slot = (slot + 1) & (table_.size() - 1))
    if (table_[slot] == none || blocks_[table_[slot]].key == key)
      return table_[slot];
}
} // namespace ddfem
