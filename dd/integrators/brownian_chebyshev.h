// Stabilised integration of Brownian motion.
#pragma once

#include "dd/integrators/integrator.h"

#include <functional>
#include <vector>

namespace ddfem
{
/// Overdamped motion in a heat bath, dx = M f dt + kT div M dt + sqrt(2 kT M) dW (Ito), whose stationary density is exp(-E/kT) for
/// any mobility M(x) (Ermak & McCammon, J. Chem. Phys. 69 (1978) 1352, eq. 2).
struct BrownianMotion
{
  VelocityFunction velocity; ///< M f, by the forces without the heat bath
  /// M R at the present positions for given nodal forces R (MPa nm^2, by NodeIndex::value), nm/ns.
  std::function<std::vector<Vec3>(const Network &, const std::vector<Vec3> &)> mobility;
  /// Random forces for a step of so many ns: covariance 2 kT M^-1/dt in the directions in which nodes move.
  std::function<std::vector<Vec3>(const Network &, double)> thermal_force;
  double diffusivity = 0.0; ///< largest kT/D of a node, nm^2/ns
};

/// Explicit Chebyshev method of first order with s <= 3 stages for Brownian motion: SK-ROCK without damping (Abdulle, Almuslimani &
/// Vilmart, SIAM/ASA J. Uncertain. Quantif. 6 (2018) 937, eq. 7) with the argument of the first stage moved by a quarter of its noise
/// instead of a half:
///
///   q = dt M(x + dt M(x) R/2) R,                       R: random forces, drawn at the start
///   K_1 = x + dt/s^2 v(x + q/(4s)) + q/s,   K_i = 2 K_i-1 - K_i-2 + 2 dt/s^2 v(K_i-1),   x' = K_s
///
/// A mode with rate lambda, z = lambda dt, u = z/s^2, x = 1 - u: x' = T_s(x) y + U_s-1(x)/s (1 - u/4) q. Because 1 - T_s^2 =
/// (1 - x^2) U_s-1^2 its stationary variance is kT/K times (1 - u/4)^2/(1 - u/2) = 1 + u^2/16 + ... for every s: equipartition
/// holds up to the stiffest modes (a half instead of the quarter would leave 1 - u/2). Steps keep u <= 0.4, error below
/// 1.3 % for the stiffest mode and (z/s^2)^2/16 for the others. More than three stages are not used: a mode with
/// T_s(x) = -1 (z about pi^2/2) would not feel the heat bath at all.
/// The midpoint in q yields the drift: <q> = dt^2/2 <(M R . grad) M R> = dt kT div M (Fixman, J. Chem. Phys. 69 (1978) 1527).
///
/// The step is chosen before the noise is drawn, from the state alone, and never rejected: a rejection would select among the
/// random numbers. So no noise has to be split between steps. The random forces may follow any dt: steps end where they must.
class BrownianChebyshev
{
public:
  explicit BrownianChebyshev(const IntegratorSettings &integrator_settings) : settings(integrator_settings) {}

  /// Advances by at most @p dt_limit ns. @p stiffness: upper bound of the spectral radius of d(velocity)/d(position), 1/ns. No
  /// node moves farther than max_displacement by its velocity at the start, and by noise no farther than a fifth of it in
  /// the root mean square of one component; error_tolerance and initial_step are not used. The first evaluation of the velocity
  /// is at the start, the last one at the end. Throws std::runtime_error if a velocity is not finite.
  IntegratorStep advance(Network &network, const BrownianMotion &motion, double stiffness, double dt_limit) const;

private:
  IntegratorSettings settings;
};
} // namespace ddfem
