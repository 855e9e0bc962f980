#include "dd/integrators/chebyshev_steps.h"

#include <algorithm>
#include <cmath>

namespace ddfem
{
namespace
{
constexpr double damping = 2.0 / 13.0;

/// Chebyshev polynomials T_j(w0) and their first two derivatives for j = 0..s.
struct Chebyshev
{
  std::vector<double> value, first, second;
  Chebyshev(const double w0, const unsigned s) : value(s + 1), first(s + 1), second(s + 1)
  {
    value[0] = 1;
    value[1] = w0;
    first[1] = 1;
    for (unsigned j = 2; j <= s; ++j)
    {
      value[j] = 2 * w0 * value[j - 1] - value[j - 2];
      first[j] = 2 * value[j - 1] + 2 * w0 * first[j - 1] - first[j - 2];
      second[j] = 4 * first[j - 1] + 2 * w0 * second[j - 1] - second[j - 2];
    }
  }
};
} // namespace

ChebyshevSteps::ChebyshevSteps(const unsigned s) : coefficients(s + 1), times(s + 1, 0.0)
{
  const double w0 = 1 + damping / (s * s);
  const Chebyshev t(w0, s);
  const double w1 = t.first[s] / t.second[s];
  const auto b_of = [&](const unsigned j)
  { return j == 1 ? 1 / w0 : t.second[std::max(j, 2U)] / (t.first[std::max(j, 2U)] * t.first[std::max(j, 2U)]); };
  coefficients[1] = {0, 0, b_of(1) * w1, 0};
  for (unsigned j = 2; j <= s; ++j)
  {
    const double mu_tilde = 2 * b_of(j) * w1 / b_of(j - 1);
    coefficients[j] = {2 * b_of(j) * w0 / b_of(j - 1), -b_of(j) / b_of(j - 2), mu_tilde,
                       -(1 - b_of(j - 1) * t.value[j - 1]) * mu_tilde};
    times[j] = w1 * t.second[j] / t.first[j];
  }
  times[1] = coefficients[1].mu_tilde;
  times[s] = 1;
}

double ChebyshevSteps::stability_bound(const unsigned s)
{
  return 2.0 / 3.0 * (s * s - 1.0) * (1 - 2.0 / 15.0 * damping);
}

unsigned ChebyshevSteps::stages_for(const double product)
{
  const double scale = 2.0 / 3.0 * (1 - 2.0 / 15.0 * damping);
  return std::max(2U, static_cast<unsigned>(std::ceil(std::sqrt(1 + product / scale))));
}
} // namespace ddfem
