#include "dd/integrators/trapezoid.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace ddfem
{
double Trapezoid::largest_step(const EquationOfMotion &) const
{
  return std::numeric_limits<double>::infinity(); // the corrections diverge, and are rejected
}

Integrator::Try Trapezoid::attempt(const Start &start, const double h, IntegratorStep &step)
{
  constexpr unsigned most_corrections = 2;
  const std::size_t n = start.positions.size();
  Try result{Field(n), Field(n, Vec3::Zero()), {}, 1};
  for (std::size_t i = 0; i < n; ++i)
    result.displacement[i] = h * start.velocity[i];
  for (unsigned k = 0; k < most_corrections; ++k)
  {
    const Field v = velocity_at(start, result.displacement, h, step);
    bool converged = true;
    for (const NodeIndex i : start.network.nodes())
    {
      const Vec3 corrected = 0.5 * h * (start.velocity[i.value] + v[i.value]);
      result.error[i.value] = corrected - result.displacement[i.value];
      result.displacement[i.value] = corrected;
      converged = converged && result.error[i.value].norm() <= start.tolerance[i.value];
    }
    ++result.order; // each correction gains one power of the step
    if (converged)
      break;
  }
  return result;
}
} // namespace ddfem
