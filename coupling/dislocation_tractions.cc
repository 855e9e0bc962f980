#include "coupling/dislocation_tractions.h"

#include "coupling/convert.h"
#include "dd/elasticity/distance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ddfem::coupling
{
DislocationTractions::DislocationTractions(const LineSystem &system, const SurfaceImages *surface_images)
    : line_system(system), images(surface_images), ray_list(system.rays())
{
  const IsotropicMedium &medium = system.medium();
  lines.reserve(system.lines().size());
  for (const StraightLine &l : system.lines())
    lines.emplace_back(medium, l.start, l.end, l.burgers);
  if (images)
    for (const auto &leg : images->remaining_legs())
      ray_list.push_back(leg.ray);
  rays.reserve(ray_list.size());
  for (const VirtualRay &r : ray_list)
    rays.emplace_back(medium, r.origin, r.direction, r.burgers);
}

unsigned DislocationTractions::n_sources() const
{
  return static_cast<unsigned>(lines.size() + rays.size() + (images ? images->n_images() : 0));
}

bool DislocationTractions::vanishes_on(const unsigned source, const dealii::types::boundary_id boundary) const
{
  if (!images)
    return false;
  const int face = static_cast<int>(boundary);
  if (source < lines.size())
    return images->is_freed_of_line(source, face);
  if (is_image(source))
    return images->face_of_image(image_number(source)) == face;
  const std::size_t ray = source - lines.size(), n_rays = line_system.rays().size();
  return ray < n_rays ? images->is_freed_of_ray(ray, face) : images->remaining_legs()[ray - n_rays].face_id != face;
}

double DislocationTractions::distance(const unsigned source, const Vec3 &x) const
{
  if (is_image(source))
    return images->image_distance(image_number(source), x);
  if (source >= lines.size())
  {
    const VirtualRay &r = ray_list[source - lines.size()];
    return std::sqrt(distance_point_ray(x, r.origin, r.direction).squared);
  }
  const StraightLine &l = line_system.lines()[source];
  return std::sqrt(distance_point_segment(x, l.start, l.end).squared);
}

void DislocationTractions::smooth_lengths(const dealii::Point<3> &centre, const double radius,
                                          const std::span<const unsigned> sources,
                                          const std::span<double> lengths) const
{
  const Vec3 x = to_vec3(centre);
  for (std::size_t i = 0; i < sources.size(); ++i)
    lengths[i] = std::hypot(std::max(0.0, distance(sources[i], x) - radius), line_system.medium().a);
}

void DislocationTractions::add_stress(const std::span<const unsigned> sources,
                                      const std::span<const dealii::Point<3>> points,
                                      const std::span<dealii::SymmetricTensor<2, 3>> values) const
{
  // The last point is repeated up to whole vectors of the widest kind: the rest of a loop costs more than full vectors.
  constexpr std::size_t width = 8;
  const std::size_t n = (points.size() + width - 1) / width * width;
  std::vector<double> numbers(9 * n, 0.0); // coordinates and stresses, component by component
  for (std::size_t i = 0; i < n; ++i)
    for (unsigned c = 0; c < 3; ++c)
      numbers[c * n + i] = points[std::min(i, points.size() - 1)][c];
  StressBatch batch{n, {}, {}};
  for (std::size_t c = 0; c < 3; ++c)
    batch.x[c] = &numbers[c * n];
  for (std::size_t c = 0; c < 6; ++c)
    batch.sigma[c] = &numbers[(3 + c) * n];
  std::vector<std::size_t> image_sources;
  for (const unsigned source : sources)
    if (is_image(source))
      image_sources.push_back(image_number(source));
    else if (source < lines.size())
      lines[source].add(batch);
    else
      rays[source - lines.size()].add(batch);
  SymTensor sum;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    for (Eigen::Index c = 0; c < 6; ++c)
      sum[c] = batch.sigma[c][i];
    if (!image_sources.empty())
      sum += images->stress(image_sources, to_vec3(points[i]));
    values[i] += to_symmetric_tensor(sum);
  }
}
} // namespace ddfem::coupling
