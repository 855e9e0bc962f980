// Integrators by name.
#pragma once

#include "dd/integrators/integrator.h"

#include <memory>

namespace ddfem
{
enum class IntegratorKind : std::uint8_t
{
  forward_euler,
  trapezoid,
  bogacki_shampine,
  dormand_prince,
  stabilised, ///< Runge-Kutta-Chebyshev
  subcycling,
};
inline constexpr std::size_t n_integrators = 6;
/// As in the input.
const char *name_of(IntegratorKind kind);

std::unique_ptr<Integrator> make_integrator(IntegratorKind kind, const IntegratorSettings &settings);
} // namespace ddfem
