#include "dd/integrators/brownian_chebyshev.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace ddfem
{
namespace
{
using Field = std::vector<Vec3>;

constexpr unsigned most_stages = 3;
/// Largest z/s^2.
constexpr double largest_u = 0.4;
/// Root mean square of a component of the thermal displacement in a step, in parts of the largest displacement.
constexpr double thermal_part = 0.2;

/// A network that is moved to and fro about where it was at the start.
class Moved
{
public:
  explicit Moved(Network &moved_network) : network(moved_network), start(network.node_capacity(), Vec3::Zero())
  {
    for (const NodeIndex i : network.nodes())
      start[i.value] = network.position(i);
  }
  Moved(const Moved &) = delete;
  Moved &operator=(const Moved &) = delete;
  ~Moved() { place(Field(start.size(), Vec3::Zero()), 0); }

  /// The network with its nodes displaced by @p factor times @p displacement.
  const Network &place(const Field &displacement, const double factor)
  {
    for (const NodeIndex i : network.nodes())
      network.set_position(i, start[i.value] + factor * displacement[i.value]);
    return network;
  }

private:
  Network &network;
  Field start;
};

Field velocity_of(const BrownianMotion &motion, const Network &network, const double time, IntegratorStep &step)
{
  Field velocity = motion.velocity(network, time);
  ++step.evaluations;
  for (const NodeIndex i : network.nodes())
    if (!velocity[i.value].allFinite())
    {
      std::ostringstream message;
      message << "the velocity of node " << network.id(i) << " at (" << network.position(i).transpose()
              << ") nm is not finite";
      throw std::runtime_error(message.str());
    }
  return velocity;
}

/// Displacement by the heat bath alone, with the drift that belongs to a mobility that depends on the positions.
Field thermal_displacement(Moved &moved, const Network &network, const BrownianMotion &motion, const double h)
{
  const Field force = motion.thermal_force(network, h);
  const Field at_start = motion.mobility(network, force);
  Field q = motion.mobility(moved.place(at_start, 0.5 * h), force);
  for (Vec3 &d : q)
    d *= h;
  return q;
}
} // namespace

IntegratorStep BrownianChebyshev::advance(Network &network, const BrownianMotion &motion, const double stiffness,
                                          const double dt_limit) const
{
  IntegratorStep step;
  Moved moved(network);
  for (const Vec3 &v : velocity_of(motion, network, 0, step))
    step.max_speed = std::max(step.max_speed, v.norm());
  double h = std::min(settings.max_step, dt_limit);
  if (stiffness > 0)
    h = std::min(h, largest_u * most_stages * most_stages / stiffness);
  if (step.max_speed > 0)
    h = std::min(h, settings.max_displacement / step.max_speed);
  if (motion.diffusivity > 0)
    h = std::min(h, std::pow(thermal_part * settings.max_displacement, 2) / (2 * motion.diffusivity));
  const auto s = static_cast<unsigned>(
      std::clamp(std::ceil(std::sqrt(h * stiffness / largest_u) - 1e-9), 1.0, double(most_stages)));

  const Field q = thermal_displacement(moved, network, motion, h);
  const std::size_t n = q.size();
  Field d(n, Vec3::Zero()), before(n, Vec3::Zero());
  for (unsigned k = 1; k <= s; ++k)
  {
    const double time = h * (k - 1) * (k - 1) / (s * s); // of the stage before, as for dt/dt = 1
    const Field velocity = k == 1 ? velocity_of(motion, moved.place(q, 0.25 / s), 0, step)
                                  : velocity_of(motion, moved.place(d, 1), time, step);
    for (std::size_t i = 0; i < n; ++i)
    {
      const Vec3 change = (k == 1 ? 1.0 : 2.0) * h / (s * s) * velocity[i];
      Vec3 next = change + (k == 1 ? Vec3(q[i] / s) : Vec3(2 * d[i] - before[i]));
      before[i] = d[i];
      d[i].swap(next);
    }
  }
  velocity_of(motion, moved.place(d, 1), h, step);
  step.dt = h;
  step.stages = s;
  step.displacement = std::move(d);
  return step;
}
} // namespace ddfem
