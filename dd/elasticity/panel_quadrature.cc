#include "dd/elasticity/panel_quadrature.h"

#include "dd/elasticity/panel_plan-inl.h"

#include <cmath>
#include <limits>

namespace ddfem::internal
{
void LineSingularities::add_end(const Vec3 &end, double a, const Vec3 &x3, const Vec3 &t)
{
  const Vec3 r = end - x3;
  const double z = r.dot(t);
  singularities[n++] = {z, (r - z * t).squaredNorm() + a * a};
}

void LineSingularities::add_pinch(const Vec3 &x1, const Vec3 &t12, double source_length, double a, const Vec3 &x3,
                                  const Vec3 &t)
{
  const Vec3 normal = t12.cross(t);
  const double sine2 = normal.squaredNorm();
  // Below this angle the pinch is further away than anything that matters.
  constexpr double smallest_sine2 = 1e-20;
  if (sine2 < smallest_sine2)
    return;
  const Vec3 r = x1 - x3;
  const double along_source = -r.cross(t).dot(normal) / sine2;
  if (along_source < 0.0 || along_source > source_length)
    return;
  const double gap = r.dot(normal);
  singularities[n++] = {-r.cross(t12).dot(normal) / sine2, (gap * gap / sine2 + a * a) / sine2};
}

LineSingularities LineSingularities::of_segment(const Vec3 &x1, const Vec3 &x2, double a, const Vec3 &x3, const Vec3 &t)
{
  LineSingularities result;
  result.add_end(x1, a, x3, t);
  result.add_end(x2, a, x3, t);
  const double length = (x2 - x1).norm();
  if (length > 0.0)
    result.add_pinch(x1, (x2 - x1) / length, length, a, x3, t);
  return result;
}

LineSingularities LineSingularities::of_point(const Vec3 &x, double a, const Vec3 &x3, const Vec3 &t)
{
  LineSingularities result;
  result.add_end(x, a, x3, t);
  return result;
}

LineSingularities LineSingularities::of_ray(const Vec3 &origin, const Vec3 &direction, double a, const Vec3 &x3,
                                            const Vec3 &t)
{
  LineSingularities result;
  result.add_end(origin, a, x3, t);
  result.add_pinch(origin, direction, std::numeric_limits<double>::infinity(), a, x3, t);
  return result;
}

double LineSingularities::ellipse(double begin, double end) const
{
  double sum = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < n; ++k)
  {
    const double from_begin = singularities[k].position - begin, from_end = singularities[k].position - end;
    sum = std::min(sum, std::sqrt(from_begin * from_begin + singularities[k].height2) +
                            std::sqrt(from_end * from_end + singularities[k].height2));
  }
  return sum / (end - begin);
}

double LineSingularities::longest_panel(double begin, double c, double floor) const
{
  // |z - A| + |z - B| >= c |AB| with A given, solved for |AB|.
  double length = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < n; ++k)
  {
    const double u = singularities[k].position - begin;
    const double height2 = std::max(singularities[k].height2, floor * floor);
    length = std::min(length, 2.0 * (c * std::sqrt(u * u + height2) - u) / (c * c - 1.0));
  }
  return length;
}

int n_gauss_points(double c, double tolerance)
{
  return static_cast<int>(HWY_NAMESPACE::n_points_on_panel(c, tolerance));
}

int n_gauss_points_for_segment(const Vec3 &x1, const Vec3 &x2, double a, const Vec3 &x3, const Vec3 &x4, const Vec3 &t,
                               double tolerance)
{
  using HWY_NAMESPACE::vector_of;
  const double length12 = (x2 - x1).norm();
  const auto v1 = vector_of<double>(x1), v2 = vector_of<double>(x2);
  const auto t12 = length12 > 0.0 ? vector_of<double>((x2 - x1) / length12) : vector_of<double>(Vec3::Zero());
  const HWY_NAMESPACE::Line<double> line{v1, v2, t12, {}, {}, length12};
  const HWY_NAMESPACE::Panel<double> panel{vector_of<double>(x3), vector_of<double>(x4), vector_of<double>(t),
                                           (x4 - x3).norm()};
  return n_gauss_points(HWY_NAMESPACE::ellipse_of_segment(line, panel, a * a), tolerance);
}
} // namespace ddfem::internal
