// First contacts of moving segments against a branch-and-bound search that uses no polynomials.
#include "contact_oracle.h"

#include <gtest/gtest.h>

#include <iostream>

namespace ddfem
{
namespace
{
using namespace contact_oracle;
using Pair = std::pair<MovingSegment, MovingSegment>;

struct Counts
{
  unsigned pairs = 0, contacts = 0, between = 0, undetected_between = 0;
};

/// Slack of the search: a dip by less than this fraction of the level may be passed over by it.
constexpr double slack = 1e-6;

void check_contact(const Pair &pair, const Contact &c, const double level, const double t0, const double t1)
{
  const auto &[a, b] = pair;
  const auto d = [&, &a = a, &b = b](const double t) { return static_cast<double>(distance(a, b, t)); };
  const double size = std::max({a.start.norm(), a.end.norm(), b.start.norm(), b.end.norm()});
  const double rounding = 1e-14 * size;
  ASSERT_GE(c.time, t0);
  ASSERT_LE(c.time, t1);
  EXPECT_LE(d(c.time), level * (1 + 1e-12) + rounding);
  EXPECT_NEAR(c.distance, d(c.time), 1e-12 * level + rounding);
  // Where d falls to the level, and not before.
  EXPECT_GE(d(c.time), level * (1 - 1e-7) - rounding);
  const Real before = first_within(a, b, level * (1 - 2 * slack), slack, t0, c.time - 1e-9 * (t1 - t0));
  EXPECT_EQ(before, -1) << static_cast<double>(before) << " instead of " << c.time;
  // The nearest points.
  const Vec3 x = (1 - c.first) * a.start_at(c.time) + c.first * a.end_at(c.time);
  const Vec3 y = (1 - c.second) * b.start_at(c.time) + c.second * b.end_at(c.time);
  EXPECT_NEAR((y - x).norm(), c.distance, 1e-12 * level + rounding);
}

void check_end_of_approach(const Pair &pair, const Contact &c, const double radius, const double t1,
                           const double duration)
{
  const auto d = [&](const double t) { return static_cast<double>(distance(pair.first, pair.second, t)); };
  ASSERT_GE(c.closest_time, c.time);
  ASSERT_LE(c.closest_time, t1);
  const double at = d(c.closest_time), h = 2e-6 * duration;
  EXPECT_LE(at, d(c.time) + 1e-9 * radius);
  // The minimum is found to 1e-7 of the interval, in which d changes no faster than the fastest relative motion of
  // ends.
  double travel = 0;
  for (const Vec3 &v : {pair.first.start_velocity, pair.first.end_velocity})
    for (const Vec3 &w : {pair.second.start_velocity, pair.second.end_velocity})
      travel = std::max(travel, (v - w).norm());
  const double kink = 1e-7 * duration * travel;
  for (const double t : {c.closest_time - h, c.closest_time + h})
    EXPECT_GE(d(std::clamp(t, c.time, t1)), at - kink);
}

/// Compares one pair with the search; @p radius is not reached at t0.
void compare(const Pair &pair, const double radius, const double t0, const double t1, Counts &counts)
{
  const auto &[a, b] = pair;
  const double d0 = static_cast<double>(distance(a, b, t0)), reach = (1 + contact_margin) * radius;
  const double level = d0 > reach ? reach : (1 - contact_margin) * d0, inner = level / (1 + contact_margin);
  const auto contact = first_contact(a, b, radius, t0, t1);
  ++counts.pairs;
  if (d0 < touching_fraction * radius)
  {
    ++counts.contacts;
    ASSERT_TRUE(contact);
    EXPECT_EQ(contact->time, t0);
  }
  else if (contact)
  {
    ++counts.contacts;
    check_contact(pair, *contact, level, t0, t1);
    check_end_of_approach(pair, *contact, radius, t1, t1 - t0);
    counts.between += first_within(a, b, inner, slack, t0, t1) < 0 ? 1U : 0U;
  }
  else if (first_within(a, b, level * (1 - slack), slack, t0, t1) >= 0)
  {
    ++counts.undetected_between;
    EXPECT_EQ(first_within(a, b, inner, slack, t0, t1), -1) << "missed";
  }
}

/// Compares a bundle of pairs whose radius is 1, in a random unit of length and at times that do not begin at zero.
void compare_bundle(const char *name, const unsigned n, const std::function<Pair(RandomPairs &)> &make,
                    const double expected_share, const double offset = 0)
{
  RandomPairs random(7);
  Counts counts;
  for (unsigned i = 0; i < n && !testing::Test::HasFailure(); ++i)
  {
    auto [a, b] = make(random);
    const double unit = random.log_uniform(0.1, 30);
    const Vec3 shift = offset * random.direction();
    for (Vec3 *x : {&a.start, &a.end, &b.start, &b.end})
      *x = unit * *x + shift;
    for (Vec3 *v : {&a.start_velocity, &a.end_velocity, &b.start_velocity, &b.end_velocity})
      *v *= unit;
    const double t0 = i % 2 == 0 ? 0 : random.uniform(0, 0.3);
    compare({a, b}, unit, t0, 1, counts);
    EXPECT_FALSE(testing::Test::HasFailure()) << name << ", pair " << i;
  }
  std::cout << name << ": " << counts.pairs << " pairs, " << counts.contacts << " contacts, of which " << counts.between
            << " between radius and reach; " << counts.undetected_between << " between these left out\n";
  EXPECT_GE(counts.contacts, expected_share * n);
  EXPECT_LE(counts.contacts, 0.98 * n);
}

TEST(FirstContact, IsThatOfTheSearchForRandomPairs)
{
  compare_bundle(
      "generic", 30000, [](RandomPairs &r) { return r.generic(); }, 0.3);
}

TEST(FirstContact, IsThatOfTheSearchAtLargeCoordinates)
{
  compare_bundle(
      "1e5 nm away", 10000, [](RandomPairs &r) { return r.generic(); }, 0.3, 1e5);
}

TEST(FirstContact, IsThatOfTheSearchForGrazingPairs)
{
  // The unit of length is such that the smallest distance is 1 within 3e-3.
  compare_bundle(
      "grazing", 12000,
      [](RandomPairs &r)
      {
        for (;;)
        {
          auto [a, b] = r.generic();
          const double d = static_cast<double>(smallest_distance(a, b, 0.3L, 1, 0.05L));
          if (d <= 0)
            continue;
          const double scale = (1 + r.uniform(-3e-3, 3e-3)) / d;
          for (Vec3 *x : {&a.start, &a.end, &b.start, &b.end, &a.start_velocity, &a.end_velocity, &b.start_velocity,
                          &b.end_velocity})
            *x *= scale;
          return Pair(a, b);
        }
      },
      0.3);
}

TEST(FirstContact, IsThatOfTheSearchForParallelAndNearlyParallelPairs)
{
  for (const bool exactly : {true, false})
    compare_bundle(
        exactly ? "parallel" : "nearly parallel", 15000,
        [=](RandomPairs &r)
        {
          const Vec3 e = r.direction(),
                     turn = exactly ? Vec3(Vec3::Zero()) : Vec3(r.log_uniform(1e-12, 1e-2) * r.vector());
          const double speed = r.log_uniform(0.01, 80), spin = exactly ? 0 : r.log_uniform(1e-12, 1) * r.uniform(0, 1);
          const Vec3 va = speed * r.vector(), vb = speed * r.vector();
          return r.meeting(r.uniform(5, 60) * e, r.uniform(-60, 60) * (e + turn), r.uniform(0, 4) * r.direction(),
                           r.uniform(0, 1.2), {va, va + (spin * r.vector()), vb, vb + Vec3(spin * r.vector())});
        },
        0.2);
}

TEST(FirstContact, IsThatOfTheSearchInAPlaneAndOnALine)
{
  const auto coplanar = [](RandomPairs &r)
  {
    const Vec3 n = r.direction();
    const auto flat = [&](const Vec3 &x) { return Vec3(x - n.dot(x) * n); };
    const auto v = r.velocities(r.log_uniform(0.01, 80));
    // In one plane, or in two that are apart or approach.
    const Vec3 height = r.uniform(0, 1) < 0.5 ? Vec3(Vec3::Zero()) : Vec3(r.uniform(0, 1.5) * n);
    return r.meeting(flat(40 * r.direction()), flat(40 * r.direction()), flat(3 * r.vector()) + height,
                     r.uniform(0, 1.2), {flat(v[0]), flat(v[1]), flat(v[2]), flat(v[3])});
  };
  compare_bundle("coplanar", 12000, coplanar, 0.3);
  const auto collinear = [](RandomPairs &r)
  {
    const Vec3 e = r.direction();
    const auto v = r.velocities(r.log_uniform(0.01, 80));
    const auto along = [&](const Vec3 &x) { return Vec3(x[0] * e); };
    return r.meeting(r.uniform(-40, 40) * e, r.uniform(-40, 40) * e, r.uniform(-30, 30) * e, r.uniform(0, 1.2),
                     {along(v[0]), along(v[1]), along(v[2]), along(v[3])});
  };
  compare_bundle("collinear", 8000, collinear, 0.1);
}

TEST(FirstContact, IsThatOfTheSearchForPairsThatShareMostOfTheirMotion)
{
  compare_bundle(
      "shared motion", 10000,
      [](RandomPairs &r)
      {
        auto v = r.velocities(r.log_uniform(1e-3, 3));
        const Vec3 common = r.uniform(1, 80) * r.direction();
        for (Vec3 &x : v)
          x += common;
        return r.meeting(40 * r.direction(), 40 * r.direction(), r.uniform(0, 3) * r.direction(), r.uniform(0, 1.2), v);
      },
      0.1);
}

TEST(FirstContact, IsThatOfTheSearchForLongAndShortSegments)
{
  compare_bundle(
      "long and short", 15000,
      [](RandomPairs &r)
      {
        const double first = r.log_uniform(1e-3, 1e4), second = r.log_uniform(1e-3, 1e4);
        return r.meeting(first * r.direction(), second * r.direction(), r.uniform(0, 3) * r.direction(),
                         r.uniform(0, 1.2), r.velocities(r.log_uniform(0.01, 80)));
      },
      0.2);
}

TEST(FirstContact, IsThatOfTheSearchForSegmentsThatVanishOrTurnInsideOut)
{
  compare_bundle(
      "shrinking", 15000,
      [](RandomPairs &r)
      {
        // Length zero at a time within the step, for a part of them at that of the meeting, or always.
        const double t = r.uniform(0, 1.2), zero = r.uniform(0, 1) < 0.3 ? t : r.uniform(0, 1);
        const Vec3 u = r.uniform(0, 1) < 0.1 ? Vec3(Vec3::Zero()) : Vec3(r.log_uniform(0.1, 40) * r.direction());
        auto [a, b] =
            r.meeting(u, 40 * r.direction(), r.uniform(0, 3) * r.direction(), t, r.velocities(r.log_uniform(0.01, 40)));
        const Vec3 rate = u / std::copysign(std::max(std::abs(t - zero), 0.05), t - zero);
        a.end_velocity = a.start_velocity + rate;
        a.end = a.start + u - t * rate;
        return r.uniform(0, 1) < 0.5 ? Pair(a, b) : Pair(b, a);
      },
      0.3);
}

TEST(FirstContact, OfPairsWithinTheRadiusIsWhereTheyHaveComeNearer)
{
  compare_bundle(
      "within the radius", 20000,
      [](RandomPairs &r)
      {
        return r.meeting(40 * r.direction(), 40 * r.direction(), r.log_uniform(1e-3, 1) * r.direction(),
                         r.uniform(-0.01, 0.2), r.velocities(r.log_uniform(0.01, 80)));
      },
      0.2);
}
} // namespace
} // namespace ddfem
