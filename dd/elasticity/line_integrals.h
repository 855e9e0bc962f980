// Integrals of powers of R_a along straight pieces of line, free of cancellation. Internal to dd/elasticity.
//
// Notation: the line is x' = foot + s t, the point x lies at distance d from it, R_a^2 = s^2 + d^2 + a^2 = s^2 + d_a^2.
// With s = d_a sinh(theta), R_a = d_a cosh(theta), T = s/R_a = tanh(theta), everything follows from
//   sinh(theta2 - theta1) = L (R1 + R2)/Q,   Q = R1 R2 + s1 s2 + d_a^2,
// where Q itself is rewritten by R1^2 R2^2 - s1^2 s2^2 = d_a^2 (s1^2 + s2^2 + d_a^2) if s1 s2 < 0. All quantities are
// then sums of terms of one sign, or differences of input data.
#pragma once

#include <cmath>

namespace ddfem::internal
{
/// J_mn = int s^m / R_a^n ds over the piece of line.
struct StressIntegrals
{
  double j03, j13, j05, j15, j25;
};

/// R1, R2 and the well-conditioned combinations Q and G = (R1 R2 - s1 s2)/d_a^2.
struct SegmentGeometry
{
  double s1, s2, length, da2;
  double r1, r2, q, g;

  SegmentGeometry(double s1_, double s2_, double length_, double da2_)
      : s1(s1_), s2(s2_), length(length_), da2(da2_), r1(std::sqrt(s1_ * s1_ + da2_)), r2(std::sqrt(s2_ * s2_ + da2_))
  {
    const double product = s1 * s2;
    const double sum = r1 * r2 + std::abs(product);
    // A point on the segment with a = 0 gives q = 0 and infinite integrals: the field is infinite there.
    const bool beside = product < 0.0; // the foot of the perpendicular lies between the ends
    const double numerator = beside ? sum : s1 * s1 + s2 * s2 + da2;
    g = numerator / (beside ? da2 : sum);
    q = beside ? da2 * (1.0 + (s1 * s1 + s2 * s2 + da2) / sum) : sum + da2;
  }

  /// J_03.
  double j03() const { return length * (r1 + r2) / (r1 * r2 * q); }
  /// J_13 = 1/R1 - 1/R2.
  double j13() const { return length * (s1 + s2) / (r1 * r2 * (r1 + r2)); }
  /// J_01 = theta2 - theta1.
  double j01() const { return std::log1p(length * (r1 + r2 + length) / q); }
};

inline StressIntegrals stress_integrals(const SegmentGeometry &k)
{
  const double inverse_product = 1.0 / (k.r1 * k.r2);
  const double i1 = k.r2 * inverse_product, i2 = k.r1 * inverse_product;
  const double sum = k.r1 + k.r2;
  const double t1 = k.s1 * i1, t2 = k.s2 * i2;
  // One division for both 1/q and 1/sum.
  const double scaled = k.length * inverse_product / (k.q * sum);
  const double j03 = scaled * sum * sum, j13 = scaled * (k.s1 + k.s2) * k.q;
  return {j03, j13, j03 * (i1 * i1 + i2 * i2 + inverse_product * k.g) * (1.0 / 3.0),
          j13 * (i1 * i1 + inverse_product + i2 * i2) * (1.0 / 3.0), j03 * (t1 * t1 + t1 * t2 + t2 * t2) * (1.0 / 3.0)};
}

/// R + s without cancellation for s < 0.
inline double distance_plus_projection(double s, double r, double d2)
{
  return s >= 0.0 ? r + s : d2 / (r - s);
}

/// The limit s2 -> infinity.
inline StressIntegrals ray_stress_integrals(double s, double da2)
{
  const double r = std::sqrt(s * s + da2);
  const double i = 1.0 / r, t = s * i;
  const double k = 1.0 / distance_plus_projection(s, r, da2);
  const double j03 = i * k;
  return {j03, i, j03 * i * (i + k) * (1.0 / 3.0), i * i * i * (1.0 / 3.0), j03 * (t * t + t + 1.0) * (1.0 / 3.0)};
}
} // namespace ddfem::internal
