#include "dd/forces/virtual_rays.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace ddfem
{
namespace
{
/// Rays that pass close to the grain make tractions that are costly to integrate.
constexpr double preferred_clearance = 0.2, least_clearance = 1e-3;

/// The directions to a grid of 5 x 5 points on each side of a cube.
std::vector<Vec3> make_directions()
{
  std::vector<Vec3> directions;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j)
      for (int k = -2; k <= 2; ++k)
        if (std::max({std::abs(i), std::abs(j), std::abs(k)}) == 2)
          directions.push_back(Vec3(i, j, k).normalized());
  return directions;
}

/// The free direction nearest to @p normal that keeps a clearance, or at least is free.
std::optional<Vec3> nearest_free_direction(const GrainShape &shape, const Vec3 &x, const Vec3 &normal)
{
  static const std::vector<Vec3> directions = make_directions();
  std::vector<std::pair<double, Vec3>> candidates;
  for (const Vec3 &d : directions)
    if (const double cosine = d.dot(normal); cosine > 0.1)
      candidates.emplace_back(-cosine, d);
  std::ranges::stable_sort(candidates, {}, &std::pair<double, Vec3>::first);
  for (const double clearance : {preferred_clearance, least_clearance})
    for (const auto &[order, d] : candidates)
      if (ray_is_free(shape, x, d, clearance))
        return d;
  return std::nullopt;
}
} // namespace

bool ray_is_free(const GrainShape &shape, const Vec3 &x, const Vec3 &d, const double clearance)
{
  const double diameter = shape.diameter();
  const Vec3 lower = shape.lower_corner(), upper = shape.upper_corner();
  const double first = 1e-6 * diameter, widest = 0.05 * diameter;
  constexpr int most_steps = 1000; // a ray that creeps along the surface
  double t = first;
  for (int k = 0; k < most_steps; ++k)
  {
    const Vec3 y = x + t * d;
    if ((y.array() < lower.array() && d.array() <= 0).any() || (y.array() > upper.array() && d.array() >= 0).any())
      return true;
    const double distance = shape.signed_distance(y);
    if (distance <= clearance * std::min(t, widest))
      return false;
    t += std::max(distance, first); // nothing of the grain is nearer
  }
  return false;
}

Vec3 ray_direction(const GrainShape &shape, const RayDirection rule, const Vec3 &x)
{
  const Vec3 normal = shape.outward_normal(x);
  Vec3 wanted = rule == RayDirection::normal
                    ? normal
                    : Vec3((x - 0.5 * (shape.lower_corner() + shape.upper_corner())).normalized());
  if (shape.is_convex())
    return wanted;
  // Within a step surface nodes move along chords, which may pass below the surface.
  const double depth = -shape.signed_distance(x);
  const Vec3 start = depth > 0 ? Vec3(x + depth * normal) : x;
  if (ray_is_free(shape, start, wanted, preferred_clearance))
    return wanted;
  if (const auto direction = nearest_free_direction(shape, start, normal))
    return *direction;
  std::ostringstream message;
  message << "no straight way leads out of the grain from the surface point (" << x.transpose()
          << ") nm: a line that ends there cannot be continued to infinity";
  throw std::runtime_error(message.str());
}

Vec3 ray_burgers(const Network &network, const NodeIndex i)
{
  Vec3 b = Vec3::Zero();
  for (const SegmentIndex s : network.connected_segments(i))
    b -= network.burgers_from(s, i);
  return b;
}

std::vector<VirtualRay> virtual_rays(const Network &network, const GrainShape &shape, const RayDirection rule)
{
  std::vector<VirtualRay> rays;
  for (const NodeIndex i : network.nodes())
    if (network.constraint(i) == NodeConstraint::surface)
    {
      const Vec3 b = ray_burgers(network, i);
      if (b.squaredNorm() > 0)
        rays.push_back({network.position(i), ray_direction(shape, rule, network.position(i)), b, network.id(i)});
    }
  return rays;
}
} // namespace ddfem
