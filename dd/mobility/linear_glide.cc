#include "dd/mobility/linear_glide.h"

#include "dd/mobility/glide_constraints.h"

namespace ddfem
{
Mat3 glide_projector(const Network &network, std::span<const SegmentIndex> arms)
{
  // Nearly every node has two arms on one plane.
  if (arms.size() == 2 && network.plane(arms[0]).is_valid() && network.plane(arms[0]) == network.plane(arms[1]))
  {
    const Vec3 n = network.normal(arms[0]);
    return Mat3::Identity() - n * n.transpose();
  }
  std::vector<ArmConstraint> constraints;
  constraints.reserve(arms.size());
  for (const SegmentIndex s : arms)
    constraints.push_back(arm_constraint(network, s));
  return free_directions(constraints);
}

Mat3 glide_projector(const Network &network, const NodeIndex i, const GrainShape *shape)
{
  if (network.constraint(i) == NodeConstraint::pinned)
    return Mat3::Zero();
  Mat3 in_planes = glide_projector(network, network.connected_segments(i));
  if (network.constraint(i) != NodeConstraint::surface || !shape)
    return in_planes;
  // What the glide planes leave of the face's normal is forbidden as well.
  const Vec3 normal = in_planes * shape->outward_normal(network.position(i));
  constexpr double parallel_sine = 1e-2;
  if (normal.norm() < parallel_sine)
    return in_planes;
  return in_planes - normal * normal.transpose() / normal.squaredNorm();
}

double drag_of_arms(const Network &network, std::span<const SegmentIndex> arms, const LinearGlide &law)
{
  double drag = 0;
  for (const SegmentIndex s : arms)
  {
    const Vec3 t = network.direction(s);
    const double length = t.norm();
    const double cosine = t.dot(network.burgers(s)) / (length * network.burgers(s).norm());
    drag += 0.5 * length * (law.drag_edge + (law.drag_screw - law.drag_edge) * cosine * cosine);
  }
  return drag;
}

double nodal_drag(const Network &network, const NodeIndex i, const LinearGlide &law)
{
  return drag_of_arms(network, network.connected_segments(i), law);
}

Vec3 across_line(const Network &network, const NodeIndex i, const Vec3 &velocity)
{
  const auto arms = network.connected_segments(i);
  if (arms.size() != 2 || network.is_physical(i))
    return velocity;
  const Vec3 &x = network.position(i);
  const auto to_neighbour = [&](const SegmentIndex s)
  { return network.minimum_image(network.position(network.other_end(s, i)) - x); };
  const Vec3 chord = to_neighbour(arms[0]) - to_neighbour(arms[1]);
  return velocity - chord * (chord.dot(velocity) / chord.squaredNorm());
}

Vec3 glide_velocity(const Network &network, const NodeIndex i, const Vec3 &force, const LinearGlide &law,
                    const GrainShape *shape)
{
  const double drag = nodal_drag(network, i, law);
  return drag > 0 ? across_line(network, i, glide_projector(network, i, shape) * force / drag) : Vec3(Vec3::Zero());
}

std::vector<Vec3> glide_velocities(const Network &network, const std::vector<Vec3> &force, const LinearGlide &law,
                                   const GrainShape *shape)
{
  std::vector<Vec3> velocity(network.node_capacity(), Vec3::Zero());
  network.for_each_node([&](const NodeIndex i)
                        { velocity[i.value] = glide_velocity(network, i, force[i.value], law, shape); });
  return velocity;
}
} // namespace ddfem
