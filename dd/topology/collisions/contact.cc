// Roots of distance polynomials: extends annex B.1 of A. Durocher's thesis (OptiDis), where |P12(t)| is
// taken as constant and only the minima of the distance are looked for.
//
// All ends move straight, so the differences of their positions are linear in time, and the distance between two
// features falls to the level R where a polynomial falls through zero:
//   end, end         |p(t)|^2 - R^2                                 degree 2
//   end, line        |P12 x P13|^2 - R^2 |P12|^2                    degree 4
//   line, line       det(P13, P12, P34)^2 - R^2 |P12 x P34|^2       degree 6
// The distance of the segments is at any time that of one of these pairs of features, therefore the first time at
// which it is R is a root of one of the polynomials. A root counts if the distance of the segments is then no more
// than R: there are no false contacts, whatever the rounding.
//
// Why nothing is missed. The last two polynomials vanish identically, or to rounding, where a line has no length or
// two lines are parallel. They are not asked there, because another feature is as near to within a fraction of
// contact_margin:
// - The foot of an end on a line of length l is within l/2 of an end of that line: if d is the distance from the
//   line, there are two ends within sqrt(d^2 + l^2/4).
// - Two lines that cross (seen along their common normal) within both segments at the angle theta: go from the
//   crossing along both until the first of the two ends at, say, the length x from the crossing, x <= l, the shorter
//   length. Its foot is x cos(theta) from the crossing, thus within the other segment, and its distance from it is
//   sqrt(d^2 + x^2 sin^2(theta)) <= sqrt(d^2 + l^2 sin^2(theta)).
// Lines with l or l sin(theta) below negligible_extent * R are covered in this sense, with d wrong by 5e-5 R at most.
// Elsewhere the rounding of the positions, eps X for segments and displacements of extent X, changes the distance of
// two lines that the polynomial implies by some eps X / sin(theta) < eps X l / (0.01 R): 2e-4 R for X = l = 1e5 R.
// Coefficients are formed anew on each interval in which roots are looked for, or they would be wrong by eps times
// the largest value of the polynomial in the whole step. A root that is spurious by that much is caught by a second
// search (see Search::run).
#include "dd/topology/collisions/contact.h"

#include "dd/elasticity/distance.h"
#include "dd/topology/collisions/bernstein.h"
#include "dd/topology/collisions/distance_polynomials.h"

#include <limits>

namespace ddfem
{
namespace
{
using namespace distance_polynomials;

/// The polynomials are solved for levels below R by these fractions, so that the distance at a root is safely within R.
constexpr double fine_shift = 1e-8, coarse_shift = contact_margin / 2;
/// Roots at which the distance exceeds R by no more than this fraction may be off by rounding.
constexpr double near_miss = contact_margin / 10;

/// What d must fall to, for the distance d at the start of the interval.
double level_of_contact(const double d, const double radius)
{
  const double reach = (1 + contact_margin) * radius;
  return d > reach ? reach : (1 - contact_margin) * d;
}

/// The first time at which a distance d(t) falls to @p level, from roots that are offered in any order.
template <class Distance> struct Search
{
  const Distance &d;
  double level, t0, t1;             ///< d(t0) > level
  double resolution, tolerance;     ///< of roots in time
  double first = infinity;          ///< earliest time known with d <= level
  double first_doubtful = infinity; ///< earliest root rejected by what may be rounding

  static constexpr double infinity = std::numeric_limits<double>::infinity();

  Search(const Distance &d_, const double level_, const double t0_, const double t1_, const double travel)
      : d(d_), level(level_), t0(t0_), t1(t1_), resolution(1e-7 * level / travel),
        tolerance(std::max(1e-11 * level / travel, 1e-15 * std::max(std::abs(t0), std::abs(t1))))
  {
  }

  double latest() const { return std::min(first, t1); }

  bool offer(const double t)
  {
    const double distance = d(t);
    if (distance <= level)
      first = std::min(first, t);
    else if (distance <= (1 + near_miss) * level)
      first_doubtful = std::min(first_doubtful, t);
    return distance <= level;
  }

  template <class Polynomial> void offer_roots_of(const Polynomial &p)
  {
    visit_falling_roots(p, t0, latest(), resolution, tolerance, [&](const double t) { return offer(t); });
  }

  /// The search: @p offer_all offers all times at which some feature falls to the level that it is given.
  template <class OfferAll> std::optional<double> run(const OfferAll &offer_all)
  {
    offer_all((1 - fine_shift) * level);
    // Rounding may have put a root a little early, and there may be no other.
    if (first_doubtful < latest())
      offer_all((1 - coarse_shift) * level);
    if (first == infinity && !offer(t1))
      return std::nullopt;
    // Later than d = level by a covered feature, the coarse level or the end of the interval.
    const auto above = [&](const double t) { return d(t) - level; };
    return d(first) < (1 - 2 * fine_shift) * level ? falling_root(above, t0, first, tolerance) : first;
  }
};

/// End of the approach that begins at time @p t: first local minimum of d(t) in [t, t1].
template <class Distance>
double end_of_approach(const Distance &d, const double t, const double t1, const double radius, const double travel,
                       const double duration)
{
  // d changes by a fraction of the radius in a step. Once it vanishes to rounding, it is at its minimum.
  const double step = std::max(0.25 * radius / travel, (t1 - t) / 256);
  const auto floored = [&](const double s) { return std::max(d(s), 1e-9 * radius); };
  return first_local_minimum(floored, t, t1, step, std::max(1e-7 * duration, 1e-15 * std::abs(t1)));
}

/// Two segments seen from the start of the first.
struct RelativePair
{
  LinearVector p12, p34, p13;

  RelativePair(const MovingSegment &a, const MovingSegment &b)
      : p12(line(a)), p34(line(b)), p13{b.start - a.start, b.start_velocity - a.start_velocity}
  {
  }

  PairDistance nearest(const double t) const
  {
    const Vec3 x3 = p13(t);
    return distance_segment_segment(Vec3::Zero(), p12(t), x3, x3 + p34(t));
  }
  double distance(const double t) const { return std::sqrt(nearest(t).squared); }

  std::array<LinearVector, 4> ends_from_ends() const
  {
    const LinearVector p23 = p13 - p12;
    return {p13, p13 + p34, p23, p23 + p34};
  }

  /// Greatest relative displacement of ends per unit of time: no distance changes faster.
  double travel() const
  {
    double largest2 = 0;
    for (const LinearVector &p : ends_from_ends())
      largest2 = std::max(largest2, p.rate.squaredNorm());
    return std::sqrt(largest2);
  }

  /// Whether balls around the middles that contain the segments at all times stay apart by @p reach.
  bool balls_stay_apart(const double reach, const double t0, const double t1) const
  {
    const Vec3 a0 = p12(t0), a1 = p12(t1), b0 = p34(t0), b1 = p34(t1);
    const Vec3 c0 = p13(t0) + 0.5 * (b0 - a0), c1 = p13(t1) + 0.5 * (b1 - a1);
    const double radius_a = 0.5 * std::sqrt(std::max(a0.squaredNorm(), a1.squaredNorm()));
    const double radius_b = 0.5 * std::sqrt(std::max(b0.squaredNorm(), b1.squaredNorm()));
    const double apart = radius_a + radius_b + reach;
    return distance_point_segment(Vec3::Zero(), c0, c1).squared > apart * apart;
  }

  /// A time before which the segments do not come within @p reach, from their nearest points at time @p t: along the
  /// line through these points the ends of the two move straight, and as long as they are apart by more so are the
  /// segments.
  double earliest_within(const double reach, const double t, const PairDistance &nearest) const
  {
    const Vec3 u = (p13(t) + nearest.second * p34(t) - nearest.first * p12(t)).normalized();
    double earliest = std::numeric_limits<double>::infinity();
    for (const LinearVector &p : ends_from_ends())
    {
      const double rate = u.dot(p.rate), gap = u.dot(p(t)) - reach;
      if (gap <= 0)
        return t;
      if (rate < 0)
        earliest = std::min(earliest, t - gap / rate);
    }
    return earliest;
  }

  template <class Search> void offer_all(Search &search, const double level) const
  {
    for (const LinearVector &p : ends_from_ends())
      if (const auto t = time_of_entry(p, level, search.t0, search.latest()))
        search.offer(*t);
    const LinearVector p14 = p13 + p34, p31{-p13.at_zero, -p13.rate};
    const double level2 = level * level;
    for (const PointLine &p : {PointLine{p12, p13, level2}, PointLine{p12, p14, level2}, PointLine{p34, p31, level2},
                               PointLine{p34, p31 + p12, level2}})
      search.offer_roots_of(p);
    search.offer_roots_of(LineLine{p12, p34, p13, level2});
  }
};

/// Two arms of a node seen from there.
struct Arms
{
  LinearVector p, q;

  /// Distance of the end of one arm from the other arm, the smaller of the two, for arms that make an acute angle: it
  /// is the shorter arm whose end is nearer, with the foot |shorter| cos(angle) within the longer.
  double distance(const double t) const
  {
    const Vec3 x = p(t), y = q(t);
    const double longer2 = std::max(x.squaredNorm(), y.squaredNorm());
    return longer2 > 0 ? std::sqrt(x.cross(y).squaredNorm() / longer2) : 0.0;
  }

  Contact contact(const double t) const
  {
    const Vec3 x = p(t), y = q(t);
    const double x2 = x.squaredNorm(), y2 = y.squaredNorm(), longer2 = std::max(x2, y2);
    const double foot = longer2 > 0 ? std::clamp(x.dot(y) / longer2, 0.0, 1.0) : 1.0;
    return {t, x2 <= y2 ? 1.0 : foot, x2 <= y2 ? foot : 1.0, distance(t), t};
  }

  /// t0, the times in between at which the angle is right, and t1.
  std::array<double, 4> turning_times(const double t0, const double t1) const
  {
    const Vec3 x = p(t0), y = q(t0);
    const double a = p.rate.dot(q.rate), half_b = 0.5 * (x.dot(q.rate) + y.dot(p.rate)), c = x.dot(y);
    const double discriminant = half_b * half_b - a * c;
    if (discriminant < 0)
      return {t0, t0, t0, t1};
    const double sum = -half_b - std::copysign(std::sqrt(discriminant), half_b);
    const auto inside = [&](const double num, const double den)
    { return den != 0 ? std::clamp(t0 + num / den, t0, t1) : t0; };
    std::array<double, 4> times = {t0, inside(sum, a), inside(c, sum), t1};
    std::sort(times.begin(), times.end());
    return times;
  }

  /// First contact in [t0, t1], in which the angle is acute.
  std::optional<Contact> contact_while_acute(const double radius, const double t0, const double t1,
                                             const double duration) const
  {
    const auto d = [this](const double t) { return distance(t); };
    const double d0 = d(t0), travel = std::max({p.rate.norm(), q.rate.norm(), (p.rate - q.rate).norm()});
    std::optional<double> time = t0;
    if (d0 >= touching_fraction * radius)
    {
      Search search(d, level_of_contact(d0, radius), t0, t1, travel);
      time = search.run(
          [&](const double level)
          {
            search.offer_roots_of(PointLine{q, p, level * level});
            search.offer_roots_of(PointLine{p, q, level * level});
          });
    }
    if (!time)
      return std::nullopt;
    Contact result = contact(*time);
    result.closest_time = end_of_approach(d, *time, t1, radius, travel, duration);
    return result;
  }
};
} // namespace

std::optional<Contact> first_contact(const MovingSegment &a, const MovingSegment &b, const double radius,
                                     const double t0, const double t1)
{
  const RelativePair pair(a, b);
  if (pair.balls_stay_apart((1 + contact_margin) * radius, t0, t1))
    return std::nullopt;
  const PairDistance at_start = pair.nearest(t0);
  const double d0 = std::sqrt(at_start.squared), travel = pair.travel();
  const auto d = [&](const double t) { return pair.distance(t); };
  std::optional<double> time = t0;
  if (d0 >= touching_fraction * radius)
  {
    const double level = level_of_contact(d0, radius);
    const double earliest = pair.earliest_within((1 + fine_shift) * level, t0, at_start);
    if (earliest > t1)
      return std::nullopt;
    Search search(d, level, earliest, t1, travel);
    time = search.run([&](const double lower) { pair.offer_all(search, lower); });
  }
  if (!time)
    return std::nullopt;
  const PairDistance nearest = pair.nearest(*time);
  return Contact{*time, nearest.first, nearest.second, std::sqrt(nearest.squared),
                 end_of_approach(d, *time, t1, radius, travel, t1 - t0)};
}

std::optional<Contact> first_hinge_contact(const MovingSegment &a, const MovingSegment &b, const double radius,
                                           const double t0, const double t1)
{
  const Arms arms{line(a), line(b)};
  const auto times = arms.turning_times(t0, t1);
  for (std::size_t i = 0; i + 1 < times.size(); ++i)
  {
    const double middle = 0.5 * (times[i] + times[i + 1]);
    if (times[i] < times[i + 1] && arms.p(middle).dot(arms.q(middle)) > 0)
      if (const auto contact = arms.contact_while_acute(radius, times[i], times[i + 1], t1 - t0))
        return contact;
  }
  return std::nullopt;
}

std::optional<Contact> first_collapse(const MovingSegment &a, const double radius, const double t0, const double t1)
{
  const LinearVector p = line(a);
  const double length = p(t0).norm(), rate2 = p.rate.squaredNorm();
  std::optional<double> time = t0;
  if (length >= touching_fraction * radius)
    time = time_of_entry(p, level_of_contact(length, radius), t0, t1);
  if (!time)
    return std::nullopt;
  const double shortest = rate2 > 0 ? -p.at_zero.dot(p.rate) / rate2 : t0;
  return Contact{*time, 0.0, 1.0, p(*time).norm(), std::clamp(shortest, *time, std::max(*time, t1))};
}
} // namespace ddfem
