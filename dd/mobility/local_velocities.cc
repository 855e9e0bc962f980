#include "dd/mobility/local_velocities.h"

#include "dd/mobility/damped_newton.h"

#include <stdexcept>

namespace ddfem
{
namespace
{
constexpr int most_iterations = 100;
constexpr double tolerance = 1e-10; ///< of the residual force against the force

/// Force that moves half of the arms at @p velocity, and its derivative.
Resistance resistance_of_arms(const MobilityLaw &law, std::span<const NodalArm> arms, const Vec3 &velocity,
                              const double sliding_drag)
{
  Resistance sum;
  for (const NodalArm &a : arms)
  {
    const Resistance across = law.resistance(a.line, velocity);
    const Mat3 along = sliding_drag * law.drag(a.line) * a.line.direction * a.line.direction.transpose();
    sum.force += 0.5 * a.length * (across.force + along * velocity);
    sum.slope += 0.5 * a.length * (across.slope + along);
  }
  return sum;
}

/// Solution of P A P x = P y in the range of the projector P.
Vec3 solve_in(const Mat3 &directions, const Mat3 &a, const Vec3 &y)
{
  const Mat3 rest = Mat3::Identity() - directions;
  const Mat3 full = directions * a * directions + a.trace() * rest;
  return directions * full.ldlt().solve(directions * y);
}
} // namespace

Vec3 local_velocity(const MobilityLaw &law, std::span<const NodalArm> arms, const Mat3 &directions, const Vec3 &force,
                    const double sliding_drag)
{
  Vec3 target = directions * force;
  if (!target.allFinite())
    return target;
  Vec3 velocity = Vec3::Zero();
  for (int k = 0; k < most_iterations; ++k)
  {
    const Resistance now = resistance_of_arms(law, arms, velocity, sliding_drag);
    const Vec3 residual = target - directions * now.force;
    if (residual.norm() <= tolerance * target.norm())
      return velocity;
    Vec3 step = solve_in(directions, now.slope, residual);
    if (law.is_linear())
      return step;
    const auto pull = [&](const double s)
    { return step.dot(target - resistance_of_arms(law, arms, velocity + s * step, sliding_drag).force); };
    velocity += damped_step(step.dot(residual), pull) * step;
  }
  throw std::runtime_error(
      "no velocity of a node balances its force: the mobility law does not grow with the velocity");
}

Mat3 allowed_directions(const Network &network, const NodeIndex i, const MobilityLaw &law, const GrainShape *shape)
{
  if (network.constraint(i) == NodeConstraint::pinned)
    return Mat3::Zero();
  std::vector<ArmConstraint> constraints;
  constraints.reserve(network.degree(i));
  for (const SegmentIndex s : network.connected_segments(i))
    constraints.push_back(law.constraint(line_state(network, s)));
  Mat3 directions = free_directions(constraints);
  if (network.constraint(i) != NodeConstraint::surface || !shape)
    return directions;
  return directions_on_face(directions, shape->outward_normal(network.position(i)));
}

Mat3 directions_of_motion(const Network &network, const NodeIndex i, const MobilityLaw &law, const GrainShape *shape)
{
  Mat3 allowed = allowed_directions(network, i, law, shape);
  const auto arms = network.connected_segments(i);
  if (arms.size() != 2 || network.is_physical(i))
    return allowed;
  const Vec3 &x = network.position(i);
  const auto to_neighbour = [&](const SegmentIndex s)
  { return network.minimum_image(network.position(network.other_end(s, i)) - x); };
  const Vec3 chord = allowed * (to_neighbour(arms[0]) - to_neighbour(arms[1]));
  const double squared = chord.squaredNorm();
  return squared > 0 ? Mat3(allowed - chord * chord.transpose() / squared) : allowed;
}

std::vector<NodalArm> arms_of(const Network &network, const NodeIndex i)
{
  std::vector<NodalArm> arms;
  arms.reserve(network.degree(i));
  for (const SegmentIndex s : network.connected_segments(i))
    arms.push_back({line_state(network, s), network.length(s)});
  return arms;
}

double nodal_drag(const Network &network, const NodeIndex i, const MobilityLaw &law)
{
  double drag = 0;
  for (const NodalArm &a : arms_of(network, i))
    drag += 0.5 * a.length * law.drag(a.line);
  return drag;
}

Vec3 glide_velocity(const Network &network, const NodeIndex i, const Vec3 &force, const MobilityLaw &law,
                    const GrainShape *shape, const double sliding_drag)
{
  if (network.degree(i) == 0)
    return Vec3::Zero();
  return local_velocity(law, arms_of(network, i), directions_of_motion(network, i, law, shape), force, sliding_drag);
}

std::vector<Vec3> glide_velocities(const Network &network, const std::vector<Vec3> &force, const MobilityLaw &law,
                                   const GrainShape *shape, const double sliding_drag)
{
  std::vector<Vec3> velocity(network.node_capacity(), Vec3::Zero());
  network.for_each_node([&](const NodeIndex i)
                        { velocity[i.value] = glide_velocity(network, i, force[i.value], law, shape, sliding_drag); });
  return velocity;
}
} // namespace ddfem
