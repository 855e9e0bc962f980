// What all integrators of the nodal positions share: the equation of motion, the control of the step, and its outcome.
#pragma once

#include "dd/network/network.h"
#include "dd/topology/motion_part.h"

#include <functional>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace ddfem
{
class SplitForces;

/// Nodal velocities (nm/ns, by NodeIndex::value) for the present positions of the network, at a time (ns) since the start of the step.
/// Made of any function of a network and the time, or of a network alone.
class VelocityFunction
{
public:
  VelocityFunction() = default; ///< not to be called
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

/// dx/dt = v(x, t) of a network.
struct EquationOfMotion
{
  VelocityFunction velocity;
  /// Upper bound of the spectral radius of d(velocity)/d(position) by node, 1/ns, by NodeIndex::value. One entry: the same for all nodes.
  std::vector<double> stiffness;
  /// The same forces in parts, for subcycling; null for integrators that need the sum only.
  const SplitForces *forces = nullptr;

  double largest_stiffness() const;
};

struct IntegratorSettings
{
  double error_tolerance = 0.1;  ///< estimated local error of a position, nm; relative_tolerance adds to it
  double max_displacement = 5.0; ///< of any node in one step, nm
  double max_step = 1e9;         ///< ns
  double initial_step = 1e-3;    ///< ns
  unsigned max_stages = 30;      ///< of the stabilised method
  /// Part of the shortest arm of a node that its position may err by besides error_tolerance.
  double relative_tolerance = 0.0;
  /// Of a node from the straight way in each of the parts into which its motion is divided for collisions, nm. Methods without shorter steps within the
  /// step do not ask.
  double max_deviation = std::numeric_limits<double>::infinity();
};

/// Outcome of one step: the network itself is left where it was, so that topology can move it.
struct IntegratorStep
{
  double dt = 0.0;    ///< ns
  double error = 0.0; ///< largest of any node, nm; 0 for methods without an estimate
  /// Evaluations of the velocity in the accepted try, and in all of them; tries that were given up.
  unsigned stages = 0, evaluations = 0, rejected = 0;
  std::vector<Vec3> displacement; ///< nm, by NodeIndex::value
  double max_speed = 0.0;         ///< at the start of the step, nm/ns
  /// Subcycling: evaluations of the near forces, in those of the whole network; nodes integrated by shorter steps than the others.
  double near_evaluations = 0;
  std::size_t refined_nodes = 0;
  /// The displacement in parts, one after the other, each of which is nearly straight; empty if the whole is.
  std::vector<MotionPart> parts;
};

/// Advances a network in steps that it chooses. All methods share one control of the step: a try is accepted if the estimated
/// error of every node is within error_tolerance + relative_tolerance x (its shortest arm) and no node has moved farther than
/// max_displacement (by a tenth at most); otherwise it is repeated from the same start with a shorter step. A rejected try leaves no trace: the
/// outcome, the network and the next step suggested are bit for bit those of a step that had been tried with the accepted size at once.
class Integrator
{
public:
  explicit Integrator(const IntegratorSettings &integrator_settings)
      : settings(integrator_settings), next_step(integrator_settings.initial_step)
  {
  }
  virtual ~Integrator() = default;
  Integrator(const Integrator &) = delete;
  Integrator &operator=(const Integrator &) = delete;

  /// Advances by at most @p dt_limit ns: by exactly dt_limit, or by half of it at most, so that no vanishing rest is left for
  /// another step. Throws std::runtime_error if a velocity is not finite or the step shrinks below the smaller of
  /// 1e-12 of max_step and 1e-9 ns.
  IntegratorStep advance(Network &network, const EquationOfMotion &motion, double dt_limit);
  /// The same with one bound of the spectral radius for all nodes.
  IntegratorStep advance(Network &network, const VelocityFunction &velocity, double stiffness, double dt_limit);

  double suggested_step() const { return next_step; }
  void set_suggested_step(double dt) { next_step = dt; }

protected:
  using Field = std::vector<Vec3>;
  /// Where a step begins.
  struct Start
  {
    Network &network; ///< to be moved at will
    const EquationOfMotion &motion;
    Field positions, velocity;     ///< nm, nm/ns, by NodeIndex::value
    std::vector<double> tolerance; ///< nm, likewise
  };
  struct Try
  {
    Field displacement, error;     ///< nm, by NodeIndex::value; error empty: not estimated
    std::vector<MotionPart> parts; ///< see IntegratorStep
    unsigned order = 1;            ///< the error falls with the step to this power
    bool failed = false;           ///< cannot be accepted whatever the error says
  };

  /// Called once at the beginning of every step, with the network in place.
  virtual void begin_step(const Start &) {}
  /// One step of size @p h (ns). May leave the network anywhere. Counts its evaluations in @p step.
  virtual Try attempt(const Start &start, double h, IntegratorStep &step) = 0;
  /// Largest step that the method should try, ns.
  virtual double largest_step(const EquationOfMotion &motion) const = 0;

  /// Velocities with the nodes displaced from the start, @p time (ns) after it; throws if one is not finite.
  static Field velocity_at(const Start &start, const Field &displacement, double time, IntegratorStep &step);

  const IntegratorSettings settings;

private:
  double size_of_try(const Start &start, double max_speed, double dt_limit) const;
  /// Whether it is accepted; sets the size of the next try or step.
  bool judge(const Start &start, const Try &attempted, double h, IntegratorStep &step);

  double next_step;
};
} // namespace ddfem
