// The fast multipole method as a whole: requested errors, periodic cells, independence of threads.
#include "dd/elasticity/gauss.h"
#include "dd/forces/nodal_forces.h"
#include "tests/dd/fmm/systems_of_lines.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace ddfem
{
namespace
{
using namespace test;

struct Errors
{
  double rms = 0, largest = 0; ///< absolute
};

template <class Values> Errors compare(const Values &values, const Values &exact)
{
  Errors e;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const double d = (values[i] - exact[i]).norm();
    e.rms += d * d / static_cast<double>(values.size());
    e.largest = std::max(e.largest, d);
  }
  e.rms = std::sqrt(e.rms);
  return e;
}

template <class Values> double rms(const Values &values)
{
  double sum = 0;
  for (const auto &v : values)
    sum += v.squaredNorm();
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Points all over the bounding box of the lines.
std::vector<Vec3> points_among(const LineSystem &system, const std::size_t n)
{
  Eigen::AlignedBox3d box;
  for (const StraightLine &l : system.lines())
    box.extend(0.5 * (l.start + l.end));
  RandomVectors random(11);
  std::vector<Vec3> points;
  for (std::size_t k = 0; k < n; ++k)
    points.emplace_back(box.center() + 0.5 * box.sizes().cwiseProduct(random.vector()));
  return points;
}

/// Cost factor of a tree in which most of the network is far, at any order.
double depth_factor(const double tolerance)
{
  return tolerance > 5e-4 ? 0.05 : 0.2;
}

/// Every @p stride -th of the values.
template <class T> std::vector<T> some_of(const std::vector<T> &values, const std::size_t stride)
{
  std::vector<T> some;
  for (std::size_t i = 0; i < values.size(); i += stride)
    some.push_back(values[i]);
  return some;
}

void print(const std::string &what, const LinesOfTest &lines, const double tolerance, const Errors &e, const double far,
           const double total)
{
  if (std::getenv("DDFEM_PRINT_ERRORS"))
    std::printf("| %s | %s | %.0e | %.1e | %.1e | %.1e | %.1e |\n", lines.name.c_str(), what.c_str(), tolerance,
                e.rms / far, e.largest / far, e.rms / total, e.largest / total);
}

TEST(MultipoleField, ReachesTheRequestedErrorOfTheStress)
{
  for (const LinesOfTest &lines : all_finite_systems(60))
  {
    const LineSystem system = lines.system();
    constexpr std::size_t stride = 8;
    const auto points = points_among(system, 1600), sample = some_of(points, stride);
    const auto exact = system.stress(sample);
    for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8})
    {
      // A deeper tree than pays in networks as small as these, so that much of the field is far.
      const fmm::MultipoleSettings settings{tolerance, 0, depth_factor(tolerance)};
      MultipoleField field(system, points, settings);
      const auto value = some_of(field.stress(MPI_COMM_SELF), stride);
      const auto far = some_of(field.sum().stress(MPI_COMM_SELF, fmm::Part::far), stride);
      const Errors e = compare(value, exact);
      print("stress", lines, tolerance, e, rms(far), rms(exact));
      EXPECT_LT(e.rms, tolerance * rms(far)) << lines.name << ' ' << tolerance;
      EXPECT_GT(30 * e.rms, tolerance * rms(far)) << lines.name << ' ' << tolerance;
      // Boxes that touch at the corner of convergence: the largest of 250 points is some 10 times the rms.
      EXPECT_LT(e.largest, 20 * tolerance * rms(far)) << lines.name << ' ' << tolerance;
    }
  }
}

/// Forces of the far stress on the lines, both ends together.
std::vector<Vec3> far_forces(const LineSystem &system, const double tolerance)
{
  const GaussRule rule = gauss_rule(2);
  std::vector<Vec3> points, forces;
  for (const StraightLine &l : system.lines())
    for (const double z : rule.points)
      points.emplace_back(l.start + z * (l.end - l.start));
  MultipoleField field(system, points, {tolerance, 0, depth_factor(tolerance)});
  const auto far = field.sum().stress(MPI_COMM_SELF, fmm::Part::far);
  for (std::size_t i = 0; i < system.lines().size(); ++i)
  {
    const StraightLine &l = system.lines()[i];
    forces.emplace_back(0.5 * contract(SymTensor(far[2 * i] + far[2 * i + 1]), l.burgers).cross(l.end - l.start));
  }
  return forces;
}

/// Total force on one line, and its moment about the middle in units of half the length, pair by pair.
std::array<Vec3, 2> direct_force(const LineSystem &system, const std::size_t i)
{
  const StraightLine &l = system.lines()[i];
  SegmentForces sum;
  const auto add = [&](const SegmentForces &f)
  {
    sum.start += f.start;
    sum.end += f.end;
  };
  for (std::size_t j = 0; j < system.lines().size(); ++j)
    for (const Vec3 &shift : system.image_shifts())
      if (const StraightLine &s = system.lines()[j]; j != i || !shift.isZero())
        add(segment_force(system.medium(), s.start + shift, s.end + shift, s.burgers, l.start, l.end, l.burgers));
  for (const VirtualRay &r : system.rays())
    add(segment_force_from_ray(system.medium(), r.origin, r.direction, r.burgers, l.start, l.end, l.burgers));
  return {sum.start, sum.end};
}

TEST(MultipoleForces, ReachTheRequestedErrorOfNodalForces)
{
  for (const LinesOfTest &lines : all_finite_systems(60))
  {
    const LineSystem system = lines.system();
    std::vector<std::size_t> sample;
    for (std::size_t i = 0; i < system.lines().size(); i += 13)
      sample.push_back(i);
    sample.push_back(system.lines().size() - 1); // the long line
    std::vector<Vec3> exact;
    for (const std::size_t i : sample)
      for (const Vec3 &f : direct_force(system, i))
        exact.push_back(f);
    for (const double tolerance : {1e-2, 1e-3, 1e-5, 1e-7})
    {
      const MultipoleForces forces(system, {tolerance, 0, depth_factor(tolerance)}, 1e-10, MPI_COMM_SELF);
      std::vector<Vec3> value;
      for (const std::size_t i : sample)
        for (const SegmentForces f = forces(i); const Vec3 &end : {f.start, f.end})
          value.push_back(end);
      const double far = 0.5 * rms(far_forces(system, tolerance)); // per end
      const Errors e = compare(value, exact);
      print("force", lines, tolerance, e, far, rms(exact));
      // Quadrature along the lines is held to a fifth of the tolerance relative to the total.
      const double scale = std::max(far, 0.2 * rms(exact));
      EXPECT_LT(e.rms, tolerance * scale) << lines.name << ' ' << tolerance;
      EXPECT_GT(30 * e.rms, tolerance * scale) << lines.name << ' ' << tolerance;
      EXPECT_LT(e.largest, 20 * tolerance * scale) << lines.name << ' ' << tolerance;
    }
  }
}

TEST(MultipoleField, DoesNotDependOnTheNumberOfThreads)
{
  const LinesOfTest lines = clustered_loops(60);
  const LineSystem system = lines.system();
  const auto points = points_among(system, 2000);
  std::vector<std::vector<SymTensor>> values;
  for (const int n_threads : {1, 2, 5})
  {
    omp_set_num_threads(n_threads);
    MultipoleField field(system, points, {1e-3});
    values.push_back(field.stress(MPI_COMM_SELF));
  }
  omp_set_num_threads(2);
  EXPECT_TRUE(values[0] == values[1]);
  EXPECT_TRUE(values[0] == values[2]);
}

TEST(MultipoleField, OfAPeriodicCellIsTheDirectSum)
{
  for (const Vec3 &lengths : {Vec3(1000, 1000, 1000), Vec3(700, 1100, 1300)})
  {
    const LinesOfTest lines = periodic_loops(40, Vec3(-500, -500, -500), lengths, 7);
    const LineSystem system = lines.system();
    const auto points = points_among(system, 1500), sample = some_of(points, 15);
    const auto exact = system.stress(sample);
    MultipoleField field(system, points, {1e-4});
    const auto far = field.sum().stress(MPI_COMM_SELF, fmm::Part::far);
    const Errors e = compare(some_of(field.stress(MPI_COMM_SELF), 15), exact);
    EXPECT_LT(e.rms, 1e-4 * rms(far)) << lengths.transpose();
  }
}

TEST(MultipoleField, DoesNotDependOnTheOriginOfTheCell)
{
  const Vec3 lengths(900, 1000, 1100);
  std::vector<std::vector<SymTensor>> values;
  for (const Vec3 &origin : {Vec3(-450, -500, -550), Vec3(-13, 170, 321)})
  {
    const LinesOfTest lines = periodic_loops(40, Vec3(-450, -500, -550), lengths, 9);
    const PeriodicCell cell{origin, lengths};
    PeriodicImages images(origin, lengths, 9);
    const LineSystem system(copper_like, lines.network, nullptr, RayDirection::normal, &cell, &images);
    RandomVectors random(12);
    std::vector<Vec3> points;
    for (int k = 0; k < 500; ++k)
      points.push_back(random.vector().cwiseProduct(lengths));
    MultipoleField field(system, points, {1e-5});
    values.push_back(field.stress(MPI_COMM_SELF));
  }
  // Of the total stress; the images beyond the nearest ones have an error of their own of about 2e-5 of their rms at order 9.
  EXPECT_LT(compare(values[0], values[1]).rms, 1e-5 * rms(values[0]));
}

TEST(MultipoleForces, OfAPeriodicCellAreTheDirectOnes)
{
  const LinesOfTest lines = periodic_loops(30, Vec3(-350, -400, -450), Vec3(700, 800, 900), 9);
  ForceSettings settings{copper_like, copper_like.a, 1e-8};
  ForceEnvironment environment;
  environment.cell = lines.cell.get();
  environment.images = lines.images.get();
  settings.summation.method = SummationMethod::direct;
  const auto direct = compute_nodal_forces(lines.network, settings, environment, MPI_COMM_SELF).total;
  settings.summation = {SummationMethod::multipole, 1e-4};
  const auto fast = compute_nodal_forces(lines.network, settings, environment, MPI_COMM_SELF).total;
  EXPECT_LT(compare(fast, direct).rms, 1e-4 * rms(direct));
}
} // namespace
} // namespace ddfem
