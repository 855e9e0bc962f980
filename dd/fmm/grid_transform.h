// Discrete Fourier transforms on the grids of boxes, and the spectra of many boxes.
#pragma once

#include "dd/fmm/vector_row.h"

#include <cstddef>
#include <vector>

namespace ddfem::fmm
{
/// Transforms of eight sets of real values side by side, from grids of n points per direction to the frequencies of the period
/// 2n-1: cyclic convolutions of that period are the plain ones on the grid. Of each pair of conjugate frequencies
/// along z one is kept. By dense matrices, direction by direction: lengths are small and odd, most of the input is zero, most
/// of the output is not wanted, and eight sets fill a vector (docs/decisions.md, 57).
class GridTransform
{
public:
  explicit GridTransform(std::size_t n_points);

  std::size_t n() const { return n_points; }
  std::size_t period() const { return 2 * n_points - 1; }
  std::size_t n_frequencies() const { return period() * period() * n_points; }

  /// Of n^3 rows, zero elsewhere. Rows 2f and 2f+1 of the result: real and imaginary part at frequency f.
  void forward(const Row *values, RowBuffer &spectrum) const { forward(n_points, values, spectrum); }
  /// Of period^3 rows.
  void forward_of_period(const Row *values, RowBuffer &spectrum) const { forward(period(), values, spectrum); }
  /// Adds the values on the first n^3 points, without the factor 1/period^3. The spectrum is overwritten.
  void add_backward(RowBuffer &spectrum, Row *values) const;

private:
  void forward(std::size_t n_values, const Row *values, RowBuffer &spectrum) const;

  std::size_t n_points;
  std::vector<double> phase; ///< cosine and sine of 2 pi m/period, m < period
};

/// Spectra of several quantities of many items, in blocks of eight frequencies: what one block needs is contiguous.
class Spectra
{
public:
  Spectra(std::size_t n_frequencies_, std::size_t n_items_, std::size_t n_quantities_)
      : n_frequencies(n_frequencies_), n_items(n_items_), n_quantities(n_quantities_),
        rows(n_blocks() * n_items * 2 * n_quantities)
  {
  }

  std::size_t n_blocks() const { return (n_frequencies + row_width - 1) / row_width; }
  std::size_t n_rows() const { return rows.size(); }
  /// All items of a block, for each of them real and imaginary part of each quantity.
  Row *block(std::size_t b) { return rows.rows() + b * n_items * 2 * n_quantities; }
  const Row *block(std::size_t b) const { return rows.rows() + b * n_items * 2 * n_quantities; }

  /// Takes column @p column of a spectrum as one quantity of an item, or its negative complex conjugate.
  void set(std::size_t item, std::size_t quantity, const RowBuffer &spectrum, std::size_t column,
           bool negative_conjugate = false);
  /// All quantities of an item as the columns of a spectrum.
  void get(std::size_t item, RowBuffer &spectrum) const;

private:
  std::size_t row(std::size_t block, std::size_t item, std::size_t quantity) const
  {
    return 2 * ((block * n_items + item) * n_quantities + quantity);
  }

  std::size_t n_frequencies, n_items, n_quantities;
  RowBuffer rows;
};
} // namespace ddfem::fmm
