#include "dd/forces/multipole_field.h"

#include "dd/fmm/grids_and_rays.h"

#include <algorithm>
#include <utility>

namespace ddfem
{
namespace
{
using fmm::RaySource;

/// Shortest piece into which rays are cut: about the size of the segments.
double mean_length(const std::vector<StraightLine> &lines)
{
  double sum = 0;
  for (const StraightLine &l : lines)
    sum += (l.end - l.start).norm();
  return lines.empty() ? 1.0 : std::max(sum / static_cast<double>(lines.size()), 1e-3);
}
} // namespace

std::vector<fmm::LineSource> line_sources(const LineSystem &system)
{
  std::vector<fmm::LineSource> sources;
  sources.reserve(system.lines().size());
  for (const StraightLine &l : system.lines())
    sources.push_back({l.start, l.end, l.burgers});
  return sources;
}

MultipoleField::MultipoleField(const LineSystem &system_, const std::span<const Vec3> points_,
                               const fmm::MultipoleSettings &settings)
    : system(&system_)
{
  std::vector<fmm::LineSource> lines = line_sources(*system);
  std::vector<RaySource> rays;
  for (const VirtualRay &r : system->rays())
    rays.push_back({r.origin, r.direction, r.burgers});
  take(points_);
  const PeriodicCell *const cell = system->cell();
  cuts.grid = cell ? fmm::periodic_grid(cell->origin, cell->lengths)
                   : fmm::enclosing_grid(fmm::extents_of(lines), rays, points);
  cuts.shortest = mean_length(system->lines());
  std::vector<RaySource> distant;
  for (const RaySource &r : rays)
  {
    cuts.ways.push_back(fmm::cuts_of(r, cuts.grid, cuts.shortest));
    distant.push_back(fmm::cut_ray(r, cuts.ways.back(), lines));
  }
  expansions = std::make_unique<fmm::MultipoleStress>(system->medium(), settings, cuts.grid, lines, distant, points);
}

std::vector<SymTensor> MultipoleField::stress(MPI_Comm comm, const fmm::Part part)
{
  std::vector<SymTensor> values = expansions->stress(comm, part);
  if (part != fmm::Part::near)
    add_distant_images(values);
  return values;
}

void MultipoleField::take(const std::span<const Vec3> given)
{
  points.assign(given.begin(), given.end());
  for (Vec3 &x : points)
    x += system->shift_into_cell(x);
}

void MultipoleField::add_distant_images(std::vector<SymTensor> &values) const
{
  if (!system->far_images())
    return;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < points.size(); ++i)
    values[i] += system->far_images()->far_stress(points[i]);
}

SymTensor MultipoleField::stress_of_distant_images(const std::size_t i) const
{
  return system->far_images() ? system->far_images()->far_stress(points[i]) : SymTensor(SymTensor::Zero());
}

void MultipoleField::move(const LineSystem &now, const std::span<const Vec3> points_now, const LinesInBoxes &sources,
                          const std::span<const std::uint32_t> leaf_of_point)
{
  system = &now;
  points.assign(points_now.begin(), points_now.end());
  expansions->move(sources.sources(), points, leaf_of_point);
}

std::vector<SymTensor> MultipoleField::stress_with_kept_far_field(MPI_Comm comm, const double ahead)
{
  std::vector<SymTensor> values = expansions->stress_with_kept_far_field(comm, {.ahead = ahead});
  add_distant_images(values);
  return values;
}

std::vector<SymTensor> MultipoleField::stress_with_new_far_field(MPI_Comm comm)
{
  std::vector<SymTensor> values = expansions->stress_with_new_far_field(comm);
  add_distant_images(values);
  return values;
}

void MultipoleField::set_earlier(const std::vector<fmm::LineSource> &lines, std::vector<RaySource> distant_rays)
{
  std::vector<fmm::LineSource> in_order;
  in_order.reserve(lines.size());
  for (const std::uint32_t i : expansions->octree().line_order())
    in_order.push_back(lines[i]);
  expansions->set_earlier(std::move(in_order), std::move(distant_rays));
}
} // namespace ddfem
