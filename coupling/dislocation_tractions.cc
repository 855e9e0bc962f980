#include "coupling/dislocation_tractions.h"

#include "coupling/convert.h"
#include "dd/elasticity/distance.h"
#include "dd/elasticity/segment_stress.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ddfem::coupling
{
std::size_t DislocationTractions::n_sources() const
{
  const std::size_t n = line_system.lines().size() + line_system.rays().size();
  return surface_images ? n + surface_images->n_images() + surface_images->remaining_legs().size() : n;
}

bool DislocationTractions::vanishes_on(std::size_t i, const dealii::types::boundary_id boundary) const
{
  if (!surface_images)
    return false;
  const int face = static_cast<int>(boundary);
  if (i < line_system.lines().size())
    return surface_images->is_freed_of_line(i, face);
  i -= line_system.lines().size();
  if (i < line_system.rays().size())
    return surface_images->is_freed_of_ray(i, face);
  i -= line_system.rays().size();
  if (i < surface_images->n_images())
    return surface_images->face_of_image(i) == face;
  return surface_images->remaining_legs()[i - surface_images->n_images()].face_id != face;
}

double DislocationTractions::distance(std::size_t i, const Vec3 &x) const
{
  if (i < line_system.lines().size())
    return std::sqrt(distance_point_segment(x, line_system.lines()[i].start, line_system.lines()[i].end).squared);
  i -= line_system.lines().size();
  const auto to_ray = [&](const VirtualRay &r)
  { return std::sqrt(distance_point_ray(x, r.origin, r.direction).squared); };
  if (i < line_system.rays().size())
    return to_ray(line_system.rays()[i]);
  i -= line_system.rays().size();
  if (i < surface_images->n_images())
    return surface_images->image_distance(i, x);
  return to_ray(surface_images->remaining_legs()[i - surface_images->n_images()].ray);
}

SymTensor DislocationTractions::stress_of(std::size_t i, const Vec3 &x) const
{
  const IsotropicMedium &m = line_system.medium();
  if (i < line_system.lines().size())
  {
    const StraightLine &l = line_system.lines()[i];
    return segment_stress(m, x, l.start, l.end, l.burgers);
  }
  i -= line_system.lines().size();
  const auto of_ray = [&](const VirtualRay &r) { return ray_stress(m, x, r.origin, r.direction, r.burgers); };
  if (i < line_system.rays().size())
    return of_ray(line_system.rays()[i]);
  i -= line_system.rays().size();
  if (i < surface_images->n_images())
    return surface_images->image_stress(i, x);
  return of_ray(surface_images->remaining_legs()[i - surface_images->n_images()].ray);
}

double DislocationTractions::smooth_length(const dealii::Point<3> &centre, const double radius,
                                           const dealii::types::boundary_id boundary) const
{
  double d = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n_sources(); ++i)
    if (!vanishes_on(i, boundary))
      d = std::min(d, distance(i, to_vec3(centre)));
  return std::hypot(std::max(0.0, d - radius), line_system.medium().a);
}

void DislocationTractions::stress(const std::vector<dealii::Point<3>> &points,
                                  const std::vector<dealii::types::boundary_id> &boundaries,
                                  std::vector<dealii::SymmetricTensor<2, 3>> &values) const
{
#pragma omp parallel for schedule(dynamic, 16)
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    SymTensor sum = SymTensor::Zero();
    for (std::size_t i = 0; i < n_sources(); ++i)
      if (!vanishes_on(i, boundaries[k]))
        sum += stress_of(i, to_vec3(points[k]));
    values[k] = to_symmetric_tensor(sum);
  }
}
} // namespace ddfem::coupling
