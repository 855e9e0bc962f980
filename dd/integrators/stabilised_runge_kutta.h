// Explicit Runge-Kutta-Chebyshev integration of the nodal positions.
#pragma once

#include "dd/network/network.h"

#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

namespace ddfem
{
/// Nodal velocities (nm/ns, by NodeIndex::value) for the present positions of the network, at a time (ns) since the start of the step.
/// Made of any function of a network and the time, or of a network alone.
class VelocityFunction
{
public:
  template <class F> VelocityFunction(F f)
  {
    if constexpr (std::is_invocable_v<F, const Network &, double>)
      function = std::move(f);
    else
      function = [f = std::move(f)](const Network &network, double) { return f(network); };
  }

  std::vector<Vec3> operator()(const Network &network, double time) const { return function(network, time); }

private:
  std::function<std::vector<Vec3>(const Network &, double)> function;
};

struct IntegratorSettings
{
  double error_tolerance = 0.1;  ///< estimated local error of a position, nm
  double max_displacement = 5.0; ///< of any node in one step, nm
  double max_step = 1e9;         ///< ns
  double initial_step = 1e-3;    ///< ns
  unsigned max_stages = 30;
};

/// Outcome of one step: the network itself is left where it was, so that topology can move it.
struct IntegratorStep
{
  double dt = 0.0;    ///< ns
  double error = 0.0; ///< nm
  unsigned stages = 0, evaluations = 0, rejected = 0;
  std::vector<Vec3> displacement; ///< nm, by NodeIndex::value
  double max_speed = 0.0;         ///< at the start of the step, nm/ns
};

/// Second-order Runge-Kutta-Chebyshev method with error control (Sommeijer, Shampine, Verwer, J. Comput. Appl. Math. 88
/// (1998) 315, eqs. 2.2-2.9 and 3.1). The line tension makes the equations of motion stiff but symmetric: the stable
/// step of forward Euler falls with L_min^2, whereas s stages of this explicit method make it about 0.33 s^2 times longer.
class StabilisedRungeKutta
{
public:
  explicit StabilisedRungeKutta(const IntegratorSettings &integrator_settings)
      : settings(integrator_settings), next_step(integrator_settings.initial_step)
  {
  }

  /// Advances by at most @p dt_limit ns. @p stiffness: upper bound of the spectral radius of d(velocity)/d(position), 1/ns.
  /// Throws std::runtime_error if a velocity is not finite or the step shrinks below the smaller of
  /// 1e-12 of max_step and 1e-9 ns.
  IntegratorStep advance(Network &network, const VelocityFunction &velocity, double stiffness, double dt_limit);

  double suggested_step() const { return next_step; }
  void set_suggested_step(double dt) { next_step = dt; }

private:
  IntegratorSettings settings;
  double next_step;
};

/// Spectral radius bound of the line-tension operator on the network: max over nodes of 2 K / D with the stiffness
/// K = T sum 1/L_arm and the drag D of the node; @p tension T in MPa nm^2, @p drag in MPa ns nm by NodeIndex::value.
double line_tension_stiffness(const Network &network, double tension, const std::vector<double> &drag);
} // namespace ddfem
