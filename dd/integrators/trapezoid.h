// The trapezoidal rule with corrector iterations, as published codes of dislocation dynamics have it.
#pragma once

#include "dd/integrators/integrator.h"

namespace ddfem
{
/// x_1 = x_0 + h/2 (v(x_0) + v(x_1)), second order: forward Euler predicts x_1, and the right-hand side with the last x_1 corrects it, twice at
/// most (Arsenlis et al., MSMSE 15 (2007) 553, section 2.4; Sills & Cai, MSMSE 22 (2014) 025003). One correction is Heun's method. The
/// step is accepted once a correction changes no position by more than the tolerance; this change is the estimated error. The corrections
/// converge for h |lambda| < 2 only: the step is limited by the stiffest pair of neighbouring nodes.
class Trapezoid : public Integrator
{
public:
  using Integrator::Integrator;

private:
  Try attempt(const Start &start, double h, IntegratorStep &step) override;
  double largest_step(const EquationOfMotion &motion) const override;
};
} // namespace ddfem
