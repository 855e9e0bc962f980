#include "coupling/face_displacements.h"

#include "coupling/convert.h"
#include "dd/common/parallel.h"
#include "dd/elasticity/vectorised/displacement_kernels.h"
#include "dd/fmm/multipole_displacement.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace ddfem::coupling
{
namespace
{
/// A triangle from @p first on in the sense of its circuit.
std::array<LoopVertex, 3> rotated(const TriangularLoop &t, const std::size_t first)
{
  return {t.vertices[first], t.vertices[(first + 1) % 3], t.vertices[(first + 2) % 3]};
}

std::vector<TriangleCorners> extent_of(const TriangularLoop &t, const double reach)
{
  // From the finite vertex that follows one at infinity; from any, if all are finite.
  std::size_t first = 0;
  while (first < 2 && (t.vertices[first].at_infinity || !t.vertices[(first + 2) % 3].at_infinity))
    ++first;
  const auto [a, b, c] = rotated(t, first);
  if (!c.at_infinity)
    return {{a.value, b.value, c.value}};
  const Vec3 end_c = a.value + reach * c.value;
  if (b.at_infinity)
    return {{a.value, a.value + reach * b.value, end_c}};                                              // a sector
  return {{a.value, b.value, b.value + reach * c.value}, {a.value, b.value + reach * c.value, end_c}}; // a strip
}
} // namespace

void FaceDisplacement::add_stress(const std::span<const unsigned> sources,
                                  const std::span<const dealii::Point<3>> points,
                                  const std::span<dealii::SymmetricTensor<2, 3>> values) const
{
  std::vector<Vec3> u(points.size(), Vec3::Zero());
  add_displacement(sources, to_vectors(points), u);
  for (std::size_t i = 0; i < points.size(); ++i)
    values[i] += as_stress(u[i]);
}

dealii::SymmetricTensor<2, 3> FaceDisplacement::as_stress(const Vec3 &u) const
{
  dealii::SymmetricTensor<2, 3> s;
  for (unsigned c = 0; c < 3; ++c)
    s[axis][c] = u[c];
  return s;
}

SweptLoops::SweptLoops(const SweptArea &area)
{
  std::vector<TriangularLoop> open_ones;
  for (const SweptTriangle &t : area.triangles())
  {
    const auto &v = t.vertices;
    const bool is_open = v[0].at_infinity || v[1].at_infinity || v[2].at_infinity;
    (is_open ? open_ones : loops).emplace_back(v[0], v[1], v[2], t.burgers);
  }
  n_finite = loops.size();
  loops.insert(loops.end(), open_ones.begin(), open_ones.end());
}

Vec3 beside(const Vec3 &x)
{
  constexpr double distance = 1e-6; // nm
  return x + distance * Vec3(0.5377, 0.7213, 0.4368);
}

namespace
{
std::vector<Vec3> all_beside(const std::span<const Vec3> points)
{
  std::vector<Vec3> result;
  result.reserve(points.size());
  std::transform(points.begin(), points.end(), std::back_inserter(result), [](const Vec3 &x) { return beside(x); });
  return result;
}

/// Of the finite loops, at points of this rank.
std::vector<Vec3> multipole_displacement(const double nu, const SweptLoops &swept, const GatheredPoints &all,
                                         const std::size_t n_mine, const SweptSummation &summation)
{
  fmm::MultipoleDisplacement sum(nu, {tolerance_of_tractions(summation.settings)}, swept.finite(), all.points);
  const std::vector<Vec3> u = sum.displacement(summation.communicator);
  const auto first = u.begin() + static_cast<std::ptrdiff_t>(all.first);
  return {first, first + static_cast<std::ptrdiff_t>(n_mine)};
}
} // namespace

std::vector<Vec3> swept_displacement(const double nu, const SweptLoops &swept, const std::span<const Vec3> at,
                                     const SweptSummation &summation)
{
  const std::vector<Vec3> points = all_beside(at);
  const GatheredPoints all = gather_points(points, summation.communicator);
  if (!summation.use_multipoles(swept, all.points.size()))
    return triangle_displacements(nu, swept.loops, points);
  std::vector<Vec3> u = multipole_displacement(nu, swept, all, points.size(), summation);
  const std::vector<Vec3> of_open = triangle_displacements(nu, swept.open(), points);
  for (std::size_t i = 0; i < u.size(); ++i)
    u[i] += of_open[i];
  return u;
}

SweptDisplacement::SweptDisplacement(const SweptLoops &triangles, const double poisson, const int normal_axis,
                                     const double reach, const double smallest, const SweptSummation &how)
    : FaceDisplacement(normal_axis), swept(triangles), nu(poisson), resolution(smallest), summation(how)
{
  extents.reserve(swept.loops.size());
  for (const TriangularLoop &t : swept.loops)
    extents.push_back(extent_of(t, reach));
  if (summation.settings.method == SummationMethod::direct)
    return;
  std::vector<Ball> all;
  for (const TriangularLoop &t : swept.finite())
    all.push_back({t.middle(), t.radius()});
  balls = BallBlocks(all);
}

double SweptDisplacement::summation_error() const
{
  return tolerance_of_tractions(summation.settings);
}

std::vector<dealii::SymmetricTensor<2, 3>> SweptDisplacement::sum(const std::span<const dealii::Point<3>> points) const
{
  std::vector<dealii::SymmetricTensor<2, 3>> result;
  result.reserve(points.size());
  const GatheredPoints all = gather_points(all_beside(to_vectors(points)), summation.communicator);
  for (const Vec3 &u : multipole_displacement(nu, swept, all, points.size(), summation))
    result.push_back(as_stress(u));
  return result;
}

void SweptDisplacement::append_near(const dealii::Point<3> &centre, const double radius, const double length,
                                    std::vector<unsigned> &sources) const
{
  balls.append_touching(to_vec3(centre), radius + length, sources);
  for (auto open = static_cast<unsigned>(swept.n_finite); open < n_sources(); ++open)
  {
    double smooth = 0;
    smooth_lengths(centre, radius, {&open, 1}, {&smooth, 1});
    if (smooth < length)
      sources.push_back(open);
  }
}

void SweptDisplacement::smooth_lengths(const dealii::Point<3> &centre, const double radius,
                                       const std::span<const unsigned> sources, const std::span<double> lengths) const
{
  const Vec3 x = to_vec3(centre);
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    double squared = std::numeric_limits<double>::infinity();
    for (const TriangleCorners &corners : extents[sources[i]])
      squared = std::min(squared, nearest_point_of_triangle(x, corners).squared_distance);
    lengths[i] = std::max(std::sqrt(squared) - radius, resolution);
  }
}

void SweptDisplacement::add_displacement(const std::span<const unsigned> sources, const std::span<const Vec3> points,
                                         const std::span<Vec3> u) const
{
  std::vector<TriangularLoop> loops;
  loops.reserve(sources.size());
  for (const unsigned s : sources)
    loops.push_back(swept.loops[s]);
  DisplacementBuffer buffer(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    buffer.set_point(i, beside(points[i]));
  add_triangle_displacement(nu, loops, buffer.batch());
  for (std::size_t i = 0; i < points.size(); ++i)
    u[i] += buffer.value(i);
}

ImageDisplacement::ImageDisplacement(const SurfaceImages &surface_images, const int normal_axis, const double smallest,
                                     const SummationSettings &how)
    : FaceDisplacement(normal_axis), images(surface_images), resolution(smallest), summation(how)
{
  if (summation.method != SummationMethod::direct)
    balls = BallBlocks(images.bounding_balls());
}

void ImageDisplacement::smooth_lengths(const dealii::Point<3> &centre, const double radius,
                                       const std::span<const unsigned> sources, const std::span<double> lengths) const
{
  const Vec3 x = to_vec3(centre);
  for (std::size_t i = 0; i < sources.size(); ++i)
    lengths[i] = std::max(images.image_distance(sources[i], x) - radius, resolution);
}

void ImageDisplacement::append_near(const dealii::Point<3> &centre, const double radius, const double length,
                                    std::vector<unsigned> &sources) const
{
  const Vec3 x = to_vec3(centre);
  std::vector<unsigned> candidates;
  balls.append_touching(x, radius + length, candidates);
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(sources),
               [&](const unsigned image) { return images.image_distance(image, x) < radius + length; });
}

std::vector<std::vector<dealii::SymmetricTensor<2, 3>>> ImageDisplacement::complete_sum(
    const std::span<const fem::BoundaryPoints> boundaries) const
{
  // All images, on the boundaries where they are wanted at all.
  std::vector<Vec3> points;
  for (const fem::BoundaryPoints &b : boundaries)
    if (!b.others.empty())
      for (const auto &x : b.points)
        points.push_back(to_vec3(x));
  const std::vector<Vec3> u = at(points);
  std::vector<std::vector<dealii::SymmetricTensor<2, 3>>> result;
  auto next = u.begin();
  for (const fem::BoundaryPoints &b : boundaries)
  {
    auto &values = result.emplace_back(b.points.size());
    for (std::size_t i = 0; i < values.size() && !b.others.empty(); ++i)
      values[i] = as_stress(*next++);
  }
  return result;
}

std::vector<Vec3> ImageDisplacement::at(const std::span<const Vec3> points) const
{
  if (!use_multipoles_for_images(summation, n_sources(), points.size()))
    return images.displacement(points);
  return images.multipole_displacement(points, {tolerance_of_tractions(summation)}, MPI_COMM_SELF);
}
} // namespace ddfem::coupling
