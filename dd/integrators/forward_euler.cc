#include "dd/integrators/forward_euler.h"

namespace ddfem
{
double ForwardEuler::largest_step(const EquationOfMotion &motion) const
{
  return 1 / motion.largest_stiffness();
}

Integrator::Try ForwardEuler::attempt(const Start &start, const double h, IntegratorStep &)
{
  Field displacement = start.velocity;
  for (Vec3 &d : displacement)
    d *= h;
  return {std::move(displacement), {}, {}, 1};
}
} // namespace ddfem
