// Polynomials in time that fall through zero where the distance of two features (ends, lines) of moving segments
// falls to a level.
#pragma once

#include "dd/topology/collisions/bernstein.h"
#include "dd/topology/collisions/contact.h"

namespace ddfem::distance_polynomials
{
/// Lengths, or widths of a crossing, below this fraction of the level are left to other features.
inline constexpr double negligible_extent = 1e-2;

/// A vector that is linear in time.
struct LinearVector
{
  Vec3 at_zero, rate;

  Vec3 operator()(const double t) const { return at_zero + t * rate; }
};

inline LinearVector operator+(const LinearVector &a, const LinearVector &b)
{
  return {a.at_zero + b.at_zero, a.rate + b.rate};
}

inline LinearVector operator-(const LinearVector &a, const LinearVector &b)
{
  return {a.at_zero - b.at_zero, a.rate - b.rate};
}

inline LinearVector line(const MovingSegment &a)
{
  return {a.end - a.start, a.end_velocity - a.start_velocity};
}

inline constexpr auto dot = [](const Vec3 &a, const Vec3 &b) { return a.dot(b); };
inline constexpr auto cross = [](const Vec3 &a, const Vec3 &b) -> Vec3 { return a.cross(b); };
inline constexpr auto multiply = [](const double a, const double b) { return a * b; };
inline constexpr std::array<double, 3> one = {1, 1, 1};

/// Squared distance of a point from a line minus the squared level, times the squared length of the line.
struct PointLine
{
  LinearVector line, point; ///< the line from its first end, the point seen from there
  double level2;

  std::array<double, 5> coefficients(const double a, const double b) const
  {
    const std::array<Vec3, 2> e = {line(a), line(b)}, w = {point(a), point(b)};
    const auto c = bernstein_product(e, w, cross);
    auto result = bernstein_product(c, c, dot);
    const auto length2 = bernstein_product(bernstein_product(e, e, dot), one, multiply);
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] -= level2 * length2[i];
    return result;
  }
  double value(const double t) const
  {
    const Vec3 e = line(t);
    return e.cross(point(t)).squaredNorm() - level2 * e.squaredNorm();
  }
  bool covered(const double a, const double b) const
  {
    return std::max(line(a).squaredNorm(), line(b).squaredNorm()) <= negligible_extent * negligible_extent * level2;
  }
};

/// Squared distance of two lines minus the squared level, times the squared product of lengths and sine of the angle.
struct LineLine
{
  LinearVector p12, p34, p13;
  double level2;

  std::array<Vec3, 3> normal(const double a, const double b) const
  {
    return bernstein_product(std::array<Vec3, 2>{p12(a), p12(b)}, std::array<Vec3, 2>{p34(a), p34(b)}, cross);
  }
  std::array<double, 7> coefficients(const double a, const double b) const
  {
    const auto n = normal(a, b);
    const auto det = bernstein_product(std::array<Vec3, 2>{p13(a), p13(b)}, n, dot);
    auto result = bernstein_product(det, det, multiply);
    const auto normal2 = bernstein_product(bernstein_product(n, n, dot), one, multiply);
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] -= level2 * normal2[i];
    return result;
  }
  double value(const double t) const
  {
    const Vec3 n = p12(t).cross(p34(t));
    const double det = p13(t).dot(n);
    return det * det - level2 * n.squaredNorm();
  }
  bool covered(const double a, const double b) const
  {
    // |normal| / (longer length) = shorter length times the sine of the angle. Norms are bounded by the coefficients.
    const auto shortest2 = [&](const LinearVector &p)
    {
      const Vec3 pa = p(a), pb = p(b);
      return std::max(0.0, std::min({pa.squaredNorm(), pa.dot(pb), pb.squaredNorm()}));
    };
    const auto n = normal(a, b);
    const double largest2 = std::max({n[0].squaredNorm(), n[1].squaredNorm(), n[2].squaredNorm()});
    return largest2 <= negligible_extent * negligible_extent * level2 * std::max(shortest2(p12), shortest2(p34));
  }
};

/// Time in [t0, t1] at which |x| falls to @p level, if it does; |x(t0)| > level.
inline std::optional<double> time_of_entry(const LinearVector &x, const double level, const double t0, const double t1)
{
  const Vec3 p = x(t0);
  const double b = p.dot(x.rate), distance = p.norm();
  const double discriminant = level * level * x.rate.squaredNorm() - p.cross(x.rate).squaredNorm();
  if (b >= 0 || discriminant < 0)
    return std::nullopt;
  const double t = t0 + (distance - level) * (distance + level) / (std::sqrt(discriminant) - b);
  return t <= t1 ? std::optional(t) : std::nullopt;
}
} // namespace ddfem::distance_polynomials
