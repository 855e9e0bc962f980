#include "coupling/face_displacements.h"

#include "coupling/convert.h"
#include "dd/elasticity/vectorised/displacement_kernels.h"

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
  std::vector<Vec3> positions, u(points.size(), Vec3::Zero());
  std::transform(points.begin(), points.end(), std::back_inserter(positions), to_vec3);
  add_displacement(sources, positions, u);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (unsigned c = 0; c < 3; ++c)
      values[i][axis][c] += u[i][c];
}

SweptDisplacement::SweptDisplacement(const std::vector<TriangularLoop> &triangles, const double poisson,
                                     const int normal_axis, const double reach, const double smallest)
    : FaceDisplacement(normal_axis), swept(triangles), nu(poisson), resolution(smallest)
{
  extents.reserve(swept.size());
  for (const TriangularLoop &t : swept)
    extents.push_back(extent_of(t, reach));
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
    loops.push_back(swept[s]);
  DisplacementBuffer buffer(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    buffer.set_point(i, points[i]);
  add_triangle_displacement(nu, loops, buffer.batch());
  for (std::size_t i = 0; i < points.size(); ++i)
    u[i] += buffer.value(i);
}

void ImageDisplacement::smooth_lengths(const dealii::Point<3> &centre, const double radius,
                                       const std::span<const unsigned> sources, const std::span<double> lengths) const
{
  const Vec3 x = to_vec3(centre);
  for (std::size_t i = 0; i < sources.size(); ++i)
    lengths[i] = std::max(images.image_distance(sources[i], x) - radius, resolution);
}
} // namespace ddfem::coupling
