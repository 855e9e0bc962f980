// V15: brute-force quadrature of the defining integrals, tests/data/segments.json.
#include "dd/elasticity/segment_force.h"
#include "dd/elasticity/segment_stress.h"
#include "dd/elasticity/triangle_displacement.h"
#include "tests/dd/elasticity/elasticity_test_helpers.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>

namespace ddfem
{
namespace
{
using nlohmann::json;
using test::relative_error;

const json &reference_values()
{
  static const json data = []
  {
    std::ifstream file(std::string(DDFEM_TEST_DATA) + "/segments.json");
    return json::parse(file);
  }();
  return data;
}

Vec3 vector(const json &j)
{
  return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()};
}

IsotropicMedium medium_of(const json &row)
{
  return {.mu = row["mu"].get<double>(), .nu = row["nu"].get<double>(), .a = row["a"].get<double>()};
}

std::string scientific(double value)
{
  std::ostringstream text;
  text << value;
  return text.str();
}

/// Largest error per kind of row, printed at the end of a test.
class WorstErrors
{
public:
  explicit WorstErrors(std::string what_) : what(std::move(what_)) {}
  ~WorstErrors()
  {
    for (const auto &[kind, error] : worst)
    {
      std::cout << "  " << what << ", " << kind << ": largest relative error " << error << '\n';
      ::testing::Test::RecordProperty(kind, scientific(error));
    }
  }
  WorstErrors(const WorstErrors &) = delete;
  WorstErrors &operator=(const WorstErrors &) = delete;
  void add(const std::string &kind, double error) { worst[kind] = std::max(worst[kind], error); }

private:
  std::string what;
  std::map<std::string, double> worst;
};

TEST(ReferenceValues, StressOfSegment)
{
  WorstErrors worst("stress");
  std::size_t i = 0;
  for (const json &row : reference_values()["stress"])
  {
    const std::string kind = row["kind"];
    SymTensor expected;
    for (int k = 0; k < 6; ++k)
      expected[k] = row["sigma"][static_cast<std::size_t>(k)].get<double>();
    const SymTensor sigma =
        segment_stress(medium_of(row), vector(row["x"]), vector(row["x1"]), vector(row["x2"]), vector(row["b"]));
    const double error = relative_error(sigma, expected);
    EXPECT_LT(error, 1e-9) << "stress row " << i << " (" << kind << ")";
    worst.add(kind, error);
    ++i;
  }
  EXPECT_EQ(i, 140U);
}

SegmentForces force_of(const json &row, double tolerance)
{
  return segment_force(medium_of(row), vector(row["x1"]), vector(row["x2"]), vector(row["b12"]), vector(row["x3"]),
                       vector(row["x4"]), vector(row["b34"]), tolerance);
}

double force_error(const json &row, double tolerance)
{
  Eigen::Matrix<double, 6, 1> expected, value;
  expected << vector(row["f3"]), vector(row["f4"]);
  const SegmentForces f = force_of(row, tolerance);
  value << f.start, f.end;
  return relative_error(value, expected);
}

TEST(ReferenceValues, NodalForcesBetweenSegments)
{
  WorstErrors worst("force");
  std::size_t i = 0;
  for (const json &row : reference_values()["segseg"])
  {
    const std::string kind = row["kind"];
    const double error = force_error(row, 1e-10);
    EXPECT_LT(error, kind == "nearly_parallel" ? 1e-6 : 1e-8) << "segseg row " << i << " (" << kind << ")";
    worst.add(kind, error);
    ++i;
  }
  EXPECT_EQ(i, 140U);
}

TEST(ReferenceValues, ErrorOfNodalForcesFollowsTheRequestedTolerance)
{
  for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11})
  {
    WorstErrors worst("force at tolerance " + scientific(tolerance));
    std::size_t i = 0;
    for (const json &row : reference_values()["segseg"])
    {
      // Relative to the largest component of a force that may itself be the small remainder of larger contributions.
      // On the line of the other segment, whose stress changes by mu b/a^2 per length, rounding of a position x costs
      // eps |x| L/a^2 of the force, mu b/L per length.
      const bool collinear = row["kind"] == "collinear";
      const double a = row["a"].get<double>();
      const double conditioning =
          2.2e-16 * vector(row["x3"]).norm() * (vector(row["x4"]) - vector(row["x3"])).norm() / (a * a);
      const double error = force_error(row, tolerance);
      EXPECT_LT(error, 10.0 * tolerance + (collinear ? conditioning : 0.0))
          << "segseg row " << i << " (" << row["kind"] << "), tolerance " << tolerance;
      worst.add(row["kind"], error);
      ++i;
    }
  }
}

TEST(ReferenceValues, DisplacementOfTriangle)
{
  WorstErrors worst("displacement and solid angle");
  std::size_t i = 0;
  for (const json &row : reference_values()["loop_displacement"])
  {
    const Vec3 x = vector(row["x"]), b = vector(row["b"]);
    const Vec3 p1 = vector(row["vertices"][0]), p2 = vector(row["vertices"][1]), p3 = vector(row["vertices"][2]);
    const Vec3 expected = vector(row["u"]);
    const Vec3 u = triangle_displacement(row["nu"].get<double>(), x, p1, p2, p3, b);
    const Vec3 u_general = triangle_displacement(row["nu"].get<double>(), x, LoopVertex::at(p1), LoopVertex::at(p2),
                                                 LoopVertex::at(p3), b);
    // The triangle as drawn and the cap of the reference may differ by a whole jump.
    const double omega = row["solid_angle"].get<double>(), difference = omega - solid_angle(x, p1, p2, p3);
    const double error = relative_error(u, expected), omega_error = std::abs(difference) / std::abs(omega);
    EXPECT_LT(error, 1e-10) << "loop_displacement row " << i;
    EXPECT_LT(omega_error, 1e-10) << "loop_displacement row " << i;
    EXPECT_LT(relative_error(u_general, expected), 1e-10) << "loop_displacement row " << i;
    worst.add("u", error);
    worst.add("Omega", omega_error);
    ++i;
  }
  EXPECT_EQ(i, 140U);
}
} // namespace
} // namespace ddfem
