#include "dd/mobility/glide_constraints.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ddfem
{
namespace
{
/// Directions closer than half a degree count as parallel: planes and lines of one crystal are never that close.
constexpr double parallel_sine = 1e-2;

/// Takes @p direction out of the directions that are left.
void forbid(Mat3 &left, const Vec3 &direction)
{
  const Vec3 rest = left * direction;
  if (rest.norm() > parallel_sine)
    left -= rest * rest.transpose() / rest.squaredNorm();
}
} // namespace

std::array<Vec3, 2> directions_across(const Vec3 &line)
{
  const Vec3 across = line.unitOrthogonal();
  return {across, line.cross(across)};
}

ArmConstraint arm_constraint(const Network &network, const SegmentIndex s)
{
  return {network.normal(s), network.direction(s).normalized()};
}

Mat3 free_directions(std::span<const ArmConstraint> arms)
{
  if (std::all_of(arms.begin(), arms.end(), [](const ArmConstraint &a) { return a.is_sessile(); }))
    return Mat3::Zero();
  // Nearly every node has two arms on one plane.
  if (arms.size() == 2 && arms[0].normal == arms[1].normal && !arms[0].normal.isZero(0))
    return Mat3::Identity() - arms[0].normal * arms[0].normal.transpose();
  Mat3 left = Mat3::Identity();
  // Glide planes first: their normals are exact, the direction of a line is rounded like the positions of its ends.
  for (const ArmConstraint &a : arms)
    if (!a.normal.isZero(0))
      forbid(left, a.normal);
  for (const ArmConstraint &a : arms)
    if (a.is_sessile())
      for (const Vec3 &across : directions_across(a.line))
        forbid(left, across);
  return left.trace() > 0.5 ? left : Mat3(Mat3::Zero());
}

Mat3 free_directions(const Network &network, const NodeIndex i)
{
  std::vector<ArmConstraint> arms;
  for (const SegmentIndex s : network.connected_segments(i))
    arms.push_back(arm_constraint(network, s));
  return free_directions(arms);
}

Mat3 directions_on_face(const Mat3 &directions, const Vec3 &outward)
{
  // What the glide planes leave of the face's normal is forbidden as well.
  const Vec3 normal = directions * outward;
  if (normal.norm() < parallel_sine)
    return directions;
  return directions - normal * normal.transpose() / normal.squaredNorm();
}

Mat3 glide_projector(const Network &network, std::span<const SegmentIndex> arms)
{
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
  return directions_on_face(in_planes, shape->outward_normal(network.position(i)));
}

Vec3 only_direction(const Mat3 &projector)
{
  if (std::abs(projector.trace() - 1) > 0.5)
    return Vec3::Zero();
  Eigen::Index column = 0;
  projector.colwise().squaredNorm().maxCoeff(&column);
  return projector.col(column).normalized();
}
} // namespace ddfem
