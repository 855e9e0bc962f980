// The fast multipole method on several ranks.
#include "dd/common/parallel.h"
#include "dd/forces/far_field_cache.h"
#include "dd/forces/multipole_forces.h"
#include "dd/forces/nodal_forces.h"
#include "samples/systems_of_lines.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <numeric>

namespace ddfem
{
namespace
{
TEST(MultipoleRanks, ForcesAndStressesAreTheSameBitsOnAnyNumberOfRanks)
{
  const samples::SampleLines lines = samples::clustered_loops(100);
  const LineSystem system = lines.system();
  ForceSettings settings{samples::copper_like, samples::copper_like.a, 1e-4};
  settings.summation.method = SummationMethod::multipole;
  const auto alone = compute_nodal_forces(lines.network, settings, {}, MPI_COMM_SELF).total;
  const auto together = compute_nodal_forces(lines.network, settings, {}, MPI_COMM_WORLD).total;
  EXPECT_TRUE(alone == together);

  std::vector<Vec3> points;
  samples::RandomVectors random(1);
  for (int k = 0; k < 1000; ++k)
    points.push_back(500 * random.vector());
  const auto field = [&](MPI_Comm comm) { return MultipoleField(system, points, {1e-3}).stress(comm); };
  EXPECT_TRUE(field(MPI_COMM_SELF) == field(MPI_COMM_WORLD));
}

/// Networks in free space, with rays, and in a periodic cell.
std::vector<samples::SampleLines> all_surroundings()
{
  std::vector<samples::SampleLines> all;
  all.push_back(samples::clustered_loops(100));
  all.push_back(samples::pillar(60, 20));
  all.push_back(samples::long_line_among_loops(80)); // of many panels
  all.push_back(samples::periodic_loops(60, Vec3(-500, -550, -450), Vec3(1000, 1100, 900), 7));
  return all;
}

NodalForces forces_of(const samples::SampleLines &lines, MPI_Comm comm, const std::shared_ptr<fmm::WorkCosts> &costs,
                      const bool with_contributions = false)
{
  ForceSettings settings{samples::copper_like, samples::copper_like.a, 1e-4};
  settings.summation.method = SummationMethod::multipole;
  ForceEnvironment environment;
  environment.shape = lines.shape.get();
  environment.cell = lines.cell.get();
  environment.images = lines.images.get();
  environment.costs = costs;
  return compute_nodal_forces(lines.network, settings, environment, comm, with_contributions);
}

bool same(const SegmentForces &a, const SegmentForces &b)
{
  return a.start == b.start && a.end == b.end;
}

TEST(MultipoleRanks, ForcesAreTheSameBitsInAnySurroundingsOnAnyNumberOfRanksAndThreads)
{
  for (const samples::SampleLines &lines : all_surroundings())
  {
    omp_set_num_threads(1);
    const NodalForces alone = forces_of(lines, MPI_COMM_SELF, nullptr);
    const auto costs = std::make_shared<fmm::WorkCosts>(); // of the evaluations so far: the shares change
    for (const int n_threads : {1, 2, 2})
    {
      omp_set_num_threads(n_threads);
      const NodalForces together = forces_of(lines, MPI_COMM_WORLD, costs);
      EXPECT_TRUE(alone.total == together.total) << lines.name << ", " << n_threads << " threads";
      EXPECT_TRUE(std::equal(alone.segment_ends.begin(), alone.segment_ends.end(), together.segment_ends.begin(), same))
          << lines.name;
    }
    const NodalForces in_parts = forces_of(lines, MPI_COMM_WORLD, costs, true);
    EXPECT_TRUE(alone.total == in_parts.total) << lines.name;
    EXPECT_TRUE(in_parts.by_contribution == forces_of(lines, MPI_COMM_SELF, nullptr, true).by_contribution)
        << lines.name;
  }
}

TEST(MultipoleRanks, LinesAreOwnedOnceAndStressesTravelWhereSharesMeet)
{
  const samples::SampleLines lines = samples::clustered_loops(100);
  const LineSystem system = lines.system();
  const MultipoleForces forces(system, {1e-3}, 1e-4, MPI_COMM_WORLD);
  const Rank rank = rank_of(MPI_COMM_WORLD);
  ASSERT_EQ(forces.shares().begin.size(), static_cast<std::size_t>(rank.n) + 1);
  std::vector<std::uint32_t> numbers(system.lines().size()), owned = forces.shares().lines;
  std::iota(numbers.begin(), numbers.end(), 0U);
  std::sort(owned.begin(), owned.end());
  EXPECT_TRUE(owned == numbers);
  const std::vector<std::size_t> sent = gather_one(forces.spent().n_stresses_sent, MPI_COMM_WORLD);
  const std::size_t n_sent = std::accumulate(sent.begin(), sent.end(), std::size_t{0});
  EXPECT_EQ(n_sent > 0, rank.n > 1);
  EXPECT_LT(n_sent, system.lines().size() / 4); // of two points each
}

TEST(MultipoleRanks, SharesFollowMeasuredCostsAndResultsDoNot)
{
  const samples::SampleLines lines = samples::clustered_loops(100);
  const LineSystem system = lines.system();
  const auto forces = [&](const double per_translation)
  {
    fmm::MultipoleSettings settings{1e-3, 0, 0.1}; // many small leaves
    settings.costs = std::make_shared<fmm::WorkCosts>();
    settings.costs->begin_evaluation(1, per_translation);
    for (const double points : {10., 20., 30.})
      settings.costs->add_leaf({1, points, 1000}, 1e-3 * points);
    return MultipoleForces(system, settings, 1e-4, MPI_COMM_WORLD);
  };
  const MultipoleForces by_points = forces(0), by_translations = forces(1000);
  const Rank rank = rank_of(MPI_COMM_WORLD);
  const auto n = static_cast<double>(system.lines().size());
  for (std::size_t r = 0; r < by_points.shares().begin.size(); ++r)
    EXPECT_NEAR(static_cast<double>(by_points.shares().begin[r]), n * static_cast<double>(r) / rank.n, 0.05 * n);
  EXPECT_EQ(by_points.shares().begin != by_translations.shares().begin, rank.n > 1);
  std::size_t n_common = 0;
  for (const std::uint32_t i : by_points.shares().of(rank.mine))
    for (const std::uint32_t j : by_translations.shares().of(rank.mine))
      if (i == j)
      {
        ++n_common;
        EXPECT_TRUE(same(by_points(i), by_translations(i))) << i;
      }
  EXPECT_GT(n_common, 0U);
}

void check_kept_far_field(samples::SampleLines lines)
{
  ForceSettings settings{samples::copper_like, samples::copper_like.a, 1e-4};
  settings.summation.method = SummationMethod::multipole;
  FarFieldCache cache_alone({FarFieldRefresh::adaptive}), cache_together({FarFieldRefresh::adaptive});
  for (int step = 0; step < 6; ++step)
  {
    const auto forces = [&](FarFieldCache &cache, MPI_Comm comm)
    {
      cache.begin_step();
      ForceEnvironment environment;
      environment.far_field = &cache;
      environment.shape = lines.shape.get();
      environment.cell = lines.cell.get();
      environment.images = lines.images.get();
      return compute_nodal_forces(lines.network, settings, environment, comm).total;
    };
    EXPECT_TRUE(forces(cache_alone, MPI_COMM_SELF) == forces(cache_together, MPI_COMM_WORLD)) << step;
    for (const NodeIndex i : lines.network.nodes())
    {
      samples::RandomVectors random(i.value + 1);
      if (lines.network.constraint(i) == NodeConstraint::free)
        lines.network.set_position(i, lines.network.position(i) + 0.1 * random.vector());
    }
  }
  EXPECT_GT(cache_together.counts().kept, 0U);
  EXPECT_EQ(cache_together.counts().kept, cache_alone.counts().kept);
}

TEST(MultipoleRanks, AKeptFarFieldGivesTheSameBitsOnAnyNumberOfRanks)
{
  check_kept_far_field(samples::clustered_loops(150));
  check_kept_far_field(samples::pillar(100, 30));
  check_kept_far_field(samples::periodic_loops(100, Vec3::Constant(-500), Vec3::Constant(1000), 7));
}

TEST(MultipoleRanks, MorePartsThanLeavesAreEmpty)
{
  const samples::SampleLines lines = samples::random_loops(1);
  const LineSystem system = lines.system();
  const std::vector<Vec3> points{Vec3(1, 2, 3)};
  const auto value = MultipoleField(system, points, {1e-6}).stress(MPI_COMM_WORLD); // in double precision
  EXPECT_LT((value[0] - system.stress(points[0])).norm(), 1e-12 * value[0].norm());
}
} // namespace
} // namespace ddfem
