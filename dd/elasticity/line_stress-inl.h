// Integrals of powers of R_a along straight pieces of line, free of cancellation, and the stress that they make.
//
// Notation: the line is x' = foot + s t, the point x lies at distance d from it, R_a^2 = s^2 + d^2 + a^2 = s^2 + d_a^2.
// With s = d_a sinh(theta), R_a = d_a cosh(theta), T = s/R_a = tanh(theta), everything follows from
//   sinh(theta2 - theta1) = L (R1 + R2)/Q,   Q = R1 R2 + s1 s2 + d_a^2,   G = (R1 R2 - s1 s2)/d_a^2,
// where Q (if s1 s2 < 0) and G (otherwise) are rewritten by R1^2 R2^2 - s1^2 s2^2 = d_a^2 (s1^2 + s2^2 + d_a^2). All
// quantities are then sums of terms of one sign, or differences of input data.

#if defined(DDFEM_DD_ELASTICITY_LINE_STRESS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DDFEM_DD_ELASTICITY_LINE_STRESS_INL_H
#undef DDFEM_DD_ELASTICITY_LINE_STRESS_INL_H
#else
#define DDFEM_DD_ELASTICITY_LINE_STRESS_INL_H
#endif

#include "dd/elasticity/isotropic.h"
#include "dd/elasticity/line_table.h"
#include "dd/elasticity/real-inl.h"

#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace ddfem::HWY_NAMESPACE
{
/// J_mn = int s^m / R_a^n ds over the piece of line; those with n = 5 times three.
template <class T> struct StressIntegrals
{
  T j03, j13, three_j05, three_j15, three_j25;
};

/// R1, R2, and Q = q_over/q_under, G = g_over/g_under, whose divisions can wait.
template <class T> struct SegmentGeometry
{
  T s1, s2, length;
  T r1, r2, q_over, q_under, g_over, g_under;

  HWY_INLINE SegmentGeometry(const T &s1_, const T &s2_, const T &length_, const T &da2)
      : s1(s1_), s2(s2_), length(length_)
  {
    const T square1 = s1 * s1 + da2, square2 = s2 * s2 + da2, product = s1 * s2;
    r1 = sqrt(square1);
    r2 = sqrt(square2);
    const T sum = r1 * r2 + abs(product), squares = s1 * s1 + square2;
    // A point on the segment with a = 0 gives Q = 0 and infinite integrals: the field is infinite there.
    const auto beside = product < T(0.0); // the foot of the perpendicular lies between the ends
    g_over = select(beside, sum, squares);
    g_under = select(beside, da2, sum);
    q_over = select(beside, da2 * (sum + squares), sum + da2);
    q_under = select(beside, sum, T(1.0));
  }

  HWY_INLINE T j03() const { return length * (r1 + r2) * q_under / (r1 * r2 * q_over); }
  /// J_13 = 1/R1 - 1/R2.
  HWY_INLINE T j13() const { return length * (s1 + s2) / (r1 * r2 * (r1 + r2)); }
  /// J_01 = theta2 - theta1 = log1p() of this.
  HWY_INLINE T of_j01() const { return length * (r1 + r2 + length) * q_under / q_over; }
};

template <class T> HWY_INLINE StressIntegrals<T> stress_integrals(const SegmentGeometry<T> &k)
{
  const T sum = k.r1 + k.r2, inverse_product = T(1.0) / (k.r1 * k.r2);
  // One division for 1/Q and 1/(R1 + R2).
  const T scaled = k.length * inverse_product / (k.q_over * sum);
  const T j03 = scaled * (sum * sum) * k.q_under, j13 = scaled * ((k.s1 + k.s2) * k.q_over);
  const T g = k.g_over / k.g_under;
  const T i1 = k.r2 * inverse_product, i2 = k.r1 * inverse_product, squares = i1 * i1 + i2 * i2;
  const T t1 = k.s1 * i1, t2 = k.s2 * i2;
  return {j03, j13, j03 * (squares + inverse_product * g), j13 * (squares + inverse_product),
          j03 * (t1 * (t1 + t2) + t2 * t2)};
}

/// The same for points that are at least about half the length away from the segment, where nothing cancels: fewer operations.
template <class T> HWY_INLINE StressIntegrals<T> distant_stress_integrals(const T &s1, const T &length, const T &da2)
{
  const T s2 = s1 + length, square1 = s1 * s1, square2 = s2 * s2 + da2;
  const T r1 = sqrt(square1 + da2), r2 = sqrt(square2), product = r1 * r2, sum = r1 + r2,
          inverse_product = T(1.0) / product;
  const T g_under = product + s1 * s2, q = g_under + da2;
  const T scaled = length * inverse_product / (q * sum);
  const T j03 = scaled * (sum * sum), j13 = scaled * ((s1 + s2) * q);
  const T i1 = r2 * inverse_product, i2 = r1 * inverse_product, squares = i1 * i1 + i2 * i2;
  const T t1 = s1 * i1, t2 = s2 * i2;
  return {j03, j13, j03 * (squares + inverse_product * (square1 + square2) / g_under),
          j13 * (squares + inverse_product), j03 * (t1 * (t1 + t2) + t2 * t2)};
}

/// 1/(R + s) without cancellation for s < 0.
template <class T> HWY_INLINE T inverse_distance_plus_projection(const T &s, const T &r, const T &d2)
{
  const auto ahead = s < T(0.0);
  return select(ahead, r - s, T(1.0)) / select(ahead, d2, r + s);
}

/// The limit s2 -> infinity.
template <class T> HWY_INLINE StressIntegrals<T> ray_stress_integrals(const T &s, const T &da2)
{
  const T r = sqrt(s * s + da2), i = T(1.0) / r, t = s * i;
  const T k = inverse_distance_plus_projection(s, r, da2);
  const T j03 = i * k;
  return {j03, i, j03 * i * (i + k), i * i * i, j03 * (t * t + t + T(1.0))};
}

/// A segment, or a ray (length and second end without meaning).
template <class T> struct Line
{
  Vector<T> x1, x2, t, b, e;
  T length;
};

/// Line @p i of a table in every lane (Real) or alone (double).
template <class T> HWY_INLINE Line<T> line_of(const LineTable &lines, const std::size_t i)
{
  const double *const p = lines.line(i);
  const auto row = [&](const std::size_t r) HWY_ATTR { return T(p[r * LineTable::block_size]); };
  const auto vector = [&](const std::size_t r) HWY_ATTR { return Vector<T>{row(r), row(r + 1), row(r + 2)}; };
  return {vector(LineTable::first_end), vector(LineTable::second_end), vector(LineTable::direction),
          vector(LineTable::burgers),   vector(LineTable::edge),       row(LineTable::length)};
}

/// As many lines of a block as there are lanes, from number @p offset on.
HWY_INLINE Line<Real> lines_of(const LineTable::Block &block, const std::size_t offset)
{
  const auto row = [&](const std::size_t r) HWY_ATTR { return Real::load(&block.value[r][offset]); };
  const auto vector = [&](const std::size_t r) HWY_ATTR { return Vector<Real>{row(r), row(r + 1), row(r + 2)}; };
  return {vector(LineTable::first_end), vector(LineTable::second_end), vector(LineTable::direction),
          vector(LineTable::burgers),   vector(LineTable::edge),       row(LineTable::length)};
}

/// What all lines share; stresses below are in units of mu/(4 pi).
template <class T> struct StressConstants
{
  T a2, m; ///< nm^2; 1/(1-nu)

  explicit HWY_INLINE StressConstants(const IsotropicMedium &medium)
      : a2(medium.a * medium.a), m(1.0 / (1.0 - medium.nu))
  {
  }
};

/// sigma = t v + v t + d w + w d + p I in units of mu/(4 pi): the formula at the top of segment_stress.h with R = d - s t
/// inserted (R x b = d x b + s e, R.e = d.e), d the vector from the line to the point.
template <class T> struct StressTerms
{
  Vector<T> d, v, w;
  T p;
};

template <class T>
HWY_INLINE StressTerms<T> stress_terms(const StressConstants<T> &c, const Line<T> &l, const StressIntegrals<T> &j,
                                       const Vector<T> &d)
{
  const T de = c.m * dot(d, l.e), half_a2 = T(0.5) * c.a2, half_de = T(0.5) * de, m_j03 = c.m * j.j03;
  const T of_cross = j.j03 + half_a2 * j.three_j05, of_e = (c.m - T(1.0)) * j.j13 - half_a2 * j.three_j15;
  const T of_d = de * j.three_j15, of_t = half_de * j.three_j25, d_in_w = half_de * j.three_j05;
  return {d, of_e * l.e + of_t * l.t - of_cross * cross(d, l.b) - of_d * d, d_in_w * d - m_j03 * l.e,
          de * (j.j03 + c.a2 * j.three_j05)};
}

/// Of a segment at @p x.
template <class T>
HWY_INLINE StressTerms<T> segment_stress_terms(const StressConstants<T> &c, const Line<T> &l, const Vector<T> &x)
{
  const Vector<T> p = l.x1 - x, q = l.x2 - x;
  const T s1 = dot(p, l.t), s2 = dot(q, l.t);
  // The perpendicular is taken from the nearer end: its rounding error is then relative to the smaller distance.
  const auto first_nearer = abs(s1) < abs(s2);
  const Vector<T> d = select(first_nearer, s1, s2) * l.t - select(first_nearer, p, q);
  return stress_terms(c, l, stress_integrals(SegmentGeometry<T>(s1, s2, l.length, dot(d, d) + c.a2)), d);
}

/// Of a segment at a point that is at least about half its length away.
template <class T>
HWY_INLINE StressTerms<T> distant_stress_terms(const StressConstants<T> &c, const Line<T> &l, const Vector<T> &x)
{
  const Vector<T> p = l.x1 - x;
  const T s = dot(p, l.t);
  const Vector<T> d = s * l.t - p;
  return stress_terms(c, l, distant_stress_integrals(s, l.length, dot(d, d) + c.a2), d);
}

/// Of a ray at @p x.
template <class T>
HWY_INLINE StressTerms<T> ray_stress_terms(const StressConstants<T> &c, const Line<T> &l, const Vector<T> &x)
{
  const Vector<T> p = l.x1 - x;
  const T s = dot(p, l.t);
  const Vector<T> d = s * l.t - p;
  return stress_terms(c, l, ray_stress_integrals(s, dot(d, d) + c.a2), d);
}

/// A symmetric tensor.
template <class T> struct Tensor
{
  T xx, yy, zz, xy, xz, yz;
};

/// Sum of stresses in units of mu/(4 pi).
template <class T> struct StressSum
{
  T half_xx, half_yy, half_zz, xy, xz, yz;

  HWY_INLINE void add(const StressTerms<T> &s, const Vector<T> &t)
  {
    const Vector<T> &d = s.d, &v = s.v, &w = s.w;
    const T half_p = T(0.5) * s.p;
    // One after the other, so that each is a product added to the sum.
    half_xx = half_xx + half_p + t.x * v.x + d.x * w.x;
    half_yy = half_yy + half_p + t.y * v.y + d.y * w.y;
    half_zz = half_zz + half_p + t.z * v.z + d.z * w.z;
    xy = xy + t.x * v.y + t.y * v.x + d.x * w.y + d.y * w.x;
    xz = xz + t.x * v.z + t.z * v.x + d.x * w.z + d.z * w.x;
    yz = yz + t.y * v.z + t.z * v.y + d.y * w.z + d.z * w.y;
  }

  /// MPa.
  HWY_INLINE Tensor<T> tensor(const IsotropicMedium &medium) const
  {
    const T unit(medium.mu / (4.0 * std::numbers::pi)), twice = unit + unit;
    return {twice * half_xx, twice * half_yy, twice * half_zz, unit * xy, unit * xz, unit * yz};
  }
};

/// One stress, MPa.
template <class T>
HWY_INLINE Tensor<T> stress_of(const IsotropicMedium &medium, const StressTerms<T> &s, const Vector<T> &t)
{
  StressSum<T> sum{};
  sum.add(s, t);
  return sum.tensor(medium);
}

/// sigma . n.
template <class T> HWY_INLINE Vector<T> traction(const StressTerms<T> &s, const Vector<T> &t, const Vector<T> &n)
{
  return dot(s.v, n) * t + dot(t, n) * s.v + dot(s.w, n) * s.d + dot(s.d, n) * s.w + s.p * n;
}
} // namespace ddfem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
