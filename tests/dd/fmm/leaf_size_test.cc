// The root of the tree that meets the size of its leaves.
#include "dd/fmm/grids_and_rays.h"
#include "dd/fmm/leaf_size.h"
#include "samples/systems_of_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace ddfem::fmm
{
namespace
{
constexpr double width = 1000;

/// Uniform in a cube of `width` around @p centre.
std::vector<SourceExtent> random_sources(const std::size_t n, const Vec3 &centre = Vec3::Zero())
{
  samples::RandomVectors random(3);
  std::vector<SourceExtent> sources;
  for (std::size_t k = 0; k < n; ++k)
    sources.push_back({centre + 0.5 * width * random.vector(), 1.0});
  return sources;
}

TEST(LeafSize, HoldsTheWantedNumberOfUniformSources)
{
  for (const std::size_t n : {3000U, 20000U, 90000U}) // the last is sampled
    for (const double wanted : {10.0, 25.0, 60.0})
    {
      const std::vector<SourceExtent> sources = random_sources(n);
      const double leaf = suitable_leaf_size(sources, Vec3::Constant(-0.5 * width), width, wanted);
      // Cells of a volume with a boundary hold as many in the mean; fluctuations are below 3 %.
      EXPECT_NEAR(static_cast<double>(n) * std::pow(leaf / width, 3), wanted, 0.1 * wanted) << n;
    }
}

TEST(LeafSize, IsThatOfTheClusterWhereMostSourcesAre)
{
  std::vector<SourceExtent> sources = random_sources(20000);
  for (std::size_t k = 2000; k < sources.size(); ++k)
    sources[k].middle *= 0.3;
  const double leaf = suitable_leaf_size(sources, Vec3::Constant(-0.5 * width), width, 20);
  // Not 30 times as many, as the mean over the whole volume suggests; the cells that the surface of the cluster cuts hold fewer lines.
  const double held = 18000 * std::pow(leaf / (0.3 * width), 3);
  EXPECT_GT(held, 18);
  EXPECT_LT(held, 40);
}

TEST(LeafSize, DoesNotSeeTheNeighboursOnOneCurve)
{
  std::vector<SourceExtent> sources;
  for (const SourceExtent &s : random_sources(1500))
    for (int k = 0; k < 16; ++k) // as a small loop
      sources.push_back({s.middle + Vec3(0.1 * k, 0, 0), 0.1});
  const double leaf = suitable_leaf_size(sources, Vec3::Constant(-0.5 * width), width, 25);
  EXPECT_NEAR(static_cast<double>(sources.size()) * std::pow(leaf / width, 3), 25, 5);
}

TEST(LeafSize, DividesTheBodyIntoWholeLeaves)
{
  for (const std::size_t n : {500U, 5000U, 20000U, 50000U})
  {
    const std::vector<SourceExtent> sources = random_sources(n, Vec3(300, -200, 50));
    const RootGrid plain = enclosing_grid(sources, {}, {}), fitted = enclosing_grid(sources, {}, {}, 20);
    const double leaf = suitable_leaf_size(sources, plain.origin, plain.edges[0], 20);
    const double levels = std::round(std::log2(fitted.edges[0] / leaf));
    const double nearest = std::ldexp(fitted.edges[0], -static_cast<int>(levels)), n_leaves = plain.edges[0] / nearest;
    EXPECT_NEAR(n_leaves, std::round(n_leaves), 1e-6) << n;
    EXPECT_NEAR(nearest / leaf, 1, 0.5 / n_leaves + 0.02) << n; // between two whole numbers
    EXPECT_GE(fitted.edges[0], plain.edges[0] * (1 - 1e-6));
    EXPECT_LT(fitted.edges[0], 2.001 * plain.edges[0]);
    for (const SourceExtent &s : sources)
    {
      EXPECT_GE((s.middle - fitted.origin).minCoeff(), 0);
      EXPECT_LE((s.middle - fitted.origin - plain.edges).maxCoeff(), 1e-6);
    }
  }
}

TEST(LeafSize, KeepsTheCentreOfTheRootWithRays)
{
  const std::vector<SourceExtent> sources = random_sources(5000);
  const std::vector<RaySource> rays{{Vec3(0, 0, 100), Vec3(0, 0, 1), Vec3(1, 0, 0)}};
  const RootGrid plain = enclosing_grid(sources, rays, {}), fitted = enclosing_grid(sources, rays, {}, 20);
  EXPECT_LT((plain.origin + 0.5 * plain.edges - fitted.origin - 0.5 * fitted.edges).norm(), 1e-6);
  // The body lies in the eight boxes of this level at the centre.
  EXPECT_GE(std::ldexp(fitted.edges[0], -level_of_distant_rays), 0.125 * plain.edges[0] * (1 - 1e-6));
}

TEST(LeafSize, DividesPeriodicCellsByThreeWhereThatIsBetter)
{
  const Vec3 origin = Vec3::Constant(-0.5 * width), lengths = Vec3::Constant(width);
  for (const std::size_t n : {4096U, 20000U}) // 16 and 24 leaves along an edge
  {
    const std::vector<SourceExtent> sources = random_sources(n);
    const RootGrid grid = periodic_grid(origin, lengths, sources, n == 4096 ? 1 : 20000.0 / (24 * 24 * 24));
    EXPECT_EQ(grid.n[0], n == 4096 ? 1 : 3);
    EXPECT_EQ(grid.n[1], grid.n[0]);
    EXPECT_TRUE(grid.periodic);
    EXPECT_NEAR(grid.edges[2] * grid.n[2], width, 1e-9);
  }
}
} // namespace
} // namespace ddfem::fmm
