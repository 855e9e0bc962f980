// Small dense matrices times rows, and rotations of harmonics about z: the loops of the translations. Internal to dd/fmm.
#pragma once

#include "dd/fmm/solid_harmonics.h"

namespace ddfem::fmm
{
inline constexpr std::size_t rows_at_once = 4;

/// out[i] = sum_j matrix[i][j] in[j] for @p n_rows rows and @p n columns; positions of rows by @p place_in and @p place_out.
template <class Rows, std::size_t n_rows, class PlaceIn, class PlaceOut>
DDFEM_FMM_INLINE void multiply_rows(const typename Rows::Scalar *matrix, const std::size_t n,
                                    const typename Rows::Row *in, PlaceIn place_in, typename Rows::Row *out,
                                    PlaceOut place_out, const std::size_t first)
{
  typename Rows::Row sum[n_rows] = {};
  for (std::size_t j = 0; j < n; ++j)
  {
    const typename Rows::Row value = in[place_in(j)];
    for (std::size_t i = 0; i < n_rows; ++i)
      sum[i] += matrix[i * n + j] * value;
  }
  for (std::size_t i = 0; i < n_rows; ++i)
    out[place_out(first + i)] = sum[i];
}

/// The same for a matrix of @p n_out rows.
template <class Rows, class PlaceIn, class PlaceOut>
DDFEM_FMM_INLINE void multiply(const typename Rows::Scalar *matrix, const std::size_t n_out, const std::size_t n,
                               const typename Rows::Row *in, PlaceIn place_in, typename Rows::Row *out,
                               PlaceOut place_out)
{
  std::size_t i = 0;
  for (; i + rows_at_once <= n_out; i += rows_at_once)
    multiply_rows<Rows, rows_at_once>(matrix + i * n, n, in, place_in, out, place_out, i);
  if (i + 2 <= n_out)
  {
    multiply_rows<Rows, 2>(matrix + i * n, n, in, place_in, out, place_out, i);
    i += 2;
  }
  if (i < n_out)
    multiply_rows<Rows, 1>(matrix + i * n, n, in, place_in, out, place_out, i);
}

/// Turns about z by the angle whose multiples are in @p phase: coordinates in which the vector has phi = 0.
template <class Rows>
DDFEM_FMM_INLINE void turn_to_axis(const int order, const typename Rows::Scalar *phase, const typename Rows::Row *in,
                                   typename Rows::Row *out)
{
  for (int l = 0; l <= order; ++l)
  {
    const typename Rows::Row *const from = in + harmonic_index(l, 0);
    typename Rows::Row *const to = out + harmonic_index(l, 0);
    to[0] = from[0];
    for (int m = 1; m <= l; ++m)
    {
      const typename Rows::Scalar c = phase[2 * m], s = phase[2 * m + 1];
      to[m] = c * from[m] + s * from[-m];
      to[-m] = c * from[-m] - s * from[m];
    }
  }
}

template <class Rows>
DDFEM_FMM_INLINE void add_turned_back(const int order, const typename Rows::Scalar *phase, const typename Rows::Row *in,
                                      typename Rows::Row *out)
{
  for (int l = 0; l <= order; ++l)
  {
    const typename Rows::Row *const from = in + harmonic_index(l, 0);
    typename Rows::Row *const to = out + harmonic_index(l, 0);
    to[0] += from[0];
    for (int m = 1; m <= l; ++m)
    {
      const typename Rows::Scalar c = phase[2 * m], s = phase[2 * m + 1];
      to[m] += c * from[m] - s * from[-m];
      to[-m] += c * from[-m] + s * from[m];
    }
  }
}
} // namespace ddfem::fmm
