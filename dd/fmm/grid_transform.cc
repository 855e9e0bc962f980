#include "dd/fmm/grid_transform.h"

#include <cmath>
#include <numbers>

namespace ddfem::fmm
{
namespace
{
/// Cosine and sine (times @p sign) of 2 pi j k/period for @p n_out values k and @p n_in values j.
std::vector<double> factors(const std::vector<double> &phase, const std::size_t n_out, const std::size_t n_in,
                            const double sign)
{
  std::vector<double> result;
  const std::size_t period = phase.size() / 2;
  for (std::size_t k = 0; k < n_out; ++k)
    for (std::size_t j = 0; j < n_in; ++j)
    {
      const std::size_t m = j * k % period;
      result.push_back(phase[2 * m]);
      result.push_back(sign * phase[2 * m + 1]);
    }
  return result;
}

/// Transform of real rows along the last direction, which becomes the first one of the result.
DDFEM_FMM_EVERY_PROCESSOR
void transform_real(const std::size_t n_out, const std::size_t n_in, const std::size_t n_rest, const double *factor,
                    const Row *in, Row *out)
{
  for (std::size_t r = 0; r < n_rest; ++r)
    for (std::size_t k = 0; k < n_out; ++k)
    {
      Row re = {}, im = {};
      for (std::size_t j = 0; j < n_in; ++j)
      {
        const double *const f = factor + 2 * (k * n_in + j);
        re += f[0] * in[r * n_in + j];
        im += f[1] * in[r * n_in + j];
      }
      out[2 * (k * n_rest + r)] = re;
      out[2 * (k * n_rest + r) + 1] = im;
    }
}

/// Transform of complex rows. Input j of r is at j in_stride + r rest_stride, and so are the results.
struct Strides
{
  std::size_t in, in_rest, out, out_rest;
};

DDFEM_FMM_EVERY_PROCESSOR
void transform_complex(const std::size_t n_out, const std::size_t n_in, const std::size_t n_rest,
                       const Strides &strides, const double *factor, const Row *in, Row *out)
{
  for (std::size_t r = 0; r < n_rest; ++r)
    for (std::size_t k = 0; k < n_out; ++k)
    {
      Row re = {}, im = {};
      for (std::size_t j = 0; j < n_in; ++j)
      {
        const double c = factor[2 * (k * n_in + j)], s = factor[2 * (k * n_in + j) + 1];
        const Row *const x = in + 2 * (j * strides.in + r * strides.in_rest);
        re += c * x[0] - s * x[1];
        im += c * x[1] + s * x[0];
      }
      Row *const y = out + 2 * (k * strides.out + r * strides.out_rest);
      y[0] = re;
      y[1] = im;
    }
}

/// Adds the real values along z of half a spectrum: frequencies but the first stand for themselves and their conjugate.
DDFEM_FMM_EVERY_PROCESSOR
void add_real_parts(const std::size_t n, const std::size_t n_rest, const double *factor, const Row *in, Row *out)
{
  for (std::size_t r = 0; r < n_rest; ++r)
    for (std::size_t z = 0; z < n; ++z)
    {
      Row sum = {};
      for (std::size_t k = 1; k < n; ++k)
      {
        const double *const f = factor + 2 * (z * n + k);
        const Row *const x = in + 2 * (k * n_rest + r);
        sum += f[0] * x[0] - f[1] * x[1];
      }
      out[r * n + z] += in[2 * r] + 2.0 * sum;
    }
}
} // namespace

GridTransform::GridTransform(const std::size_t n) : n_points(n)
{
  for (std::size_t m = 0; m < period(); ++m)
  {
    const double angle = 2 * std::numbers::pi * static_cast<double>(m) / static_cast<double>(period());
    phase.push_back(std::cos(angle));
    phase.push_back(std::sin(angle));
  }
}

void GridTransform::forward(const std::size_t m, const Row *const values, RowBuffer &spectrum) const
{
  // (x, y, z) -> (kz, x, y) -> (ky, kz, x) -> (kx, ky, kz): the last direction becomes the first each time.
  const std::size_t n = n_points, p = period();
  RowBuffer along_z(2 * n * m * m), along_y(2 * p * n * m);
  spectrum = RowBuffer(2 * n_frequencies());
  const std::vector<double> half = factors(phase, n, m, -1), full = factors(phase, p, m, -1);
  transform_real(n, m, m * m, half.data(), values, along_z.rows());
  transform_complex(p, m, n * m, {1, m, n * m, 1}, full.data(), along_z.rows(), along_y.rows());
  transform_complex(p, m, p * n, {1, m, p * n, 1}, full.data(), along_y.rows(), spectrum.rows());
}

void GridTransform::add_backward(RowBuffer &spectrum, Row *const values) const
{
  // (kx, ky, kz) -> (ky, kz, x) -> (kz, x, y) -> (x, y, z): the way back.
  const std::size_t n = n_points, p = period();
  RowBuffer along_x(2 * p * n * n);
  const std::vector<double> factor = factors(phase, n, p, 1), half = factors(phase, n, n, 1);
  transform_complex(n, p, p * n, {p * n, 1, 1, n}, factor.data(), spectrum.rows(), along_x.rows());
  transform_complex(n, p, n * n, {n * n, 1, 1, n}, factor.data(), along_x.rows(), spectrum.rows());
  add_real_parts(n, n * n, half.data(), spectrum.rows(), values);
}

void Spectra::set(const std::size_t item, const std::size_t quantity, const RowBuffer &spectrum,
                  const std::size_t column, const bool negative_conjugate)
{
  const double sign = negative_conjugate ? -1 : 1;
  for (std::size_t f = 0; f < n_frequencies; ++f)
  {
    const std::size_t k = row(f / row_width, item, quantity), lane = f % row_width;
    rows(k, lane) = sign * spectrum(2 * f, column);
    rows(k + 1, lane) = spectrum(2 * f + 1, column);
  }
}

void Spectra::get(const std::size_t item, RowBuffer &spectrum) const
{
  for (std::size_t f = 0; f < n_frequencies; ++f)
    for (std::size_t q = 0; q < n_quantities; ++q)
    {
      const std::size_t k = row(f / row_width, item, q), lane = f % row_width;
      spectrum(2 * f, q) = rows(k, lane);
      spectrum(2 * f + 1, q) = rows(k + 1, lane);
    }
}
} // namespace ddfem::fmm
