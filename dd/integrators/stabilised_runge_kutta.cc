#include "dd/integrators/stabilised_runge_kutta.h"

#include "dd/integrators/chebyshev_steps.h"

#include <utility>

namespace ddfem
{
double StabilisedRungeKutta::largest_step(const EquationOfMotion &motion) const
{
  return ChebyshevSteps::stability_bound(settings.max_stages) / motion.largest_stiffness();
}

/// The recursion is that of the displacements from the start: exactly zero for nodes that do not move, such as one that is held on the
/// surface of the grain.
Integrator::Try StabilisedRungeKutta::attempt(const Start &start, const double h, IntegratorStep &step)
{
  const ChebyshevSteps method(ChebyshevSteps::stages_for(h * start.motion.largest_stiffness()));
  const std::size_t n = start.positions.size();
  const Field &f0 = start.velocity;
  Field d_old(n, Vec3::Zero()), d(n), d_new(n);
  for (std::size_t i = 0; i < n; ++i)
    d[i] = method[1].mu_tilde * h * f0[i];
  for (unsigned j = 2; j <= method.n_stages(); ++j)
  {
    const ChebyshevSteps::Coefficients &c = method[j];
    const Field f = velocity_at(start, d, method.time(j - 1) * h, step);
    for (std::size_t i = 0; i < n; ++i)
      d_new[i] = c.mu * d[i] + c.nu * d_old[i] + c.mu_tilde * h * f[i] + c.gamma_tilde * h * f0[i];
    std::swap(d_old, d);
    std::swap(d, d_new);
  }
  const Field f_end = velocity_at(start, d, h, step);
  Field error(n, Vec3::Zero());
  for (const NodeIndex i : start.network.nodes())
    error[i.value] = ChebyshevSteps::error<Vec3>(d[i.value], h, f0[i.value], f_end[i.value]);
  return {std::move(d), std::move(error), {}, 3};
}
} // namespace ddfem
