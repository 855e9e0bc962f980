#include "dd/fmm/expansion_loops.h"

#include <algorithm>
#include <cmath>

namespace ddfem::fmm
{
int n_points_along(const int order, const double tolerance, const double longest)
{
  const int exact = order / 2 + 1;
  if (longest >= 1.0)
    return exact;
  const double n = std::log(tolerance) / (2 * std::log(std::max(longest, 1e-6)));
  return std::clamp(static_cast<int>(std::ceil(n)), 1, exact);
}

DDFEM_FMM_EVERY_PROCESSOR
void add_weighted(const std::size_t n, const double weight, const Row *values, Row *sum)
{
  for (std::size_t k = 0; k < n; ++k)
    sum[k] += weight * values[k];
}

DDFEM_FMM_EVERY_PROCESSOR
void add_outer_products(const std::size_t n, const Row *source_moments, const Row *strength, const Row *q_strength,
                        Row *fields, double *q)
{
  for (std::size_t k = 0; k < n; ++k)
  {
    const Row moment = source_moments[k], of_q = moment * *q_strength;
    Row sum = fields[k];
    double q_sum = 0;
    for (std::size_t i = 0; i < row_width; ++i)
    {
      sum += moment[i] * strength[i];
      q_sum += of_q[i];
    }
    fields[k] = sum;
    q[k] += q_sum;
  }
}

DDFEM_FMM_EVERY_PROCESSOR
void add_outer_products(const std::size_t n, const Row *source_moments, const Row *strength, Row *fields)
{
  for (std::size_t k = 0; k < n; ++k)
  {
    const Row moment = source_moments[k];
    Row sum = fields[k];
    for (std::size_t i = 0; i < row_width; ++i)
      sum += moment[i] * strength[i];
    fields[k] = sum;
  }
}

namespace
{
DDFEM_FMM_EVERY_PROCESSOR
void add_terms(const GradientTerm *terms, const std::size_t n, const Row *from, Row *to)
{
  for (std::size_t k = 0; k < n; ++k)
    to[terms[k].to] += terms[k].factor * from[terms[k].from];
}
} // namespace

RowBuffer derivative(const std::vector<GradientTerm> &terms, const RowBuffer &expansion)
{
  RowBuffer result(expansion.size());
  add_terms(terms.data(), terms.size(), expansion.rows(), result.rows());
  return result;
}

const std::array<std::vector<GradientTerm>, 3> &known_gradient_terms(const int order)
{
  static const auto all = []
  {
    std::vector<std::array<std::vector<GradientTerm>, 3>> terms;
    for (int p = 0; p <= max_order; ++p)
      terms.push_back(gradient_terms(p));
    return terms;
  }();
  return all[static_cast<std::size_t>(order)];
}

namespace
{
template <class Rows>
DDFEM_FMM_INLINE void contract_rows(const std::size_t n, const typename Rows::Row *harmonics,
                                    const typename Rows::Scalar *coefficients, const typename Rows::Row *y,
                                    typename Rows::Row *result)
{
  typename Rows::Row sum[24];
  for (std::size_t part = 0; part < 3; ++part)
  {
    typename Rows::Row s[row_width] = {};
    for (std::size_t k = 0; k < n; ++k)
    {
      const typename Rows::Row h = harmonics[k];
      const typename Rows::Scalar *const c = coefficients + (3 * k + part) * row_width;
      for (std::size_t i = 0; i < row_width; ++i)
        s[i] += c[i] * h;
    }
    for (std::size_t i = 0; i < row_width; ++i)
      sum[part * row_width + i] = s[i];
  }
  for (std::size_t c = 0; c < 6; ++c)
    result[c] = sum[c] + y[0] * sum[6 + c] + y[1] * sum[12 + c] + y[2] * sum[18 + c];
}
} // namespace

DDFEM_FMM_EVERY_PROCESSOR
void contract_harmonics(const std::size_t n, const Row *harmonics, const double *coefficients, const Row *y,
                        Row *result)
{
  contract_rows<DoubleRows>(n, harmonics, coefficients, y, result);
}

DDFEM_FMM_EVERY_PROCESSOR
void contract_harmonics(const std::size_t n, const WideSingleRows::Row *harmonics, const float *coefficients,
                        const WideSingleRows::Row *y, WideSingleRows::Row *result)
{
  contract_rows<WideSingleRows>(n, harmonics, coefficients, y, result);
}
} // namespace ddfem::fmm
