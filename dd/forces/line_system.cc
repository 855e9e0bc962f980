#include "dd/forces/line_system.h"

#include "dd/elasticity/distance.h"
#include "dd/elasticity/segment_stress.h"
#include "dd/elasticity/vectorised/stress_kernels.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ddfem
{
LineSystem::LineSystem(const IsotropicMedium &medium_, const Network &network, const GrainShape *shape,
                       const RayDirection rule, const PeriodicCell *cell_, PeriodicImages *images_,
                       const ImageSources sources)
    : elastic_medium(medium_), shifts{Vec3::Zero()}, periodic_cell(cell_), images(images_)
{
  straight_lines.reserve(network.n_segments());
  for (const SegmentIndex s : network.segments())
  {
    Vec3 start = network.position(network.start(s));
    const Vec3 t = network.direction(s);
    if (periodic_cell)
      start += periodic_cell->shift_into_cell(start + 0.5 * t);
    straight_lines.push_back({start, start + t, network.burgers(s)});
  }
  if (shape)
    for (const VirtualRay &r : virtual_rays(network, *shape, rule))
      add_ray(r);
  if (images_)
    shifts = images_->near_shifts();
  if (images_ && sources == ImageSources::set_at_once)
  {
    std::vector<LineElement> elements;
    elements.reserve(straight_lines.size());
    for (const StraightLine &l : straight_lines)
      elements.push_back({l.start, l.end, l.burgers});
    images_->set_sources(elastic_medium, elements);
  }
}

void LineSystem::close(const OpenLines &open)
{
  for (const StraightLine &l : open.lines)
    straight_lines.push_back({l.start, l.end, -l.burgers});
  segments = std::make_shared<SegmentTable>();
  for (const VirtualRay &r : open.rays)
    add_ray({r.origin, r.direction, -r.burgers});
}

const LineTable &LineSystem::segment_table() const
{
  std::call_once(segments->is_made,
                 [this]
                 {
                   segments->table.reserve(straight_lines.size());
                   for (const StraightLine &l : straight_lines)
                     segments->table.add_segment(l.start, l.end, l.burgers);
                 });
  return segments->table;
}

void LineSystem::add_ray(const VirtualRay &ray)
{
  virtual_ray_list.push_back(ray);
  rays_in_table.add_ray(ray.origin, ray.direction, ray.burgers);
}

SymTensor LineSystem::stress(const Vec3 &point) const
{
  const Vec3 x = periodic_cell ? Vec3(point + periodic_cell->shift_into_cell(point)) : point;
  SymTensor sum = SymTensor::Zero();
  for (const StraightLine &l : straight_lines)
    for (const Vec3 &shift : shifts)
      sum += segment_stress(elastic_medium, x - shift, l.start, l.end, l.burgers);
  for (const VirtualRay &r : virtual_ray_list)
    sum += ray_stress(elastic_medium, x, r.origin, r.direction, r.burgers);
  if (images)
    sum += images->far_stress(x);
  return sum;
}

std::vector<SymTensor> LineSystem::stress(std::span<const Vec3> points) const
{
  std::vector<SymTensor> values(points.size(), SymTensor::Zero());
  constexpr std::size_t portion = 64;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t first = 0; first < points.size(); first += portion)
  {
    const std::size_t n = std::min(portion, points.size() - first);
    add_stress(points.subspan(first, n), std::span(values).subspan(first, n));
  }
  return values;
}

void LineSystem::add_stress(const std::span<const Vec3> points, const std::span<SymTensor> values) const
{
  StressBuffer buffer(points.size());
  const auto in_cell = [&](const Vec3 &x) { return periodic_cell ? Vec3(x + periodic_cell->shift_into_cell(x)) : x; };
  for (const Vec3 &shift : shifts)
  {
    for (std::size_t i = 0; i < points.size(); ++i)
      buffer.set_point(i, in_cell(points[i]) - shift);
    add_segment_stress(elastic_medium, segment_table(), buffer.batch());
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    buffer.set_point(i, in_cell(points[i]));
  add_ray_stress(elastic_medium, rays_in_table, buffer.batch());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    values[i] += buffer.value(i);
    if (images)
      values[i] += images->far_stress(in_cell(points[i]));
  }
}

double LineSystem::distance(const Vec3 &x) const
{
  double d = std::numeric_limits<double>::infinity();
  for (const StraightLine &l : straight_lines)
    d = std::min(d, std::sqrt(distance_point_segment(x, l.start, l.end).squared));
  for (const VirtualRay &r : virtual_ray_list)
    d = std::min(d, std::sqrt(distance_point_ray(x, r.origin, r.direction).squared));
  return d;
}
} // namespace ddfem
