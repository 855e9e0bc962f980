// Solid angle and displacement of a triangular loop (see triangle_displacement.h), for one point or a vector of them.

#if defined(DDFEM_DD_ELASTICITY_TRIANGLE_DISPLACEMENT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DDFEM_DD_ELASTICITY_TRIANGLE_DISPLACEMENT_INL_H
#undef DDFEM_DD_ELASTICITY_TRIANGLE_DISPLACEMENT_INL_H
#else
#define DDFEM_DD_ELASTICITY_TRIANGLE_DISPLACEMENT_INL_H
#endif

#include "dd/elasticity/line_stress-inl.h"
#include "dd/elasticity/triangular_loop.h"

#include <cmath>
#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace ddfem::HWY_NAMESPACE
{
using std::atan2;
using std::log;
using std::log1p;

HWY_INLINE Real log(const Real &x)
{
  Real z;
  for (std::size_t i = 0; i < n_registers; ++i)
    z.v[i] = hn::Log(Lanes(), x.v[i]);
  return z;
}
HWY_INLINE Real log1p(const Real &x)
{
  Real z;
  for (std::size_t i = 0; i < n_registers; ++i)
    z.v[i] = hn::Log1p(Lanes(), x.v[i]);
  return z;
}
HWY_INLINE Real atan2(const Real &y, const Real &x)
{
  const Real ay = abs(y), ax = abs(x), larger = max(ay, ax), zero(0.0);
  const Real tangent = min(ay, ax) / select(zero < larger, larger, Real(1.0));
  Real small;
  for (std::size_t i = 0; i < n_registers; ++i)
    small.v[i] = hn::Atan(Lanes(), tangent.v[i]);
  const Real first = select(ax < ay, Real(std::numbers::pi / 2) - small, small);
  Real angle = select(x < zero, Real(std::numbers::pi) - first, first);
  for (std::size_t i = 0; i < n_registers; ++i)
    angle.v[i] = hn::CopySign(angle.v[i], y.v[i]);
  return angle;
}

/// Squared distance (relative to the squared distance of the nearest vertex, or nm^2 at a vertex) at which the
/// logarithm is cut off on an edge.
constexpr double tiny2 = 1e-28;

/// A vertex seen from x: relative position and its length, or the direction and one.
template <class T> struct SeenVertex
{
  Vector<T> r;
  T norm;

  HWY_INLINE SeenVertex(const LoopVertex &v, const Vector<T> &x)
      : r(v.at_infinity ? vector_of<T>(v.value) : vector_of<T>(v.value) - x),
        norm(v.at_infinity ? T(1.0) : sqrt(dot(r, r)))
  {
  }
};

/// The triple product of the edges keeps all digits where the three directions are nearly equal.
template <class T>
HWY_INLINE T solid_angle_of(const SeenVertex<T> &v1, const SeenVertex<T> &v2, const SeenVertex<T> &v3,
                            const Vector<T> &normal)
{
  const T denominator =
      v1.norm * v2.norm * v3.norm + dot(v1.r, v2.r) * v3.norm + dot(v2.r, v3.r) * v1.norm + dot(v3.r, v1.r) * v2.norm;
  return T(2.0) * atan2(dot(v1.r, normal), denominator);
}

/// What an edge adds: log = ln[(R_B + R_B.t)/(R_A + R_A.t)] (Barnett's f = log b x t), and his
/// g = [b.(l_A x l_B)] (l_A + l_B)/(1 + l_A.l_B).
template <class T> struct EdgeTerms
{
  T log;
  Vector<T> g;
};

/// With d the vector from x to the foot of the perpendicular, l_A x l_B = L d x t/(R_A R_B) and
/// 1 + l_A.l_B = Q/(R_A R_B): neither log nor g is a quotient of small differences any more.
template <class T>
HWY_INLINE EdgeTerms<T> finite_edge(const TriangularLoop::Edge &edge, const Vector<T> &a, const Vector<T> &b)
{
  const Vector<T> t = vector_of<T>(edge.t);
  const T s1 = dot(a, t), s2 = dot(b, t), length(edge.length);
  const auto first_nearer = abs(s1) < abs(s2);
  const Vector<T> d = select(first_nearer, a, b) - select(first_nearer, s1, s2) * t;
  const SegmentGeometry<T> k(s1, s2, length, dot(d, d) + T(tiny2 * edge.length * edge.length));
  const T sum = k.r1 + k.r2;
  const T volume = -(length * dot(d, vector_of<T>(edge.b_cross_t)) / (k.r1 * k.r2));
  return {log1p(k.of_j01()), volume * ((sum * k.q_under / k.q_over) * d + ((s1 + s2) / sum) * t)};
}

/// Edge to infinity: the limit of finite_edge() without the infinite constant 2 L.
template <class T>
HWY_INLINE EdgeTerms<T> ray_edge(const TriangularLoop::Edge &edge, const SeenVertex<T> &a, const T &reference_length)
{
  const Vector<T> t = vector_of<T>(edge.t);
  const T s = dot(a.r, t), zero(0.0);
  const Vector<T> d = a.r - s * t;
  const T da2 = dot(d, d) + T(tiny2) * select(zero < a.norm, a.norm * a.norm, T(1.0));
  const T r = sqrt(s * s + da2), inverse = inverse_distance_plus_projection(s, r, da2);
  const T volume = -(dot(d, vector_of<T>(edge.b_cross_t)) / r);
  return {log(inverse * reference_length), volume * (inverse * d + t)};
}

/// Barnett's sum; with the sign of solid_angle(), opposite to his, the jump term is + Omega b/(4 pi).
template <class T>
HWY_INLINE Vector<T> displacement_of(const double nu, const TriangularLoop &loop, const double reference_length,
                                     const Vector<T> &x)
{
  const SeenVertex<T> seen[3] = {{loop.vertices[0], x}, {loop.vertices[1], x}, {loop.vertices[2], x}};
  const T zero(0.0);
  Vector<T> f{zero, zero, zero}, g{zero, zero, zero};
  for (const TriangularLoop::Edge &edge : loop.edges)
  {
    if (edge.sign == 0.0)
      continue;
    const EdgeTerms<T> terms = edge.length > 0.0 ? finite_edge(edge, seen[edge.from].r, seen[edge.to].r)
                                                 : ray_edge(edge, seen[edge.from], T(reference_length));
    f += (T(edge.sign) * terms.log) * vector_of<T>(edge.b_cross_t);
    g += T(edge.sign) * terms.g;
  }
  const T omega = solid_angle_of(seen[0], seen[1], seen[2], vector_of<T>(loop.normal));
  const double factor = 1.0 / (8.0 * std::numbers::pi * (1.0 - nu));
  return (T(1.0 / (4.0 * std::numbers::pi)) * omega) * vector_of<T>(loop.burgers) - T(factor * (1.0 - 2.0 * nu)) * f +
         T(factor) * g;
}
} // namespace ddfem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
