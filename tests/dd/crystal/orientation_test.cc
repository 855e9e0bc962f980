#include "dd/crystal/orientation.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace
{
using namespace ddfem;

void expect_proper_rotation(const Orientation &orientation)
{
  const Mat3 &r = orientation.rotation();
  EXPECT_LT((r * r.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_NEAR(r.determinant(), 1, 1e-15);
}

template <class F> std::string message_of(F &&f)
{
  try
  {
    f();
  }
  catch (const std::invalid_argument &error)
  {
    return error.what();
  }
  return "no exception";
}

TEST(Miller, ReductionKeepsTheSenseOrDropsIt)
{
  EXPECT_EQ(reduced({-2, 4, 0}), (Miller{-1, 2, 0}));
  EXPECT_EQ(without_sense({-2, 4, 0}), (Miller{1, -2, 0}));
  EXPECT_EQ(without_sense({0, 0, -7}), (Miller{0, 0, 1}));
  EXPECT_EQ(reduced({0, 0, 0}), (Miller{0, 0, 0}));
  EXPECT_EQ(to_string(Miller{1, -1, 1}), "1-11");
  EXPECT_EQ(to_string(Miller{10, -1, 2}), "10 -1 2");
}

TEST(Miller, RationalisationFindsSmallIndicesAndRefusesIrrationalDirections)
{
  for (const Miller &m : {Miller{1, 1, 1}, Miller{-1, 1, 0}, Miller{0, 0, -1}, Miller{2, -1, 3}, Miller{9, 8, -7}})
  {
    EXPECT_EQ(rationalised(to_vector(m) * 0.1234), m);
    EXPECT_EQ(rationalised(to_vector(m) + Vec3(1e-7, -1e-7, 1e-7)), m);
  }
  EXPECT_EQ(rationalised(Vec3(-0.7580839051, -0.4376799467, 0.4834718783)), (Miller{0, 0, 0}));
  EXPECT_EQ(rationalised(Vec3::Zero()), (Miller{0, 0, 0}));
}

TEST(Orientation, GivenAxesLieAlongTheSampleAxes)
{
  struct Case
  {
    SampleAxis axis_a;
    Miller a;
    SampleAxis axis_b;
    Miller b;
  };
  for (const Case &c : {Case{SampleAxis::x, {1, 1, 0}, SampleAxis::z, {-1, 1, 1}},
                        Case{SampleAxis::z, {1, 2, 3}, SampleAxis::x, {-3, 0, 1}},
                        Case{SampleAxis::y, {0, 1, 0}, SampleAxis::z, {1, 0, 5}},
                        Case{SampleAxis::y, {1, 1, 1}, SampleAxis::x, {1, -1, 0}}})
  {
    const Orientation orientation = Orientation::from_axes(c.axis_a, c.a, c.axis_b, c.b);
    expect_proper_rotation(orientation);
    EXPECT_LT((orientation.unit_vector(c.a) - Vec3::Unit(static_cast<int>(c.axis_a))).norm(), 1e-15);
    EXPECT_LT((orientation.unit_vector(c.b) - Vec3::Unit(static_cast<int>(c.axis_b))).norm(), 1e-15);
    EXPECT_LT((orientation.to_crystal(orientation.to_sample(Vec3(1, 2, 3))) - Vec3(1, 2, 3)).norm(), 1e-14);
  }
  EXPECT_EQ(Orientation().rotation(), Mat3::Identity());
  EXPECT_EQ(Orientation::from_axes(SampleAxis::x, {1, 0, 0}, SampleAxis::y, {0, 1, 0}).rotation(), Mat3::Identity());
}

TEST(Orientation, LoadingAxisIsCompletedByTheSmallestOrthogonalDirection)
{
  EXPECT_EQ(Orientation::from_loading_axis({0, 0, 1}).rotation(), Mat3::Identity());
  for (const auto &[z, x] : {std::pair<Miller, Miller>{{1, 1, 1}, {1, 0, -1}},
                             {{1, 2, 3}, {1, 1, -1}},
                             {{0, 1, 1}, {1, 0, 0}},
                             {{1, 1, 0}, {0, 0, 1}},
                             {{-2, 1, 5}, {1, 2, 0}},
                             {{-3, 0, 0}, {0, 1, 0}}})
  {
    const Orientation orientation = Orientation::from_loading_axis(z);
    expect_proper_rotation(orientation);
    EXPECT_LT((orientation.unit_vector(z) - Vec3::UnitZ()).norm(), 1e-15) << to_string(z);
    EXPECT_LT((orientation.unit_vector(x) - Vec3::UnitX()).norm(), 1e-15) << to_string(z);
  }
  const Orientation along_y = Orientation::from_loading_axis({1, 1, 1}, SampleAxis::y);
  expect_proper_rotation(along_y);
  EXPECT_LT((along_y.unit_vector({1, 1, 1}) - Vec3::UnitY()).norm(), 1e-15);
}

TEST(Orientation, ImpossibleAxesAreExplained)
{
  const auto oblique = [] { Orientation::from_axes(SampleAxis::x, {1, 0, 0}, SampleAxis::z, {1, 0, 1}); };
  EXPECT_EQ(message_of(oblique), "The crystal directions [100] and [101] of two sample axes enclose 45.000000 degrees; "
                                 "they must be orthogonal.");
  EXPECT_NE(message_of(
                [] {
                  Orientation::from_axes(SampleAxis::x, {0, 0, 0}, SampleAxis::z, {1, 0, 1});
                })
                .find("[000]"),
            std::string::npos);
  EXPECT_NE(message_of(
                [] {
                  Orientation::from_axes(SampleAxis::x, {1, 0, 0}, SampleAxis::x, {0, 0, 1});
                })
                .find("same sample axis"),
            std::string::npos);
  EXPECT_NE(message_of([] { Orientation::from_loading_axis({0, 0, 0}); }).find("[000]"), std::string::npos);
  EXPECT_THROW(Orientation::from_rotation(-Mat3::Identity()), std::invalid_argument);
  EXPECT_THROW(Orientation::from_rotation(2 * Mat3::Identity()), std::invalid_argument);
}
} // namespace
