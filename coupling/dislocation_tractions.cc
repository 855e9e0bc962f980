#include "coupling/dislocation_tractions.h"

#include "coupling/convert.h"
#include "dd/common/parallel.h"
#include "dd/elasticity/distance.h"
#include "dd/fmm/grids_and_rays.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace ddfem::coupling
{
std::vector<SymTensor> stress_of_images(const SurfaceImages &images, const std::span<const Vec3> points,
                                        const SummationSettings &summation, MPI_Comm comm)
{
  if (use_multipoles_for_images(summation, images.n_images(), points.size()))
    return images.multipole_stress(points, {summation.tolerance}, comm);
  std::vector<SymTensor> stress(points.size());
  const IndexRange owned = owned_range(points.size(), comm);
  const auto mine = images.stress(points.subspan(owned.begin, owned.end - owned.begin));
  std::copy(mine.begin(), mine.end(), stress.begin() + static_cast<std::ptrdiff_t>(owned.begin));
  gather_owned(stress, comm);
  return stress;
}

DislocationTractions::DislocationTractions(const LineSystem &system, const SurfaceImages *surface_images,
                                           const SummationSettings &settings, MPI_Comm comm)
    : line_system(system), images(surface_images), summation(settings), communicator(comm), ray_list(system.rays()),
      rays(system.ray_table())
{
  if (images)
    for (const auto &leg : images->remaining_legs())
    {
      ray_list.push_back(leg.ray);
      rays.add_ray(leg.ray.origin, leg.ray.direction, leg.ray.burgers);
    }
  std::vector<Ball> around, around_rests;
  const auto ball_of = [](const StraightLine &l) {
    return Ball{0.5 * (l.start + l.end), 0.5 * (l.end - l.start).norm()};
  };
  if (images)
    for (const auto &[line, face] : images->fading_lines())
    {
      rests.add_segment(line.start, line.end, line.burgers);
      around_rests.push_back(ball_of(line));
    }
  if (summation.method == SummationMethod::direct)
    return;
  for (const StraightLine &l : system.lines())
    around.push_back(ball_of(l));
  balls = BallBlocks(around);
  rest_balls = BallBlocks(around_rests);
  if (images)
    image_balls = BallBlocks(images->bounding_balls());
}

std::optional<unsigned> DislocationTractions::n_summed(const std::size_t n_points) const
{
  if (!summation.use_multipoles(n_lines(), n_points))
    return {};
  return static_cast<unsigned>(n_lines() + line_system.rays().size());
}

std::vector<dealii::SymmetricTensor<2, 3>> DislocationTractions::sum(
    const std::span<const dealii::Point<3>> points) const
{
  const GatheredPoints all = gather_points(to_vectors(points), communicator);
  MultipoleField field(line_system, all.points, {tolerance_of_tractions(summation)});
  const std::vector<SymTensor> stress = field.stress(communicator);
  std::vector<dealii::SymmetricTensor<2, 3>> result;
  result.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    result.push_back(to_symmetric_tensor(stress[all.first + i]));
  return result;
}

std::vector<std::vector<dealii::SymmetricTensor<2, 3>>> DislocationTractions::complete_sum(
    const std::span<const fem::BoundaryPoints> boundaries) const
{
  const fmm::MultipoleSettings settings{tolerance_of_tractions(summation)};
  std::vector<std::vector<dealii::SymmetricTensor<2, 3>>> result;
  std::vector<Vec3> points;
  std::vector<int> faces;
  for (const fem::BoundaryPoints &b : boundaries)
  {
    auto &values = result.emplace_back(b.points.size());
    const std::vector<Vec3> x = to_vectors(b.points);
    points.insert(points.end(), x.begin(), x.end());
    faces.insert(faces.end(), x.size(), static_cast<int>(b.boundary));
    // Legs and rests, then images; those under the plane of the boundary vanish there.
    const auto n_before_images =
        std::find_if(b.others.begin(), b.others.end(), [this](unsigned s) { return is_image(s); }) - b.others.begin();
    add_in_parallel(std::span(b.others).first(static_cast<std::size_t>(n_before_images)), 1., b.points, values);
    subtract(b.vanishing, b.points, settings, values);
  }
  if (!images || images->empty())
    return result;
  const std::vector<SymTensor> of_images = images->multipole_stress(points, settings, MPI_COMM_SELF, faces);
  auto next = of_images.begin();
  for (auto &values : result)
    for (auto &value : values)
      value += to_symmetric_tensor(*next++);
  return result;
}

void DislocationTractions::subtract(const std::span<const unsigned> sources,
                                    const std::span<const dealii::Point<3>> points,
                                    const fmm::MultipoleSettings &settings,
                                    const std::span<dealii::SymmetricTensor<2, 3>> values) const
{
  const auto line_end =
      static_cast<std::size_t>(std::lower_bound(sources.begin(), sources.end(), n_lines()) - sources.begin());
  if (!summation.use_multipoles(line_end, points.size()))
    return add_in_parallel(sources, -1., points, values);
  add_in_parallel(sources.subspan(line_end), -1., points, values);
  const std::vector<SymTensor> of_lines = stress_of_lines(sources.first(line_end), to_vectors(points), settings);
  for (std::size_t i = 0; i < points.size(); ++i)
    values[i] -= to_symmetric_tensor(of_lines[i]);
}

std::vector<SymTensor> DislocationTractions::stress_of_lines(const std::span<const unsigned> numbers,
                                                             const std::span<const Vec3> points,
                                                             const fmm::MultipoleSettings &settings) const
{
  std::vector<fmm::LineSource> lines;
  lines.reserve(numbers.size());
  for (const unsigned i : numbers)
  {
    const StraightLine &l = line_system.lines()[i];
    lines.push_back({l.start, l.end, l.burgers});
  }
  const fmm::RootGrid grid = fmm::enclosing_grid(fmm::extents_of(lines), {}, points);
  return fmm::MultipoleStress(line_system.medium(), settings, grid, lines, {}, points).stress(MPI_COMM_SELF);
}

void DislocationTractions::append_near(const dealii::Point<3> &centre, const double radius, const double length,
                                       std::vector<unsigned> &sources) const
{
  const Vec3 x = to_vec3(centre);
  std::vector<unsigned> candidates;
  balls.append_touching(x, radius + length, candidates);
  for (auto ray = static_cast<unsigned>(n_lines()); ray < first_rest(); ++ray)
    candidates.push_back(ray);
  const auto append = [&](const BallBlocks &blocks, const std::size_t first)
  {
    std::vector<unsigned> numbers;
    blocks.append_touching(x, radius + length, numbers);
    for (const unsigned k : numbers)
      candidates.push_back(static_cast<unsigned>(first) + k);
  };
  append(rest_balls, first_rest());
  append(image_balls, first_image());
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(sources),
               [&](const unsigned source) { return distance(source, x) < radius + length; });
}

unsigned DislocationTractions::n_sources() const
{
  return static_cast<unsigned>(first_image() + (images ? images->n_images() : 0));
}

bool DislocationTractions::vanishes_on(const unsigned source, const dealii::types::boundary_id boundary) const
{
  if (!images)
    return false;
  const int face = static_cast<int>(boundary);
  if (source < n_lines())
    return images->is_freed_of_line(source, face);
  if (is_image(source))
    return images->face_of_image(image_number(source)) == face;
  if (is_rest(source))
    return images->fading_lines()[source - first_rest()].face_id != face;
  const std::size_t ray = source - n_lines(), n_rays = line_system.rays().size();
  return ray < n_rays ? images->is_freed_of_ray(ray, face) : images->remaining_legs()[ray - n_rays].face_id != face;
}

double DislocationTractions::distance(const unsigned source, const Vec3 &x) const
{
  if (is_image(source))
    return images->image_distance(image_number(source), x);
  if (is_rest(source))
  {
    const StraightLine &l = images->fading_lines()[source - first_rest()].line;
    return std::sqrt(distance_point_segment(x, l.start, l.end).squared);
  }
  if (source >= n_lines())
  {
    const VirtualRay &r = ray_list[source - n_lines()];
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
  StressBuffer buffer(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    buffer.set_point(i, points[i]);
  std::vector<unsigned> of_lines, of_rays, of_rests, of_images;
  for (const unsigned source : sources)
    if (is_image(source))
      of_images.push_back(static_cast<unsigned>(image_number(source)));
    else if (is_rest(source))
      of_rests.push_back(source - static_cast<unsigned>(first_rest()));
    else if (source < n_lines())
      of_lines.push_back(source);
    else
      of_rays.push_back(source - static_cast<unsigned>(n_lines()));
  add_segment_stress(line_system.medium(), line_system.segment_table(), of_lines, buffer.batch());
  add_ray_stress(line_system.medium(), rays, of_rays, buffer.batch());
  add_segment_stress(line_system.medium(), rests, of_rests, buffer.batch());
  std::vector<SymTensor> sums;
  for (std::size_t i = 0; i < points.size(); ++i)
    sums.push_back(buffer.value(i));
  if (!of_images.empty())
    images->add_stress(of_images, to_vectors(points), sums);
  for (std::size_t i = 0; i < points.size(); ++i)
    values[i] += to_symmetric_tensor(sums[i]);
}
} // namespace ddfem::coupling
