// How many Gauss points a single panel needs on a segment in the field of a line (see panel_quadrature.h).
//
// Compiled without contraction of products and sums: every target, and the scalar reference, come to the same number of
// points, so that their results differ by rounding and not by the error of the quadrature.

#if defined(DDFEM_DD_ELASTICITY_PANEL_PLAN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DDFEM_DD_ELASTICITY_PANEL_PLAN_INL_H
#undef DDFEM_DD_ELASTICITY_PANEL_PLAN_INL_H
#else
#define DDFEM_DD_ELASTICITY_PANEL_PLAN_INL_H
#endif

#include "dd/elasticity/gauss.h"
#include "dd/elasticity/line_stress-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ddfem::HWY_NAMESPACE
{
/// The segment on which a force is integrated: ends, unit direction, length (nm).
template <class T> struct Panel
{
  Vector<T> x3, x4, t;
  T length;
};

/// The quotient (rho + 1/rho)/2 from which a single panel is preferred to a graded partition: rho = 1.6, see
/// integrate_graded().
constexpr double smallest_single = 0.5 * (1.6 + 1.0 / 1.6);

/// Number of points of a Gauss rule for relative error @p tolerance on a panel with (rho + 1/rho)/2 = c; 0 if a single panel
/// will not do. The error bound is safety rho^(1 - 2n): one power is lost to the linear shape functions, and the
/// safety factor covers the growth of the integrand towards its singularity on the ellipse. Repeated products are
/// cheaper than two logarithms.
template <class T> HWY_INLINE T n_points_on_panel(const T &c, const double tolerance)
{
  constexpr double safety = 200.0;
  const T wanted(safety / tolerance), one(1.0);
  const auto graded = c < T(smallest_single);
  const T rho = select(graded, wanted, c + sqrt(max(c * c - one, T(0.0)))), rho2 = rho * rho;
  T n(2.0), reached = rho2 * rho;
  for (int k = 2; k < max_gauss_points && any(reached < wanted); ++k)
  {
    n = n + select(reached < wanted, one, T(0.0));
    reached = reached * rho2;
  }
  return select(graded, T(0.0), n);
}

template <class T> HWY_INLINE T distance_sum(const Vector<T> &x, const Panel<T> &p, const T &a2)
{
  const Vector<T> r3 = x - p.x3, r4 = x - p.x4;
  return sqrt(dot(r3, r3) + a2) + sqrt(dot(r4, r4) + a2);
}

/// |z - A| + |z - B| for the singularity z where the inner integral is pinched; very large if there is none. A ray
/// has infinite @p source_length.
template <class T> HWY_INLINE T pinch_sum(const Line<T> &l, const T &source_length, const Panel<T> &p, const T &a2)
{
  // Below this angle the pinch is further away than anything that matters.
  constexpr double smallest_sine2 = 1e-20, none = 1e300;
  const Vector<T> normal = cross(l.t, p.t), r = l.x1 - p.x3;
  const T sine2 = dot(normal, normal);
  const auto parallel = sine2 < T(smallest_sine2);
  const T inverse = T(1.0) / select(parallel, T(1.0), sine2);
  const T along = -(dot(cross(r, p.t), normal) * inverse);
  const T position = -(dot(cross(r, l.t), normal) * inverse), gap = dot(r, normal);
  const T height2 = (gap * gap * inverse + a2) * inverse, beyond = position - p.length;
  const T sum = sqrt(position * position + height2) + sqrt(beyond * beyond + height2);
  return select(parallel, T(none), select(along < T(0.0), T(none), select(source_length < along, T(none), sum)));
}

/// (rho + 1/rho)/2 of the panel in the field of a segment; a lower bound for distant ones. All singularities are at
/// least as far from the ends of the panel as some point of the segment is, which is a sum of 2 D - L, D being the
/// distance of the middles.
template <class T> HWY_INLINE T ellipse_of_segment(const Line<T> &l, const Panel<T> &p, const T &a2)
{
  constexpr double far = 8.0;
  const Vector<T> between = l.x1 + l.x2 - (p.x3 + p.x4);
  const T bound = (sqrt(dot(between, between)) - l.length) / p.length;
  const auto near = bound < T(far);
  if (!any(near))
    return bound;
  const T of_ends = min(distance_sum(l.x1, p, a2), distance_sum(l.x2, p, a2));
  return select(near, min(of_ends, pinch_sum(l, l.length, p, a2)) / p.length, bound);
}

template <class T> HWY_INLINE T ellipse_of_ray(const Line<T> &l, const Panel<T> &p, const T &a2)
{
  return min(distance_sum(l.x1, p, a2), pinch_sum(l, T(1e300), p, a2)) / p.length;
}
} // namespace ddfem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
