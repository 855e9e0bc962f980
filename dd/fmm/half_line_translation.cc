#include "dd/fmm/half_line_translation.h"

#include "dd/fmm/row_products.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>

namespace ddfem::fmm
{
namespace
{
/// Numbers of sines (m > 0) and cosines (m >= 0), which the matrices take one after the other.
constexpr std::size_t n_sines(const int order)
{
  const auto n = static_cast<std::size_t>(order);
  return n * (n + 1) / 2;
}
constexpr std::size_t n_cosines(const int order)
{
  return n_harmonics(order) - n_sines(order);
}

/// The factors between real harmonics and I_lm: sqrt(2) (m > 0)/sqrt((l-m)! (l+m)!), at the positions of cosines.
std::vector<double> normalisation(const int order)
{
  std::vector<double> root_factorial{1.0}, factors;
  for (int n = 1; n <= 2 * order; ++n)
    root_factorial.push_back(root_factorial.back() * std::sqrt(static_cast<double>(n)));
  for (int l = 0; l <= order; ++l)
    for (int m = 0; m <= l; ++m)
    {
      const int minus = l - m, plus = l + m;
      factors.push_back((m > 0 ? std::sqrt(2.0) : 1.0) / (root_factorial[static_cast<std::size_t>(minus)] *
                                                          root_factorial[static_cast<std::size_t>(plus)]));
    }
  return factors;
}

/// sum over i = 0 ... n of (n + i)!/(2^i i!) weight(i) t^(m-i) sin^i: positive terms.
template <class Weight> double series(const int m, const int n, const double t, const double sine, Weight &&weight)
{
  double factor = 1, sum = 0;
  for (int k = 2; k <= n; ++k)
    factor *= k;
  for (int i = 0; i <= n; ++i)
  {
    sum += factor * weight(i) * std::pow(t, m - i) * std::pow(sine, i);
    factor *= 0.5 * (n + i + 1) / (i + 1);
  }
  return sum;
}
} // namespace

IrregularFunctions::IrregularFunctions(const int highest, const double rho, const double z)
    : n_degrees(highest + 4), values(static_cast<std::size_t>(n_degrees) * static_cast<std::size_t>(n_degrees), 0.0)
{
  // ((1/R) d/dR)^k = sum_i (-1)^i (k-1+i)!/(2^i i! (k-1-i)!) R^(-k-i) (d/dR)^(k-i), applied to Lambda, psi and chi as functions of
  // R and z: d/d(rho^2) is 1/(2R) d/dR at constant z, and (d_x + i d_y)^m f(rho^2) = (2 rho exp(i phi))^m f^(m).
  const double r = std::hypot(rho, z), t = rho / (r + z), sine = rho / r, logarithm = std::log(r + z);
  const double psi = z * logarithm - r;
  double diagonal = 1 / r; // I_mm
  for (int m = 0; m <= highest; ++m)
  {
    entry(m, m) = diagonal;
    diagonal *= (2.0 * m + 1) * rho / (r * r);
    // The recurrence of the Legendre functions; at n = m the factor of the last one is zero.
    for (int n = m; n < highest; ++n)
      entry(n + 1, m) = ((2.0 * n + 1) * z * entry(n, m) - (n > m ? (n * n - m * m) * entry(n - 1, m) : 0.0)) / (r * r);
  }
  entry(-1, 0) = -logarithm;
  entry(-2, 0) = psi;
  entry(-2, 1) = 0.5 * rho * (0.5 - z / (r + z) - logarithm);
  for (int m = 1; m - 1 <= highest; ++m)
    entry(m - 1, m) = std::pow(r, -m) * series(m, m - 1, t, sine, [](int) { return 1.0; });
  entry(-1, 1) = t;
  for (int m = 2; m - 2 <= highest; ++m)
    entry(m - 2, m) = std::pow(r, 1 - m) * series(m, m - 2, t, sine, [m](int i) { return m - 1.0 - i; });
  entry(-1, 2) = 0.5 * t * t;
  for (int m = 3; m - 3 <= highest; ++m)
    entry(m - 3, m) =
        0.5 * std::pow(r, 2 - m) * series(m, m - 3, t, sine, [m](int i) { return (m - 1.0 - i) * (m - 2.0 - i); });
}

double &IrregularFunctions::entry(const int n, const int m)
{
  const int position = m * n_degrees + n + 3;
  return values[static_cast<std::size_t>(position)];
}

double IrregularFunctions::operator()(const int n, const int m) const
{
  const int position = std::abs(m) * n_degrees + n + 3;
  const double value = values[static_cast<std::size_t>(position)];
  return m < 0 && m % 2 != 0 ? -value : value;
}

HalfLineMatrices::HalfLineMatrices(const int n_antiderivatives, const int source, const int target, const double rho,
                                   const double z)
    : source_order(source), target_order(target)
{
  const IrregularFunctions function(source + target, rho, z);
  const std::vector<double> factors = normalisation(std::max(source, target));
  const auto factor = [&](int l, int m) { return factors[n_sines(l) + static_cast<std::size_t>(m)]; };
  // The field of the real source is the real part of I (cosine) or of -i I (sine), whence the two terms.
  for (const bool is_cosine : {true, false})
    for (int j = 0; j <= target; ++j)
      for (int k = is_cosine ? 0 : 1; k <= j; ++k)
        for (int l = 0; l <= source; ++l)
          for (int m = is_cosine ? 0 : 1; m <= l; ++m)
          {
            const int n = l + j - n_antiderivatives;
            const double minus = function(n, m - k), plus = (k % 2 == 0 ? 1 : -1) * function(n, m + k);
            const double sign = (j - k + n_antiderivatives) % 2 == 0 ? 0.5 : -0.5;
            (is_cosine ? cosines : sines)
                .push_back(sign * factor(j, k) * factor(l, m) * (is_cosine ? minus + plus : minus - plus));
          }
}

std::shared_ptr<const HalfLineMatrices> half_line_matrices(const int n_antiderivatives, const int source_order,
                                                           const int target_order, const long rho_squared, const long z)
{
  static std::map<std::array<long, 5>, std::shared_ptr<const HalfLineMatrices>> known;
  static std::mutex access;
  const std::lock_guard lock(access);
  auto &entry = known[{n_antiderivatives, source_order, target_order, rho_squared, z}];
  if (!entry)
    entry =
        std::make_shared<const HalfLineMatrices>(n_antiderivatives, source_order, target_order,
                                                 std::sqrt(static_cast<double>(rho_squared)), static_cast<double>(z));
  return entry;
}

HalfLineTranslation::HalfLineTranslation(std::shared_ptr<const HalfLineMatrices> given, const Vec3 &vector)
    : matrices(std::move(given)), shift(vector)
{
  const double phi = std::atan2(vector[1], vector[0]);
  for (int m = 0; m <= std::max(source_order(), target_order()); ++m)
  {
    phase.push_back(std::cos(m * phi));
    phase.push_back(std::sin(m * phi));
  }
}

namespace
{
/// Cosines, then sines, as the matrices need them; @p sign 1 for the former.
template <class Visit> DDFEM_FMM_INLINE void for_each_of(const int order, const int sign, Visit visit)
{
  std::size_t k = 0;
  for (int l = 0; l <= order; ++l)
    for (int m = (1 - sign) / 2; m <= l; ++m)
      visit(k++, harmonic_index(l, sign * m));
}

DDFEM_FMM_EVERY_PROCESSOR
void translate(const HalfLineMatrices &matrices, const double *phase, const Row *source, Row *target)
{
  alignas(row_size) Row turned[n_harmonics(max_order)];
  alignas(row_size) Row in[n_cosines(max_order)];
  alignas(row_size) Row out[n_cosines(max_order)];
  alignas(row_size) Row result[n_harmonics(max_order)];
  turn_to_axis<DoubleRows>(matrices.source_order, phase, source, turned);
  const auto in_order = [](std::size_t k) { return k; };
  for (const int sign : {1, -1})
  {
    for_each_of(matrices.source_order, sign, [&](std::size_t k, std::size_t harmonic) { in[k] = turned[harmonic]; });
    const bool is_cosine = sign > 0;
    const auto size = [is_cosine](int order) { return is_cosine ? n_cosines(order) : n_sines(order); };
    multiply<DoubleRows>((is_cosine ? matrices.cosines : matrices.sines).data(), size(matrices.target_order),
                         size(matrices.source_order), in, in_order, out, in_order);
    for_each_of(matrices.target_order, sign, [&](std::size_t k, std::size_t harmonic) { result[harmonic] = out[k]; });
  }
  add_turned_back<DoubleRows>(matrices.target_order, phase, result, target);
}
} // namespace

void HalfLineTranslation::add(const Row *source, Row *target) const
{
  translate(*matrices, phase.data(), source, target);
}
} // namespace ddfem::fmm
