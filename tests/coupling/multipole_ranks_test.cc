// The fast multipole method on several ranks.
#include "dd/forces/far_field_cache.h"
#include "dd/forces/nodal_forces.h"
#include "samples/systems_of_lines.h"

#include <gtest/gtest.h>

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
