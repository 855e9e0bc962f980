// Embedded Runge-Kutta pairs of order 3 and 5.
#pragma once

#include "dd/integrators/integrator.h"

namespace ddfem
{
/// A pair of methods with common stages, whose difference estimates the error of the one of lower order; the step is that of the higher.
/// Both pairs have the velocity at the end of the step as their last stage.
enum class EmbeddedPair
{
  bogacki_shampine, ///< order 3(2), 3 evaluations: Bogacki & Shampine, Appl. Math. Lett. 2 (1989) 321
  dormand_prince,   ///< order 5(4), 6 evaluations: Dormand & Prince, J. Comput. Appl. Math. 6 (1980) 19
};

class EmbeddedRungeKutta : public Integrator
{
public:
  EmbeddedRungeKutta(const IntegratorSettings &integrator_settings, EmbeddedPair embedded_pair)
      : Integrator(integrator_settings), pair(embedded_pair)
  {
  }

private:
  Try attempt(const Start &start, double h, IntegratorStep &step) override;
  double largest_step(const EquationOfMotion &motion) const override;

  EmbeddedPair pair;
};
} // namespace ddfem
