// Forward Euler integration of the nodal positions: the reference.
#pragma once

#include "dd/integrators/integrator.h"

namespace ddfem
{
/// x_1 = x_0 + h v(x_0), first order, with one evaluation per step and without an estimate of its error: the step is limited by the
/// largest displacement of a node and by the stability of the line tension, h <= 1/stiffness, so that the zig-zag of neighbouring nodes, the stiffest
/// mode, decays without changing its sign.
class ForwardEuler : public Integrator
{
public:
  using Integrator::Integrator;

private:
  Try attempt(const Start &start, double h, IntegratorStep &step) override;
  double largest_step(const EquationOfMotion &motion) const override;
};
} // namespace ddfem
