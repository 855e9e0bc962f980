// The fast multipole method as a whole: requested errors, periodic cells, independence of threads.
#include "dd/forces/nodal_forces.h"
#include "samples/multipole_errors.h"
#include "samples/values.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace ddfem
{
namespace
{
using namespace samples;

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

/// Every @p stride -th of the values.
template <class T> std::vector<T> some_of(const std::vector<T> &values, const std::size_t stride)
{
  std::vector<T> some;
  for (std::size_t i = 0; i < values.size(); i += stride)
    some.push_back(values[i]);
  return some;
}

void print(const SampleLines &lines, const double tolerance, const char *const what, const FieldError &e)
{
  if (std::getenv("DDFEM_PRINT_ERRORS"))
    std::printf("| %s | %s | %.0e | %.1e | %.1e | %.1e | %.1e |\n", lines.name.c_str(), what, tolerance, e.rms / e.far,
                e.largest / e.far, e.rms / e.total, e.largest / e.total);
}

/// The largest of some thousand errors, where boxes touch at the corner of convergence, is some tens of times the rms.
void expect_reached(const SampleLines &lines, const double tolerance, const char *const what, const FieldError &e)
{
  print(lines, tolerance, what, e);
  EXPECT_LT(e.rms, tolerance * e.far) << lines.name << ", " << what << ' ' << tolerance;
  EXPECT_LT(e.largest, 50 * tolerance * e.far) << lines.name << ", " << what << ' ' << tolerance;
}

void expect_not_overshot(const SampleLines &lines, const double tolerance, const char *const what, const FieldError &e)
{
  EXPECT_GT(30 * e.rms, tolerance * e.far) << lines.name << ", " << what << ' ' << tolerance;
}

TEST(MultipoleForces, ReachTheRequestedErrorAsTheStressDoes)
{
  std::vector<SampleLines> all = all_finite_systems(80);
  all[0] = periodic_loops(50, Vec3(-500, -500, -500), Vec3(1000, 1000, 1000), 14); // instead of the random loops
  for (const SampleLines &lines : all)
  {
    if (sanitized && !lines.shape) // the one with rays; OfAPeriodicCellAreTheDirectOnes has images
      continue;
    const MultipoleErrorMeter meter(lines, sanitized ? 500 : 1600);
    for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8})
    {
      if (sanitized && tolerance != 1e-2 && tolerance != 1e-6) // one of each precision
        continue;
      if (lines.cell && tolerance < 1e-7) // next to nothing of so few lines is far
        continue;
      // A deeper tree than pays in networks as small as these, so that much of the field is far.
      const MultipoleErrors e = meter.errors(tolerance, 0.04);
      expect_reached(lines, tolerance, "stress", e.stress);
      expect_reached(lines, tolerance, "stress on lines", e.stress_on_lines);
      expect_reached(lines, tolerance, "force", e.force);
      // Where few pairs of boxes at the corner of convergence decide, networks differ by a factor of 100.
      if (tolerance < 1e-7)
        continue;
      expect_not_overshot(lines, tolerance, "stress", e.stress);
      expect_not_overshot(lines, tolerance, "force", e.force);
    }
  }
}

TEST(MultipoleField, DoesNotDependOnTheNumberOfThreads)
{
  const SampleLines lines = clustered_loops(60);
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

TEST(MultipoleField, IsTheSameWithLocalExpansionsKeptAndUsedOnce)
{
  const SampleLines lines = clustered_loops(60);
  const LineSystem system = lines.system();
  const auto points = points_among(system, 2000);
  for (const double tolerance : {1e-3, 1e-6}) // expansions in single and double precision
  {
    MultipoleField field(system, points, {tolerance});
    const auto used_once = field.stress(MPI_COMM_SELF);
    EXPECT_THROW(field.stress_with_kept_far_field(MPI_COMM_SELF, 0, fmm::Recipient::every_rank), std::logic_error);
    const auto kept =
        field.stress(MPI_COMM_SELF, fmm::Part::all, fmm::Recipient::every_rank, fmm::LocalExpansions::kept);
    EXPECT_TRUE(kept == used_once);
    EXPECT_TRUE(field.stress_with_kept_far_field(MPI_COMM_SELF, 0, fmm::Recipient::every_rank) == used_once);
  }
}

TEST(LineSystem, TableHasTheLinesThatCloseIt)
{
  const SampleLines lines = clustered_loops(2);
  LineSystem system = lines.system();
  const LineSystem before = system;
  EXPECT_EQ(system.segment_table().size(), system.lines().size());
  OpenLines open;
  open.lines.push_back({Vec3::Zero(), Vec3(1, 2, 3), Vec3(0, 0, 0.25)});
  system.close(open);
  ASSERT_EQ(system.segment_table().size(), before.lines().size() + 1);
  EXPECT_EQ(system.segment_table().vector(before.lines().size(), LineTable::burgers), Vec3(0, 0, -0.25));
  EXPECT_EQ(before.segment_table().size(), before.lines().size());
}

TEST(MultipoleField, OfAPeriodicCellIsTheDirectSum)
{
  for (const Vec3 &lengths : {Vec3(1000, 1000, 1000), Vec3(700, 1100, 1300)})
  {
    const SampleLines lines = periodic_loops(40, Vec3(-500, -500, -500), lengths, 7);
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
    const SampleLines lines = periodic_loops(40, Vec3(-450, -500, -550), lengths, 9);
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
  const SampleLines lines = periodic_loops(30, Vec3(-350, -400, -450), Vec3(700, 800, 900), 9);
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
