// Quadrature along a segment in the field of another straight piece of line, with error control from geometry.
// Internal to dd/elasticity.
//
// The field of segment x1 -> x2 on the line x(z) = x3 + z t34 is analytic in the complex variable z except where
//   * R_a from an end of the source vanishes: z = z_k +- i h_k, z_k the projection of the end on the line and
//     h_k^2 = (distance of the end from the line)^2 + a^2;
//   * the singularities +-i d_a(z) of the *inner* integrand pinch the path of integration: d_a(z) = 0, which happens at
//     z = z_0 +- i h/sin(angle), z_0 the point of closest approach of the two lines, h^2 = (their distance)^2 + a^2,
//     and only counts if the closest point of the source line lies within the source.
// An n-point Gauss rule on a panel converges like rho^(-2n), where rho + 1/rho = (|z - A| + |z - B|)/(half length) for
// the singularity z whose ellipse with foci at the ends A, B of the panel is the smallest (Trefethen, Approximation
// Theory and Approximation Practice, theorem 19.3). Panels are as long as a minimal rho allows, so their number grows
// only with the logarithm of length over distance, and for parallel segments only the ends of the source need
// refinement.
#pragma once

#include "dd/common/types.h"
#include "dd/elasticity/gauss.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace ddfem::internal
{
/// Singularities position +- i height (nm) of an integrand on the line of a segment, positions counted from its start.
class LineSingularities
{
public:
  /// Of the field of segment @p x1 -> @p x2, core radius @p a, on the line from @p x3 along the unit vector @p t.
  static LineSingularities of_segment(const Vec3 &x1, const Vec3 &x2, double a, const Vec3 &x3, const Vec3 &t);
  /// Of a function of the distance of the line's points from @p x, regularised with @p a.
  static LineSingularities of_point(const Vec3 &x, double a, const Vec3 &x3, const Vec3 &t);
  /// Of the field of a ray.
  static LineSingularities of_ray(const Vec3 &origin, const Vec3 &direction, double a, const Vec3 &x3, const Vec3 &t);

  /// Adds position +- i height; three in all.
  void add(double position, double height) { singularities[n++] = {position, height * height}; }

  /// (rho + 1/rho)/2 of the largest Bernstein ellipse of panel [@p begin, @p end] free of singularities.
  double ellipse(double begin, double end) const;

  /// Length of the longest panel that starts at @p begin and has ellipse() >= @p c; infinite if there is no limit.
  /// Singularities are kept at least @p floor away from the line, so that the length is never zero.
  double longest_panel(double begin, double c, double floor) const;

private:
  struct Singularity
  {
    double position, height2;
  };
  void add_end(const Vec3 &end, double a, const Vec3 &x3, const Vec3 &t);
  void add_pinch(const Vec3 &x1, const Vec3 &t12, double source_length, double a, const Vec3 &x3, const Vec3 &t);

  std::array<Singularity, 3> singularities{};
  std::size_t n = 0;
};

/// Number of Gauss points for error @p tolerance on a panel with ellipse() = @p c; 0: a graded partition is needed.
int n_gauss_points(double c, double tolerance);
/// The same for the force on segment @p x3 -> @p x4 (unit direction @p t) in the field of segment @p x1 -> @p x2, from
/// a cheaper lower bound of c where they are far apart.
int n_gauss_points_for_segment(const Vec3 &x1, const Vec3 &x2, double a, const Vec3 &x3, const Vec3 &x4, const Vec3 &t,
                               double tolerance);

/// Calls @p add(z, weight) for the points z in [@p begin, @p end] (nm) and weights (nm) of a rule with @p n points.
template <typename Add> void integrate_on_panel(int n, double begin, double end, Add &&add)
{
  const GaussRule rule = gauss_rule(n);
  for (std::size_t i = 0; i < rule.points.size(); ++i)
    add(begin + rule.points[i] * (end - begin), rule.weights[i] * (end - begin));
}

/// Calls @p visit(begin, end, n) for panels of [0, @p length] that grow with the distance from the singularities, with the numbers of points that
/// they need. A single panel with a moderately small ellipse (n_gauss_points() > 0) is cheaper than two with large ones; the cost of a graded
/// partition is nearly flat around an ellipse of rho = 2.3 (panels that grow by a factor of six).
template <typename Visit>
void for_each_graded_panel(const LineSingularities &singularities, double length, double tolerance, Visit &&visit)
{
  constexpr double smallest_c = 0.5 * (2.2 + 1.0 / 2.2), relative_floor = 1e-8;
  double begin = 0.0;
  while (begin < length)
  {
    const double end =
        std::min(length, begin + singularities.longest_panel(begin, smallest_c, relative_floor * length));
    visit(begin, end, n_gauss_points(std::max(singularities.ellipse(begin, end), smallest_c), tolerance));
    begin = end;
  }
}

/// Calls @p add as integrate_on_panel(), on these panels.
template <typename Add>
void integrate_graded(const LineSingularities &singularities, double length, double tolerance, Add &&add)
{
  for_each_graded_panel(singularities, length, tolerance,
                        [&](double begin, double end, int n) { integrate_on_panel(n, begin, end, add); });
}

/// One or the other, as the singularities demand.
template <typename Add>
void integrate_on_panels(const LineSingularities &singularities, double length, double tolerance, Add &&add)
{
  const int n = n_gauss_points(singularities.ellipse(0.0, length), tolerance);
  if (n > 0)
    integrate_on_panel(n, 0.0, length, add);
  else
    integrate_graded(singularities, length, tolerance, add);
}
} // namespace ddfem::internal
