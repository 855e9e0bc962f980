#include "dd/elasticity/panel_quadrature.h"

#include <cmath>
#include <limits>

namespace ddfem::internal
{
void LineSingularities::add_end(const Vec3 &end, double a, const Vec3 &x3, const Vec3 &t)
{
  const Vec3 r = end - x3;
  const double z = r.dot(t);
  singularities[n++] = {z, std::sqrt((r - z * t).squaredNorm() + a * a)};
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
  singularities[n++] = {-r.cross(t12).dot(normal) / sine2, std::sqrt((gap * gap / sine2 + a * a) / sine2)};
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
    const double h2 = singularities[k].height * singularities[k].height;
    const double from_begin = singularities[k].position - begin, from_end = singularities[k].position - end;
    sum = std::min(sum, std::sqrt(from_begin * from_begin + h2) + std::sqrt(from_end * from_end + h2));
  }
  const double c = sum / (end - begin); // (rho + 1/rho)/2
  return c > 1.0 ? c + std::sqrt(c * c - 1.0) : 1.0;
}

double LineSingularities::longest_panel(double begin, double rho, double floor) const
{
  // |z - A| + |z - B| >= c |AB| with A given, solved for |AB|.
  const double c = 0.5 * (rho + 1.0 / rho);
  double length = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < n; ++k)
  {
    const double u = singularities[k].position - begin;
    const double h = std::max(singularities[k].height, floor);
    length = std::min(length, 2.0 * (c * std::sqrt(u * u + h * h) - u) / (c * c - 1.0));
  }
  return length;
}

int n_gauss_points(double rho, double tolerance)
{
  // Error bound ~ safety rho^(1 - 2n): one power is lost to the linear shape functions, and the safety factor covers
  // the growth of the integrand towards its singularity on the ellipse. Repeated products are cheaper than two
  // logarithms.
  constexpr double safety = 200.0;
  const double wanted = safety / tolerance, rho2 = rho * rho;
  int n = 2;
  for (double reached = rho2 * rho; reached < wanted && n < max_gauss_points; reached *= rho2)
    ++n;
  return n;
}
} // namespace ddfem::internal
