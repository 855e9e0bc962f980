// Explicit Runge-Kutta-Chebyshev integration of the nodal positions.
#pragma once

#include "dd/integrators/integrator.h"

namespace ddfem
{
/// Second-order Runge-Kutta-Chebyshev method with error control (Sommeijer, Shampine, Verwer, J. Comput. Appl. Math. 88
/// (1998) 315, eqs. 2.2-2.9 and 3.1). The line tension makes the equations of motion stiff but symmetric: the stable
/// step of forward Euler falls with L_min^2, whereas s stages of this explicit method make it about 0.33 s^2 times longer.
class StabilisedRungeKutta : public Integrator
{
public:
  using Integrator::Integrator;

private:
  Try attempt(const Start &start, double h, IntegratorStep &step) override;
  double largest_step(const EquationOfMotion &motion) const override;
};
} // namespace ddfem
