// Two small lists of indices that the network container is made of.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace ddfem
{
/// Short list that keeps the order of insertion; up to four entries live in place, without an allocation. Nearly every
/// node of a network has two arms, a junction node three or four.
template <class Index> class ShortList
{
public:
  std::span<const Index> view() const { return {on_heap() ? heap_.data() : inline_.data(), size_}; }
  std::span<Index> view() { return {on_heap() ? heap_.data() : inline_.data(), size_}; }
  std::size_t size() const { return size_; }

  void append(Index i)
  {
    if (size_ < capacity && !on_heap())
      inline_[size_] = i;
    else
    {
      if (!on_heap())
        heap_.assign(inline_.begin(), inline_.end());
      heap_.push_back(i);
    }
    ++size_;
  }

  /// Remove @p i, keeping the order of the others; does nothing if it is not in the list.
  void remove(Index i)
  {
    const std::span<Index> list = view();
    std::size_t kept = 0;
    for (const Index j : list)
      if (j != i)
        list[kept++] = j;
    size_ = static_cast<std::uint32_t>(kept);
    if (on_heap())
      heap_.resize(kept);
  }

private:
  static constexpr std::size_t capacity = 4;
  /// Once a list has overflowed it stays on the heap until it is empty again.
  bool on_heap() const { return !heap_.empty(); }

  std::array<Index, capacity> inline_{};
  std::vector<Index> heap_;
  std::uint32_t size_ = 0;
};

/// Indices of the live objects in increasing order. Erasing is O(1): the list is compacted when it is next looked at,
/// by whichever thread comes first.
template <class Index> class LiveIndices
{
public:
  LiveIndices() = default;
  LiveIndices(const LiveIndices &other) : list_(other.list_), stale_(other.stale_.load()) {}
  LiveIndices(LiveIndices &&other) noexcept : list_(std::move(other.list_)), stale_(other.stale_.load()) {}
  LiveIndices &operator=(const LiveIndices &other)
  {
    list_ = other.list_;
    stale_ = other.stale_.load();
    return *this;
  }
  LiveIndices &operator=(LiveIndices &&other) noexcept
  {
    list_ = std::move(other.list_);
    stale_ = other.stale_.load();
    return *this;
  }
  ~LiveIndices() = default;

  /// @p i must exceed every index appended so far.
  void append(Index i) { list_.push_back(i); }
  void mark_erased() { stale_ = true; }
  void reserve(std::size_t n) { list_.reserve(n); }
  /// The list becomes 0, 1, ... n-1.
  void reset(std::size_t n)
  {
    list_.resize(n);
    for (std::size_t i = 0; i < n; ++i)
      list_[i] = Index{static_cast<std::uint32_t>(i)};
    stale_ = false;
  }
  /// @p alive has one flag per index value.
  std::span<const Index> view(const std::vector<std::uint8_t> &alive) const
  {
    if (stale_.load(std::memory_order_acquire))
      compact(alive);
    return list_;
  }

private:
  void compact(const std::vector<std::uint8_t> &alive) const
  {
    const std::lock_guard lock(mutex_);
    if (!stale_.load(std::memory_order_relaxed))
      return;
    std::erase_if(list_, [&alive](Index i) { return alive[i.value] == 0; });
    stale_.store(false, std::memory_order_release);
  }

  mutable std::vector<Index> list_;
  mutable std::atomic<bool> stale_ = false;
  mutable std::mutex mutex_;
};
} // namespace ddfem
