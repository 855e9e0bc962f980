// First contacts with a known answer, and what they must not depend on.
#include "contact_oracle.h"
#include "dd/topology/collisions/bernstein.h"

#include <gtest/gtest.h>

namespace ddfem
{
namespace
{
using contact_oracle::RandomPairs;

constexpr double reach = 1 + contact_margin;

MovingSegment moved(const Vec3 &start, const Vec3 &end, const Vec3 &velocity)
{
  return {start, end, velocity, velocity};
}

MovingSegment reversed(const MovingSegment &a)
{
  return {a.end, a.start, a.end_velocity, a.start_velocity};
}

template <class Map, class MapVelocity>
MovingSegment transformed(const MovingSegment &a, const Map &x, const MapVelocity &v)
{
  return {x(a.start), x(a.end), v(a.start_velocity), v(a.end_velocity)};
}

TEST(FirstContact, OfParallelCrossingAndCollinearPairsHasTheTimeOfTheGap)
{
  const MovingSegment fixed = moved(Vec3(-20, 0, 0), Vec3(20, 0, 0), Vec3::Zero());
  const Vec3 down(0, 0, -20);
  for (const Vec3 &half : {Vec3(10, 0, 0), Vec3(0, 10, 0), Vec3(7, 1e-9, 0), Vec3(0, 0, 0)})
  {
    const auto c = first_contact(fixed, moved(Vec3(0, 0, 5) - half, Vec3(0, 0, 5) + half, down), 1, 0, 1);
    ASSERT_TRUE(c);
    EXPECT_NEAR(c->time, (5 - reach) / 20, 1e-8);
    EXPECT_NEAR(c->distance, reach, 1e-7);
    EXPECT_NEAR(c->closest_time, 0.25, 1e-6);
  }
  const auto c = first_contact(fixed, moved(Vec3(24, 0, 0), Vec3(44, 0, 0), Vec3(-4, 0, 0)), 1, 0, 1);
  ASSERT_TRUE(c);
  EXPECT_NEAR(c->time, (4 - reach) / 4, 1e-8);
  EXPECT_EQ(c->first, 1);
  EXPECT_EQ(c->second, 0);
  EXPECT_NEAR(c->closest_time, 1, 1e-6);
}

TEST(FirstContact, NeedsRelativeMotionUnlessTheSegmentsTouch)
{
  const Vec3 v(3, -40, 5);
  const MovingSegment a = moved(Vec3(-20, 0, 0), Vec3(20, 0, 0), v);
  for (const double height : {5.0, reach, 1.0, 0.5, 1e-3, 2e-6})
    EXPECT_FALSE(first_contact(a, moved(Vec3(0, -20, height), Vec3(0, 20, height), v), 1, 0, 1)) << height;
  const auto c = first_contact(a, moved(Vec3(0, -20, 5e-7), Vec3(0, 20, 5e-7), v), 1, 0.25, 1);
  ASSERT_TRUE(c);
  EXPECT_EQ(c->time, 0.25);
  EXPECT_NEAR(c->first, 0.5, 1e-12);
  EXPECT_FALSE(first_contact(a, moved(Vec3(0, -20, 0.5), Vec3(0, 20, 0.5), v + Vec3(0, 0, 20)), 1, 0, 1)) << "leaving";
}

TEST(FirstContact, DoesNotDependOnOrderSenseOrFrame)
{
  RandomPairs r(3);
  unsigned contacts = 0;
  for (int i = 0; i < 20000; ++i)
  {
    const auto [a, b] = r.generic();
    const auto c = first_contact(a, b, 1, 0, 1);
    contacts += c ? 1U : 0U;
    const auto expect = [&](const std::optional<Contact> &x, const bool swap, const bool reverse_a, const double scale,
                            const double tolerance)
    {
      ASSERT_EQ(x.has_value(), c.has_value()) << i;
      if (!c)
        return;
      EXPECT_NEAR(x->time, c->time, tolerance) << i;
      EXPECT_NEAR(x->distance, scale * c->distance, 1e-6 * scale) << i;
      const double first = swap ? x->second : x->first, second = swap ? x->first : x->second;
      EXPECT_NEAR(reverse_a ? 1 - first : first, c->first, 100 * tolerance) << i;
      EXPECT_NEAR(second, c->second, 100 * tolerance) << i;
    };
    // Grazing contacts amplify rounding: 1e-13 in the distance is the square of the error in the time.
    constexpr double tolerance = 3e-6;
    expect(first_contact(b, a, 1, 0, 1), true, false, 1, tolerance);
    expect(first_contact(reversed(a), b, 1, 0, 1), false, true, 1, tolerance);
    const Vec3 shift = 100 * r.vector(), boost = 10 * r.vector();
    const Mat3 turn = Eigen::AngleAxisd(r.uniform(0, 6), r.direction()).toRotationMatrix();
    const double scale = r.log_uniform(1e-3, 1e3);
    const auto frame = [&](const MovingSegment &s)
    {
      return transformed(
          s, [&](const Vec3 &x) { return Vec3(scale * (turn * x + shift)); },
          [&](const Vec3 &v) { return Vec3(scale * (turn * v + boost)); });
    };
    expect(first_contact(frame(a), frame(b), scale, 0, 1), false, false, scale, tolerance);
  }
  EXPECT_GT(contacts, 5000U);
}

TEST(FirstContact, InAnIntervalIsThatInItsParts)
{
  RandomPairs r(4);
  unsigned in_first_part = 0, in_second_part = 0;
  for (int i = 0; i < 20000; ++i)
  {
    const auto [a, b] = r.generic();
    if (contact_oracle::distance(a, b, 0) <= reach)
      continue; // from within the radius, the level depends on the start
    const double s = r.uniform(0, 1);
    const auto whole = first_contact(a, b, 1, 0, 1);
    auto part = first_contact(a, b, 1, 0, s);
    const bool in_first = part.has_value();
    if (!in_first)
      part = first_contact(a, b, 1, s, 1);
    ASSERT_EQ(whole.has_value(), part.has_value()) << i;
    if (!whole)
      continue;
    EXPECT_NEAR(whole->time, part->time, 3e-6) << i;
    (in_first ? in_first_part : in_second_part) += 1;
  }
  EXPECT_GT(in_first_part, 1000U);
  EXPECT_GT(in_second_part, 1000U);
}

TEST(Bernstein, ProductsHaveTheValuesOfTheirFactors)
{
  const std::array<double, 3> p = {1, -2, 4};
  const std::array<double, 4> q = {3, 0.5, -1, 2};
  const auto value = [](const auto &c, const double t)
  {
    double sum = 0;
    const std::size_t n = c.size() - 1;
    for (std::size_t i = 0; i <= n; ++i)
      sum += binomial(n, i) * c[i] * std::pow(t, static_cast<double>(i)) * std::pow(1 - t, static_cast<double>(n - i));
    return sum;
  };
  const auto product = bernstein_product(p, q, [](const double a, const double b) { return a * b; });
  for (const double t : {0.0, 0.1, 0.5, 0.77, 1.0})
    EXPECT_NEAR(value(product, t), value(p, t) * value(q, t), 1e-14);
}
} // namespace
} // namespace ddfem
