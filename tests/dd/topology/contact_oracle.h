// First contacts by branch and bound in extended precision, without polynomials; random pairs of moving segments.
#pragma once

#include "dd/topology/collisions/contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

namespace ddfem::contact_oracle
{
using Real = long double;
using Point = Eigen::Matrix<Real, 3, 1>;

/// The shortest vector between two segments p, p + u and q, q + v (Ericson, Real-Time Collision Detection, 5.1.9).
/// For the nearly parallel, whose stationary point is rounding, from the ends of the first segment also.
inline Point separation(const Point &p, const Point &u, const Point &q, const Point &v)
{
  const Point w = p - q;
  const Real uu = u.squaredNorm(), vv = v.squaredNorm(), vw = v.dot(w), uw = u.dot(w), uv = u.dot(v);
  const auto ratio = [](const Real a, const Real b) { return b > 0 ? std::clamp<Real>(a / b, 0, 1) : Real(0); };
  const auto from = [&](const Real s_of_line)
  {
    const Real t = ratio(uv * s_of_line + vw, vv), s = ratio(uv * t - uw, uu);
    return Point(q + t * v - p - s * u);
  };
  Point shortest = from(ratio(uv * vw - uw * vv, uu * vv - uv * uv));
  for (const Point &x : {from(0), from(1)})
    if (x.squaredNorm() < shortest.squaredNorm())
      shortest = x;
  return shortest;
}

/// The four ends of a pair at a time: start and end of a, start and end of b, seen from the start of a.
struct Ends
{
  Point a0, a1, b0, b1;

  Ends(const MovingSegment &a, const MovingSegment &b, const Real t)
  {
    const auto at = [&](const Vec3 &x, const Vec3 &v)
    { return Point((x - a.start).cast<Real>() + t * (v - a.start_velocity).cast<Real>()); };
    a0 = Point::Zero();
    a1 = at(a.end, a.end_velocity);
    b0 = at(b.start, b.start_velocity);
    b1 = at(b.end, b.end_velocity);
  }
  Point separation() const { return contact_oracle::separation(a0, a1 - a0, b0, b1 - b0); }
  /// How far the segments are apart at least, by their projections on the unit vector n.
  Real apart(const Point &n) const { return std::min(n.dot(b0), n.dot(b1)) - std::max(n.dot(a0), n.dot(a1)); }
};

inline Real distance(const MovingSegment &a, const MovingSegment &b, const Real t)
{
  return Ends(a, b, t).separation().norm();
}

/// A time in [t0, t1] at which the distance is no more than @p level, and before which it is not below
/// (1 - @p slack) level, or -1 if it is nowhere below that. On an interval the distance is at least that of the
/// projections on any direction at the two ends, because projections of ends are linear in time.
inline Real first_within(const MovingSegment &a, const MovingSegment &b, const Real level, const Real slack,
                         const Real t0, const Real t1, const Real width = 1e-10L)
{
  if (distance(a, b, t0) <= level)
    return t0;
  const std::function<Real(Real, Real)> search = [&](const Real left, const Real right) -> Real
  {
    const Real middle = (left + right) / 2;
    const Point x = Ends(a, b, middle).separation();
    const Real d = x.norm();
    if (d > 0)
    {
      const Point n = x / d;
      if (std::min(Ends(a, b, left).apart(n), Ends(a, b, right).apart(n)) > (1 - slack) * level)
        return -1;
    }
    if (right - left < width)
      return d <= level ? middle : -1;
    const Real found = search(left, middle);
    if (found >= 0)
      return found;
    return d <= level ? middle : search(middle, right);
  };
  const Real found = search(t0, t1);
  return found < 0 && distance(a, b, t1) <= level ? t1 : found;
}

/// Smallest distance in [t0, t1], to 1e-4 of itself; zero if it is below @p least.
inline Real smallest_distance(const MovingSegment &a, const MovingSegment &b, const Real t0, const Real t1,
                              const Real least)
{
  Real best = std::min(distance(a, b, t0), distance(a, b, t1));
  const std::function<void(Real, Real)> search = [&](const Real left, const Real right)
  {
    const Real middle = (left + right) / 2;
    const Point x = Ends(a, b, middle).separation();
    const Real d = x.norm();
    best = std::min(best, d);
    if (best < least)
      return;
    if (std::min(Ends(a, b, left).apart(x / d), Ends(a, b, right).apart(x / d)) > best * (1 - 1e-4L))
      return;
    search(left, middle);
    search(middle, right);
  };
  search(t0, t1);
  return best < least ? 0 : best;
}

/// Random pairs. Lengths are about 40, displacements 0.01 to 80, and the pairs come within a few units: the radius is
/// about 1.
class RandomPairs
{
public:
  explicit RandomPairs(const unsigned seed) : random_(seed) {}

  double uniform(const double a, const double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  double log_uniform(const double a, const double b) { return std::exp(uniform(std::log(a), std::log(b))); }
  Vec3 vector()
  {
    std::normal_distribution<double> normal;
    const double x = normal(random_), y = normal(random_);
    return {x, y, normal(random_)};
  }
  Vec3 direction() { return vector().normalized(); }

  /// Segments along the given vectors that at time @p t have points at random fractions (a third of them ends)
  /// separated by
  /// @p gap, with the given velocities of their ends.
  std::pair<MovingSegment, MovingSegment> meeting(const Vec3 &u, const Vec3 &v, const Vec3 &gap, const double t,
                                                  const std::array<Vec3, 4> &velocity)
  {
    const auto fraction = [&] { return std::clamp(uniform(-0.25, 1.25), 0.0, 1.0); };
    const Vec3 a = -fraction() * u, b = gap - fraction() * v;
    return {MovingSegment{a - t * velocity[0], a + u - t * velocity[1], velocity[0], velocity[1]},
            MovingSegment{b - t * velocity[2], b + v - t * velocity[3], velocity[2], velocity[3]}};
  }
  std::array<Vec3, 4> velocities(const double size)
  {
    const Vec3 a = vector(), b = vector(), c = vector();
    return {size * a, size * b, size * c, size * vector()};
  }
  std::pair<MovingSegment, MovingSegment> generic()
  {
    const Vec3 u = uniform(5, 60) * direction(), v = uniform(5, 60) * direction();
    return meeting(u, v, uniform(0, 4) * direction(), uniform(0, 1.2), velocities(log_uniform(0.01, 80)));
  }

private:
  std::mt19937_64 random_;
};
} // namespace ddfem::contact_oracle
