// Arms that close like scissors and segments that vanish, against conservative advancement in extended precision.
#include "contact_oracle.h"

#include <gtest/gtest.h>

#include <iostream>

namespace ddfem
{
namespace
{
using namespace contact_oracle;

constexpr Real slack = 1e-5L;

Point at(const MovingSegment &a, const Real t)
{
  return (a.end - a.start).cast<Real>() + t * (a.end_velocity - a.start_velocity).cast<Real>();
}

Real end_to_arm(const Point &end, const Point &arm)
{
  const Real length2 = arm.squaredNorm();
  return (end - (length2 > 0 ? std::clamp<Real>(end.dot(arm) / length2, 0, 1) : Real(0)) * arm).norm();
}

struct Hinge
{
  MovingSegment a, b;

  Real cosine(const Real t) const { return at(a, t).dot(at(b, t)); }
  Real distance(const Real t) const { return std::min(end_to_arm(at(a, t), at(b, t)), end_to_arm(at(b, t), at(a, t))); }
  /// Greatest relative displacement of points of the arms per unit of time.
  Real travel() const
  {
    const Vec3 u = a.end_velocity - a.start_velocity, v = b.end_velocity - b.start_velocity;
    return std::max({u.norm(), v.norm(), (u - v).norm()});
  }
};

/// Steps that are so short that neither the distance can fall below the level by more than the slack, nor the angle
/// turn acute or obtuse for more than a moment. Returns the time, or -1, and the level that holds there.
std::pair<Real, Real> first_hinge(const Hinge &h, const Real radius, const Real t0, const Real t1, const Real depth)
{
  constexpr Real moment = 1e-7L;
  const Real travel = h.travel();
  const Real longest = std::max({at(h.a, t0).norm(), at(h.b, t0).norm(), at(h.a, t1).norm(), at(h.b, t1).norm()});
  const auto bisect = [](Real lower, Real upper, const auto &is_after)
  {
    for (int i = 0; i < 60; ++i)
    {
      const Real middle = (lower + upper) / 2;
      (is_after(middle) ? upper : lower) = middle;
    }
    return upper;
  };
  Real level = -1, before = t0;
  for (Real t = t0;;)
  {
    const Real c = h.cosine(t), d = h.distance(t);
    if (c <= 0)
      level = -1;
    else if (level < 0)
    {
      const Real start = t > t0 ? bisect(before, t, [&](const Real s) { return h.cosine(s) > 0; }) : t;
      const Real d0 = h.distance(start), reach = (1 + Real(contact_margin)) * radius;
      if (d0 < touching_fraction * radius)
        return {start, d0};
      level = depth * (d0 > reach ? reach : (1 - Real(contact_margin)) * d0);
    }
    if (c > 0 && d <= level)
      return {bisect(before, t, [&](const Real s) { return h.distance(s) <= level; }), level};
    if (t >= t1)
      return {-1, 0};
    const Real turning = std::max(std::abs(c) / (2 * travel * longest), moment);
    before = t;
    t = std::min({t1, t + turning, c > 0 ? t + (d - level * (1 - slack)) / travel : t1});
  }
}

Hinge random_hinge(RandomPairs &r)
{
  // Near each other at time t: the end of one arm is off a point of the other arm by a few radii. Then one, two or
  // three dimensions of motion, arms down to a tenth of the radius, all angles.
  const double t = r.uniform(-0.1, 1.2);
  const Vec3 n = r.direction();
  const bool flat = r.uniform(0, 1) < 0.4;
  const auto in_plane = [&](const Vec3 &x) { return flat ? Vec3(x - n.dot(x) * n) : x; };
  const Vec3 q = r.log_uniform(0.1, 60) * in_plane(r.direction());
  const Vec3 p = r.uniform(-0.2, 1.2) * q + in_plane(r.uniform(0, 3) * r.direction());
  const double speed = r.log_uniform(0.01, 80);
  const Vec3 u = speed * in_plane(r.vector()), v = speed * in_plane(r.vector());
  const Vec3 node = 10 * r.vector(), w = speed * r.vector();
  Hinge h{{node, node + p - t * u, w, w + u}, {node, node + q - t * v, w, w + v}};
  if (r.uniform(0, 1) < 0.5)
    std::swap(h.a, h.b);
  return h;
}

TEST(HingeContact, IsThatOfConservativeAdvancement)
{
  RandomPairs random(5);
  unsigned contacts = 0, doubtful = 0, from_within = 0;
  constexpr unsigned n = 30000;
  for (unsigned i = 0; i < n && !testing::Test::HasFailure(); ++i)
  {
    const Hinge h = random_hinge(random);
    const double t0 = i % 2 == 0 ? 0 : random.uniform(0, 0.3);
    const auto contact = first_hinge_contact(h.a, h.b, 1, t0, 1);
    const auto [time, level] = first_hinge(h, 1, t0, 1, 1);
    if (!contact)
    {
      // A dip by less than the slack may be seen by one and not by the other.
      EXPECT_TRUE(time < 0 || first_hinge(h, 1, t0, 1, 1 - 2 * slack).first < 0) << "missed, pair " << i;
      doubtful += time < 0 ? 0U : 1U;
      continue;
    }
    ++contacts;
    from_within += h.cosine(t0) <= 0 && level < 1 ? 1U : 0U;
    const Real found = contact->time, d = h.distance(found);
    EXPECT_NEAR(static_cast<double>(d), contact->distance, 1e-12 * (1 + static_cast<double>(h.travel())));
    EXPECT_GE(h.cosine(found), -1e-9L * h.travel());
    if (time >= 0 && std::abs(found - time) * h.travel() < 1e-5L * level + 1e-6L)
      continue;
    ++doubtful;
    EXPECT_GE(first_hinge(h, 1, t0, 1, 1 - 2 * slack).first, time < 0 ? -1 : found - 1e-6L) << "late, pair " << i;
    EXPECT_LE(d, level * (1 + 1e-9L)) << "early, pair " << i << " found " << contact->time << " not "
                                      << static_cast<double>(time);
  }
  std::cout << n << " hinges, " << contacts << " contacts, " << from_within << " that turned acute within the radius, "
            << doubtful << " within " << static_cast<double>(2 * slack) << " of no contact\n";
  EXPECT_GT(contacts, n / 5);
  EXPECT_GT(from_within, 50U);
  EXPECT_LT(doubtful, n / 500);
}

MovingSegment arm(const Vec3 &end, const Vec3 &velocity)
{
  return {Vec3::Zero(), end, Vec3::Zero(), velocity};
}

TEST(HingeContact, OfScissorsIsWhereTheEndOfTheShorterArmMeetsTheLongerOne)
{
  const auto c = first_hinge_contact(arm(Vec3(30, 10, 0), Vec3(0, -20, 0)), arm(Vec3(40, 0, 0), Vec3::Zero()), 1, 0, 1);
  ASSERT_TRUE(c);
  // The first arm, |(30, y)| < 40, is above the second until y = 0 and below it from then on.
  EXPECT_NEAR(c->time, (10 - (1 + contact_margin)) / 20, 1e-8);
  EXPECT_NEAR(c->distance, 1 + contact_margin, 1e-7);
  EXPECT_EQ(c->first, 1);
  EXPECT_NEAR(c->second, 0.75, 1e-12);
  EXPECT_NEAR(c->closest_time, 0.5, 1e-6);
}

TEST(HingeContact, DoesNotCountArmsThatFoldBackwardsOrOpen)
{
  EXPECT_FALSE(first_hinge_contact(arm(Vec3(-30, 10, 0), Vec3(0, -20, 0)), arm(Vec3(40, 0, 0), Vec3::Zero()), 1, 0, 1));
  EXPECT_FALSE(first_hinge_contact(arm(Vec3(30, 0.5, 0), Vec3(0, 20, 0)), arm(Vec3(40, 0, 0), Vec3::Zero()), 1, 0, 1));
  EXPECT_FALSE(first_hinge_contact(arm(Vec3(30, 0.5, 0), Vec3(1, 0, 0)), arm(Vec3(40, 0, 0), Vec3(1, 0, 0)), 1, 0, 1));
}

TEST(HingeContact, ThatTurnsAcuteWithinTheRadiusMustComeNearerFromThere)
{
  // A short arm whose end passes from behind the node to above the long arm, at the height 0.5, acute from t = 0.5.
  // It is 0.5 from the long arm then, and falls only if it also sinks.
  const MovingSegment longer = arm(Vec3(40, 0, 0), Vec3::Zero());
  EXPECT_FALSE(first_hinge_contact(arm(Vec3(-5, 0.5, 0), Vec3(10, 0, 0)), longer, 1, 0, 1));
  const auto c = first_hinge_contact(arm(Vec3(-5, 0.6, 0), Vec3(10, -0.2, 0)), longer, 1, 0, 1);
  ASSERT_TRUE(c);
  EXPECT_NEAR(c->time, 0.5 + contact_margin * 0.5 / 0.2, 1e-6);
  EXPECT_NEAR(c->distance, (1 - contact_margin) * 0.5, 1e-8);
  EXPECT_NEAR(c->closest_time, 1, 1e-6);
}

TEST(Collapse, IsWhereTheLengthFallsToTheReach)
{
  RandomPairs r(11);
  unsigned contacts = 0;
  for (unsigned i = 0; i < 30000; ++i)
  {
    // Shortest at time t with a length between 0 and 3, a part of them within 3e-3 of the radius or collinear.
    const double t = r.uniform(-0.2, 1.2), kind = r.uniform(0, 1);
    const double size = kind < 0.2 ? 0.0 : kind < 0.5 ? 1 + r.uniform(-3e-3, 3e-3) : r.uniform(0, 3);
    const Vec3 v = r.log_uniform(0.01, 80) * r.direction(), x = size * v.cross(r.vector()).normalized();
    const Vec3 base = 10 * r.vector(), w = 10 * r.vector();
    const MovingSegment a{base, base + x - t * v, w, w + v};
    const auto length = [&](const double s) { return static_cast<double>(at(a, s).norm()); };
    const double d0 = length(0), reach = 1 + contact_margin, level = d0 > reach ? reach : (1 - contact_margin) * d0;
    const double end = std::clamp(t, 0.0, 1.0);
    if (d0 < touching_fraction)
      continue;
    const auto c = first_collapse(a, 1, 0, 1);
    ASSERT_TRUE(std::abs(length(end) - level) < 1e-9 || c.has_value() == (length(end) < level)) << i;
    if (!c)
      continue;
    ++contacts;
    EXPECT_NEAR(c->distance, level, 1e-10);
    EXPECT_NEAR(length(c->time), level, 1e-10);
    EXPECT_LE(c->time, end + 1e-9);
    EXPECT_NEAR(length(c->closest_time), length(end), 1e-10);
    EXPECT_EQ(c->first, 0);
    EXPECT_EQ(c->second, 1);
  }
  EXPECT_GT(contacts, 5000U);
}

TEST(Collapse, OfASegmentWithoutLengthIsAtTheStart)
{
  const auto c = first_collapse(arm(Vec3(5e-7 - 0.25, 0, 0), Vec3(1, 0, 0)), 1, 0.25, 1);
  ASSERT_TRUE(c);
  EXPECT_EQ(c->time, 0.25);
  EXPECT_EQ(c->closest_time, 0.25);
}
} // namespace
} // namespace ddfem
