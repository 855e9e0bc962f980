// Coefficients of boxes in the precision in which they are kept. Internal to dd/fmm.
#pragma once

#include "dd/fmm/stress_expansion.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

namespace ddfem::fmm
{
/// Coefficients of one box, see ExpansionView.
template <class Scalar> struct BoxExpansion
{
  typename Precision<Scalar>::Narrow::Row *fields;
  Scalar *q;
};

/// Multipole or local coefficients of some boxes.
template <class Scalar> class Expansions
{
public:
  void reset(std::size_t n_boxes, int order)
  {
    n = n_harmonics(order);
    fields.assign(n_boxes * n * row_width, Scalar{});
    q.assign(n_boxes * n, Scalar{});
  }
  BoxExpansion<Scalar> of(const std::size_t box)
  {
    using RowOfFields = typename Precision<Scalar>::Narrow::Row;
    return {reinterpret_cast<RowOfFields *>(fields.data() + box * n * row_width), q.data() + box * n};
  }

  /// Adds coefficients in double precision.
  void add(const std::size_t box, const ExpansionView &given)
  {
    const BoxExpansion<Scalar> sum = of(box);
    for (std::size_t k = 0; k < n; ++k)
    {
      for (std::size_t c = 0; c < row_width; ++c)
        sum.fields[k][c] += static_cast<Scalar>(given.fields[k][c]);
      sum.q[k] += static_cast<Scalar>(given.q[k]);
    }
  }
  /// Adds @p factor times the coefficients of a box to @p result.
  void add_to(const ExpansionView &result, const std::size_t box, const double factor) const
  {
    const Scalar *const of_fields = fields.data() + box * n * row_width;
    for (std::size_t k = 0; k < n; ++k)
    {
      for (std::size_t c = 0; c < row_width; ++c)
        result.fields[k][c] += factor * static_cast<double>(of_fields[k * row_width + c]);
      result.q[k] += factor * static_cast<double>(q[box * n + k]);
    }
  }
  /// Copies the coefficients of box number @p from of @p other.
  void copy(const std::size_t to, const Expansions &other, const std::size_t from)
  {
    const auto copy_one = [&](const auto &source, auto &target, const std::size_t width)
    { std::copy_n(source.data() + from * width, width, target.data() + to * width); };
    copy_one(other.fields, fields, n * row_width);
    copy_one(other.q, q, n);
  }

  /// Of one box, as bytes.
  std::size_t n_bytes() const { return n * (row_width + 1) * sizeof(Scalar); }
  void pack(const std::size_t box, std::byte *const to) const
  {
    std::memcpy(to, fields.data() + box * n * row_width, n * row_width * sizeof(Scalar));
    std::memcpy(to + n * row_width * sizeof(Scalar), q.data() + box * n, n * sizeof(Scalar));
  }
  void unpack(const std::size_t box, const std::byte *const from)
  {
    std::memcpy(fields.data() + box * n * row_width, from, n * row_width * sizeof(Scalar));
    std::memcpy(q.data() + box * n, from + n * row_width * sizeof(Scalar), n * sizeof(Scalar));
  }

private:
  std::size_t n = 0;
  std::vector<Scalar, RowAllocator<Scalar>> fields;
  std::vector<Scalar> q;
};

/// Coefficients of one box in double precision, zero at first.
struct BoxBuffer
{
  RowBuffer fields;
  std::vector<double> q;

  explicit BoxBuffer(const int order) : fields(n_harmonics(order)), q(n_harmonics(order), 0.0) {}
  ExpansionView view() { return {fields.rows(), q.data()}; }
};
} // namespace ddfem::fmm
