#include "dd/fmm/grid_kernel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ddfem::fmm
{
namespace
{
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// Eight complex numbers; a view of two rows.
struct __attribute__((may_alias)) ComplexRow
{
  Row re, im;
};

// The operations that the formula needs, on numbers and in Fourier space; results by reference (see Row).
DDFEM_FMM_INLINE void add(const double &a, double &sum)
{
  sum += a;
}
DDFEM_FMM_INLINE void subtract(const double &a, double &sum)
{
  sum -= a;
}
DDFEM_FMM_INLINE void scale(const double factor, double &value)
{
  value *= factor;
}
DDFEM_FMM_INLINE void add_product(const double &a, const double &b, double &sum)
{
  sum += a * b;
}
DDFEM_FMM_INLINE void subtract_product(const double &a, const double &b, double &sum)
{
  sum -= a * b;
}
DDFEM_FMM_INLINE void add(const ComplexRow &a, ComplexRow &sum)
{
  sum.re += a.re;
  sum.im += a.im;
}
DDFEM_FMM_INLINE void subtract(const ComplexRow &a, ComplexRow &sum)
{
  sum.re -= a.re;
  sum.im -= a.im;
}
DDFEM_FMM_INLINE void scale(const double factor, ComplexRow &value)
{
  value.re *= factor;
  value.im *= factor;
}
DDFEM_FMM_INLINE void add_product(const ComplexRow &a, const ComplexRow &b, ComplexRow &sum)
{
  sum.re += a.re * b.re;
  sum.re -= a.im * b.im;
  sum.im += a.re * b.im;
  sum.im += a.im * b.re;
}
DDFEM_FMM_INLINE void subtract_product(const ComplexRow &a, const ComplexRow &b, ComplexRow &sum)
{
  sum.re -= a.re * b.re;
  sum.re += a.im * b.im;
  sum.im -= a.re * b.im;
  sum.im -= a.im * b.re;
}

/// Adds L_i (eps_ima A_mb + eps_imb A_ma); the diagonal of A enters by differences.
template <class Value>
DDFEM_FMM_INLINE void add_curl(const Value &Lx, const Value &Ly, const Value &Lz, const Value *A, Value *stress)
{
  const Value &xx_yy = A[0], &yy_zz = A[1], &xy = A[2], &yx = A[3], &xz = A[4], &zx = A[5], &yz = A[6], &zy = A[7];
  Value half[3] = {};
  add_product(Ly, zx, half[0]);
  subtract_product(Lz, yx, half[0]);
  add_product(Lz, xy, half[1]);
  subtract_product(Lx, zy, half[1]);
  add_product(Lx, yz, half[2]);
  subtract_product(Ly, xz, half[2]);
  for (int c = 0; c < 3; ++c)
  {
    add(half[c], stress[c]);
    add(half[c], stress[c]);
  }
  add_product(Lz, xx_yy, stress[3]);
  add_product(Ly, zy, stress[3]);
  subtract_product(Lx, zx, stress[3]);
  subtract_product(Ly, xx_yy, stress[4]);
  subtract_product(Ly, yy_zz, stress[4]);
  subtract_product(Lz, yz, stress[4]);
  add_product(Lx, yx, stress[4]);
  add_product(Lx, yy_zz, stress[5]);
  add_product(Lz, xz, stress[5]);
  subtract_product(Ly, xy, stress[5]);
}

/// Adds 8 pi/mu sigma, components xx yy zz xy xz yz; @p two_m = 2/(1 - nu).
template <class Value>
DDFEM_FMM_INLINE void add_stress(const double two_m, const Value *D, const Value *A, Value *stress)
{
  Value L[3] = {D[0], D[1], D[2]};
  add(D[3], L[0]);
  add(D[5], L[0]);
  add(D[6], L[1]);
  add(D[8], L[1]);
  add(D[7], L[2]);
  add(D[9], L[2]);
  add_curl(L[0], L[1], L[2], A, stress);

  Value P[3] = {A[6], A[5], A[2]};
  subtract(A[7], P[0]);
  subtract(A[4], P[1]);
  subtract(A[3], P[2]);
  Value LP = {};
  for (int i = 0; i < 3; ++i)
  {
    scale(two_m, P[i]);
    add_product(L[i], P[i], LP);
  }
  for (int c = 0; c < 3; ++c)
    subtract(LP, stress[c]);
  // D_iab for i = x, y, z and ab = xx yy zz xy xz yz
  constexpr std::size_t index[6][3] = {{0, 1, 2}, {3, 6, 7}, {5, 8, 9}, {1, 3, 4}, {2, 4, 5}, {4, 7, 8}};
  for (std::size_t c = 0; c < n_stresses; ++c)
    for (std::size_t i = 0; i < 3; ++i)
      add_product(D[index[c][i]], P[i], stress[c]);
}

bool is_upper(const Offset &o)
{
  return o > Offset{0, 0, 0};
}

Offset opposite(const Offset &o)
{
  const auto minus = [](const std::int16_t i) { return static_cast<std::int16_t>(-i); };
  return {minus(o[0]), minus(o[1]), minus(o[2])};
}

int largest_of(const std::span<const Offset> offsets)
{
  int largest = 0;
  for (const Offset &o : offsets)
    for (const std::int16_t i : o)
      largest = std::max(largest, std::abs(i));
  return largest;
}
} // namespace

std::array<double, n_kernels> third_derivatives(const Vec3 &R, const double a)
{
  const double Ra2 = R.squaredNorm() + a * a, inverse = 1 / (Ra2 * std::sqrt(Ra2));
  const auto D = [&](int i, int j, int k)
  {
    const double linear = (i == j ? R[k] : 0.0) + (i == k ? R[j] : 0.0) + (j == k ? R[i] : 0.0);
    return inverse * (3 * R[i] * R[j] * R[k] / Ra2 - linear);
  };
  return {D(0, 0, 0), D(0, 0, 1), D(0, 0, 2), D(0, 1, 1), D(0, 1, 2),
          D(0, 2, 2), D(1, 1, 1), D(1, 1, 2), D(1, 2, 2), D(2, 2, 2)};
}

std::array<double, n_densities> line_density(const Vec3 &b, const Vec3 &d)
{
  return {b[0] * d[0] - b[1] * d[1],
          b[1] * d[1] - b[2] * d[2],
          b[0] * d[1],
          b[1] * d[0],
          b[0] * d[2],
          b[2] * d[0],
          b[1] * d[2],
          b[2] * d[1]};
}

SymTensor stress_of_density(const IsotropicMedium &medium, const std::array<double, n_kernels> &D,
                            const std::array<double, n_densities> &A)
{
  SymTensor stress = SymTensor::Zero();
  add_stress(2 / (1 - medium.nu), D.data(), A.data(), stress.data());
  return medium.mu / (8 * std::numbers::pi) * stress;
}

GridKernel::GridKernel(const GridTransform &transform, const IsotropicMedium &medium, const Vec3 &spacing,
                       const Vec3 &edges, const std::span<const Offset> offsets)
    : largest_offset(largest_of(offsets)), values(0, 0, 0)
{
  const int n = 2 * largest_offset + 1, volume = n * n * n;
  numbers.assign(static_cast<std::size_t>(volume), none);
  // D is odd: opposite offsets have the negative complex conjugate spectra. One of each pair is transformed.
  std::vector<Offset> upper;
  for (const Offset &o : offsets)
    upper.push_back(is_upper(o) ? o : opposite(o));
  std::sort(upper.begin(), upper.end());
  upper.erase(std::unique(upper.begin(), upper.end()), upper.end());
  for (std::uint32_t k = 0; k < upper.size(); ++k)
  {
    numbers[place(upper[k])] = 2 * k;
    numbers[place(opposite(upper[k]))] = 2 * k + 1;
  }
  values = Spectra(transform.n_frequencies(), 2 * upper.size(), n_kernels);
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t begin = 0; begin < upper.size(); begin += row_width)
    fill(transform, medium, spacing, edges, std::span(upper).subspan(begin, std::min(row_width, upper.size() - begin)));
}

std::size_t GridKernel::place(const Offset &o) const
{
  const int n = 2 * largest_offset + 1;
  const int k = ((o[0] + largest_offset) * n + o[1] + largest_offset) * n + o[2] + largest_offset;
  return static_cast<std::size_t>(k);
}

void GridKernel::fill(const GridTransform &transform, const IsotropicMedium &medium, const Vec3 &spacing,
                      const Vec3 &edges, const std::span<const Offset> eight)
{
  const auto n = static_cast<int>(transform.n()), period = static_cast<int>(transform.period());
  const std::size_t volume = transform.period() * transform.period() * transform.period();
  const double factor = medium.mu / (8 * std::numbers::pi) / static_cast<double>(volume);
  std::vector<RowBuffer> tables(n_kernels, RowBuffer(volume));
  for (int k = 0; k < static_cast<int>(volume); ++k)
  {
    // Differences of points, target - source, modulo the period.
    const auto difference = [&](int i) { return i < n ? i : i - period; };
    const Vec3 d(difference(k / (period * period)), difference(k / period % period), difference(k % period));
    for (std::size_t lane = 0; lane < eight.size(); ++lane)
    {
      const Vec3 between = edges.cwiseProduct(Vec3(eight[lane][0], eight[lane][1], eight[lane][2]));
      const auto D = third_derivatives(spacing.cwiseProduct(d) - between, medium.a);
      for (std::size_t q = 0; q < n_kernels; ++q)
        tables[q](static_cast<std::size_t>(k), lane) = factor * D[q];
    }
  }
  RowBuffer spectrum;
  for (std::size_t q = 0; q < n_kernels; ++q)
  {
    transform.forward_of_period(tables[q].rows(), spectrum);
    for (std::size_t lane = 0; lane < eight.size(); ++lane)
    {
      values.set(number(eight[lane]), q, spectrum, lane);
      values.set(number(opposite(eight[lane])), q, spectrum, lane, true);
    }
  }
}

DDFEM_FMM_EVERY_PROCESSOR
void convolve(const double nu, const std::span<const GridLink> links, const std::span<const std::uint32_t> first,
              const Row *const kernels, const Row *const sources, Row *const targets)
{
  const double two_m = 2 / (1 - nu);
  for (std::size_t t = 0; t + 1 < first.size(); ++t)
  {
    ComplexRow stress[n_stresses] = {};
    for (std::uint32_t l = first[t]; l < first[t + 1]; ++l)
    {
      const auto *const D = reinterpret_cast<const ComplexRow *>(kernels + 2 * n_kernels * links[l].kernel);
      const auto *const A = reinterpret_cast<const ComplexRow *>(sources + 2 * n_densities * links[l].source);
      add_stress(two_m, D, A, stress);
    }
    for (std::size_t c = 0; c < n_stresses; ++c)
    {
      targets[2 * (n_stresses * t + c)] = stress[c].re;
      targets[2 * (n_stresses * t + c) + 1] = stress[c].im;
    }
  }
}
} // namespace ddfem::fmm
