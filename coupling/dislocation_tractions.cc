#include "coupling/dislocation_tractions.h"

#include "coupling/convert.h"
#include "dd/elasticity/distance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ddfem::coupling
{
DislocationTractions::DislocationTractions(const LineSystem &system) : line_system(system)
{
  const IsotropicMedium &medium = system.medium();
  lines.reserve(system.lines().size());
  for (const StraightLine &l : system.lines())
    lines.emplace_back(medium, l.start, l.end, l.burgers);
  rays.reserve(system.rays().size());
  for (const VirtualRay &r : system.rays())
    rays.emplace_back(medium, r.origin, r.direction, r.burgers);
}

unsigned DislocationTractions::n_sources() const
{
  return static_cast<unsigned>(lines.size() + rays.size());
}

void DislocationTractions::smooth_lengths(const dealii::Point<3> &centre, const double radius,
                                          const std::span<const unsigned> sources,
                                          const std::span<double> lengths) const
{
  const Vec3 x = to_vec3(centre);
  const double a2 = line_system.medium().a * line_system.medium().a;
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    const bool is_line = sources[i] < lines.size();
    double squared;
    if (is_line)
    {
      const StraightLine &l = line_system.lines()[sources[i]];
      squared = distance_point_segment(x, l.start, l.end).squared;
    }
    else
    {
      const VirtualRay &r = line_system.rays()[sources[i] - lines.size()];
      squared = distance_point_ray(x, r.origin, r.direction).squared;
    }
    const double d = std::max(0.0, std::sqrt(squared) - radius);
    lengths[i] = std::sqrt(d * d + a2);
  }
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
  for (const unsigned source : sources)
    if (source < lines.size())
      lines[source].add(batch);
    else
      rays[source - lines.size()].add(batch);
  SymTensor sum;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    for (Eigen::Index c = 0; c < 6; ++c)
      sum[c] = batch.sigma[c][i];
    values[i] += to_symmetric_tensor(sum);
  }
}
} // namespace ddfem::coupling
