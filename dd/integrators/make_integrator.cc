#include "dd/integrators/make_integrator.h"

#include "dd/integrators/embedded_runge_kutta.h"
#include "dd/integrators/forward_euler.h"
#include "dd/integrators/stabilised_runge_kutta.h"
#include "dd/integrators/subcycling.h"
#include "dd/integrators/trapezoid.h"

#include <array>
#include <stdexcept>

namespace ddfem
{
const char *name_of(const IntegratorKind kind)
{
  constexpr std::array<const char *, n_integrators> names{"forward Euler",  "trapezoid",  "Bogacki-Shampine",
                                                          "Dormand-Prince", "stabilised", "subcycling"};
  return names[static_cast<std::size_t>(kind)];
}

std::unique_ptr<Integrator> make_integrator(const IntegratorKind kind, const IntegratorSettings &settings)
{
  switch (kind)
  {
    case IntegratorKind::forward_euler: return std::make_unique<ForwardEuler>(settings);
    case IntegratorKind::trapezoid: return std::make_unique<Trapezoid>(settings);
    case IntegratorKind::bogacki_shampine:
      return std::make_unique<EmbeddedRungeKutta>(settings, EmbeddedPair::bogacki_shampine);
    case IntegratorKind::dormand_prince:
      return std::make_unique<EmbeddedRungeKutta>(settings, EmbeddedPair::dormand_prince);
    case IntegratorKind::stabilised: return std::make_unique<StabilisedRungeKutta>(settings);
    case IntegratorKind::subcycling: return std::make_unique<Subcycling>(settings);
  }
  throw std::invalid_argument("unknown integrator");
}
} // namespace ddfem
