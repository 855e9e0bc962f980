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
    rays.push_back(source_of(r));
  std::vector<Vec3> in_cell(points_.begin(), points_.end());
  for (Vec3 &x : in_cell)
    x += system->shift_into_cell(x);
  const PeriodicCell *const cell = system->cell();
  const std::vector<fmm::SourceExtent> extents = fmm::extents_of(lines);
  const double lines_per_leaf = fmm::best_lines_per_leaf(settings, lines.size(), in_cell.size());
  cuts.grid = cell ? fmm::periodic_grid(cell->origin, cell->lengths, extents, lines_per_leaf)
                   : fmm::enclosing_grid(extents, rays, in_cell, lines_per_leaf);
  cuts.shortest = mean_length(system->lines());
  std::vector<RaySource> distant;
  for (const RaySource &r : rays)
  {
    cuts.ways.push_back(fmm::cuts_of(r, cuts.grid, cuts.shortest));
    distant.push_back(fmm::cut_ray(r, cuts.ways.back(), lines));
  }
  expansions = std::make_unique<fmm::MultipoleStress>(system->medium(), settings, cuts.grid, lines, distant, in_cell);
  keep(std::move(in_cell));
}

std::vector<SymTensor> MultipoleField::stress(MPI_Comm comm, const fmm::Part part, const fmm::Recipient recipient,
                                              const fmm::LocalExpansions local)
{
  std::vector<SymTensor> values = expansions->stress(comm, part, recipient, local);
  if (part != fmm::Part::near)
    add_distant_images(values, recipient);
  return values;
}

void MultipoleField::keep(std::vector<Vec3> given)
{
  points = system->far_images() ? std::move(given) : std::vector<Vec3>();
}

void MultipoleField::add_distant_images(std::vector<SymTensor> &values, const fmm::Recipient recipient) const
{
  if (!system->far_images())
    return;
  const std::span<const std::uint32_t> numbers = expansions->points_with_values(recipient);
#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < numbers.size(); ++k)
    values[numbers[k]] += system->far_images()->far_stress(points[numbers[k]]);
}

SymTensor MultipoleField::stress_of_distant_images(const std::size_t i) const
{
  return system->far_images() ? system->far_images()->far_stress(points[i]) : SymTensor(SymTensor::Zero());
}

void MultipoleField::move(const LineSystem &now, const std::span<const Vec3> points_now, const LinesInBoxes &sources,
                          const std::span<const std::uint32_t> leaf_of_point)
{
  system = &now;
  keep({points_now.begin(), points_now.end()});
  expansions->move(sources.sources(), points_now, leaf_of_point);
}

std::vector<SymTensor> MultipoleField::stress_with_kept_far_field(MPI_Comm comm, const double ahead,
                                                                  const fmm::Recipient recipient)
{
  std::vector<SymTensor> values =
      expansions->stress_with_kept_far_field(comm, {.ahead = ahead, .recipient = recipient});
  add_distant_images(values, recipient);
  return values;
}

std::vector<SymTensor> MultipoleField::stress_with_new_far_field(MPI_Comm comm)
{
  std::vector<SymTensor> values = expansions->stress_with_new_far_field(comm);
  add_distant_images(values, fmm::Recipient::every_rank);
  return values;
}

void MultipoleField::set_earlier(const std::vector<fmm::LineSource> &lines, std::vector<RaySource> distant_rays)
{
  expansions->set_earlier(lines, std::move(distant_rays));
}
} // namespace ddfem
