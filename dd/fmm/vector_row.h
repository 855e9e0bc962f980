// Eight doubles that are computed together, and functions compiled for several instruction sets. Internal to dd/fmm.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__)
/// The loader takes the best version that the processor has.
#define DDFEM_FMM_EVERY_PROCESSOR __attribute__((target_clones("avx512f", "fma", "default")))
#else
#define DDFEM_FMM_EVERY_PROCESSOR
#endif
/// What such a function calls must become part of it.
#define DDFEM_FMM_INLINE inline __attribute__((always_inline))

namespace ddfem::fmm
{
inline constexpr std::size_t row_width = 8;
inline constexpr std::size_t row_size = row_width * sizeof(double);

/// Vectors of the compiler (GCC, Clang). Passed by pointer or reference only, since the calling convention depends on the
/// processor; so does the natural alignment, which is therefore not relied on (but provided, for speed).
struct DoubleRows
{
  using Scalar = double;
  static constexpr std::size_t width = row_width;
  using Row = double __attribute__((vector_size(row_size), aligned(sizeof(double)), may_alias));
};
struct SingleRows
{
  using Scalar = float;
  static constexpr std::size_t width = row_width;
  using Row = float __attribute__((vector_size(row_size / 2), aligned(sizeof(float)), may_alias));
};
/// Two SingleRows side by side.
struct WideSingleRows
{
  using Scalar = float;
  static constexpr std::size_t width = 2 * row_width;
  using Row = float __attribute__((vector_size(row_size), aligned(sizeof(float)), may_alias));
};
using Row = DoubleRows::Row;

/// What is computed with numbers of one type: `Narrow` rows hold one expansion each of eight fields, `Wide` ones fill row_size bytes.
template <class Scalar> struct Precision;
template <> struct Precision<double>
{
  using Narrow = DoubleRows;
  using Wide = DoubleRows;
};
template <> struct Precision<float>
{
  using Narrow = SingleRows;
  using Wide = WideSingleRows;
};

template <class T> struct RowAllocator
{
  using value_type = T;
  RowAllocator() = default;
  template <class U> explicit RowAllocator(const RowAllocator<U> &) {}
  T *allocate(std::size_t n) { return static_cast<T *>(::operator new(n * sizeof(T), std::align_val_t(row_size))); }
  void deallocate(T *p, std::size_t) { ::operator delete(p, std::align_val_t(row_size)); }
  bool operator==(const RowAllocator &) const { return true; }
};

/// Rows in memory, zero at first; also seen as numbers, eight per row.
class RowBuffer
{
public:
  RowBuffer() = default;
  explicit RowBuffer(std::size_t n_rows) : numbers(n_rows * row_width, 0.0) {}

  std::size_t size() const { return numbers.size() / row_width; } ///< in rows
  void set_zero() { numbers.assign(numbers.size(), 0.0); }
  Row *rows() { return reinterpret_cast<Row *>(numbers.data()); }
  const Row *rows() const { return reinterpret_cast<const Row *>(numbers.data()); }
  const double *data() const { return numbers.data(); }
  double &operator()(std::size_t row, std::size_t column) { return numbers[row * row_width + column]; }
  double operator()(std::size_t row, std::size_t column) const { return numbers[row * row_width + column]; }

private:
  std::vector<double, RowAllocator<double>> numbers;
};
} // namespace ddfem::fmm
