// Nodal forces of a network against the sum over all pairs, by the scalar reference, one by one.
#include "dd/forces/nodal_forces.h"
#include "dd/microstructure/sources.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <random>
#include <vector>

namespace ddfem
{
namespace
{
const Vec3 size(400, 300, 350);

/// Bowed lines that cross the grain, and loops, one of them within core radii of a line.
Network tangle()
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&](double r)
  {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return Vec3(r * x, r * y, r * z);
  };
  Network network;
  for (int i = 0; i < 6; ++i)
  {
    std::vector<Vec3> line;
    for (int k = 0; k <= 10; ++k)
      line.push_back(Vec3(0.1 * k * size[0], 150, 170) + vector(100).cwiseProduct(Vec3(0.1, 1, 1)));
    line.front()[0] = 0;
    line.back()[0] = size[0];
    add_line(network, line, vector(0.3), {}, false, NodeConstraint::surface);
    const Vec3 centre = 0.5 * size + vector(80), b = vector(0.3);
    add_line(network, {centre, centre + vector(20), centre + vector(20), line[5] + vector(0.5)}, b, {}, true,
             NodeConstraint::free);
  }
  return network;
}

ForceSettings settings()
{
  ForceSettings s;
  s.medium = {50e3, 0.3, 0.4};
  s.core_cutoff_radius = 0.1;
  return s;
}

/// Largest difference of nodal forces, over the largest force.
double difference(const std::vector<Vec3> &f, const std::vector<Vec3> &g)
{
  double error = 0, scale = 0;
  for (std::size_t i = 0; i < f.size(); ++i)
  {
    error = std::max(error, (f[i] - g[i]).norm());
    scale = std::max(scale, g[i].norm());
  }
  return error / scale;
}

/// Adds @p force of each line, a function of its number, at its nodes.
template <class Force> std::vector<Vec3> at_nodes(const Network &network, Force &&force)
{
  std::vector<Vec3> sum(network.node_capacity(), Vec3::Zero());
  std::size_t i = 0;
  for (const SegmentIndex s : network.segments())
  {
    const SegmentForces f = force(i++);
    sum[network.start(s).value] += f.start;
    sum[network.end(s).value] += f.end;
  }
  return sum;
}

const std::vector<Vec3> &of(const NodalForces &forces, const ForceContribution c)
{
  return forces.by_contribution[static_cast<std::size_t>(c)];
}

void add(SegmentForces &sum, const SegmentForces &f)
{
  sum.start += f.start;
  sum.end += f.end;
}
} // namespace

// To rounding: the same formula at the same Gauss points (tests/dd/elasticity/force_kernels_test.cc states the bound).
TEST(NodalForces, OfPairsAndRaysAreTheSumOfTheReference)
{
  const Network network = tangle();
  const BoxShape shape(Vec3::Zero(), size);
  const ForceSettings s = settings();
  const LineSystem lines(s.medium, network, &shape, s.ray_direction, nullptr, nullptr);
  ForceEnvironment environment;
  environment.shape = &shape;
  const NodalForces forces = compute_nodal_forces(network, s, environment, MPI_COMM_SELF, true);
  const auto pairs = at_nodes(
      network,
      [&](const std::size_t i)
      {
        const StraightLine &l = lines.lines()[i];
        SegmentForces sum;
        for (std::size_t j = 0; j < lines.lines().size(); ++j)
          if (const StraightLine &k = lines.lines()[j]; j != i)
            add(sum, segment_force(s.medium, k.start, k.end, k.burgers, l.start, l.end, l.burgers, s.pair_tolerance));
        return sum;
      });
  const auto rays = at_nodes(network,
                             [&](const std::size_t i)
                             {
                               const StraightLine &l = lines.lines()[i];
                               SegmentForces sum;
                               for (const VirtualRay &r : lines.rays())
                                 add(sum, segment_force_from_ray(s.medium, r.origin, r.direction, r.burgers, l.start,
                                                                 l.end, l.burgers, s.pair_tolerance));
                               return sum;
                             });
  EXPECT_LT(difference(of(forces, ForceContribution::pairs), pairs), 1e-12);
  EXPECT_LT(difference(of(forces, ForceContribution::rays), rays), 1e-12);
}

TEST(NodalForces, OfNearImagesAreTheSumOfTheReference)
{
  Network network = tangle();
  const PeriodicCell cell{Vec3::Zero(), size};
  PeriodicImages images(cell.origin, cell.lengths);
  const ForceSettings s = settings();
  ForceEnvironment environment;
  environment.cell = &cell;
  environment.images = &images;
  const NodalForces forces = compute_nodal_forces(network, s, environment, MPI_COMM_SELF, true);
  const LineSystem lines(s.medium, network, nullptr, s.ray_direction, &cell, &images);
  const auto expected = at_nodes(
      network,
      [&](const std::size_t i)
      {
        const StraightLine &l = lines.lines()[i];
        SegmentForces sum;
        for (const StraightLine &k : lines.lines())
          for (std::size_t n = 1; n < lines.image_shifts().size(); ++n)
          {
            const Vec3 &shift = lines.image_shifts()[n];
            add(sum, segment_force(s.medium, k.start + shift, k.end + shift, k.burgers, l.start, l.end, l.burgers,
                                   s.pair_tolerance));
          }
        const Vec3 t = l.end - l.start;
        // Far images: three Gauss points, as in nodal_forces.cc.
        const double at[] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)}, weight[] = {5. / 18, 8. / 18, 5. / 18};
        for (int q = 0; q < 3; ++q)
        {
          const Vec3 f = weight[q] * contract(images.far_stress(l.start + at[q] * t), l.burgers).cross(t);
          add(sum, {(1 - at[q]) * f, at[q] * f});
        }
        return sum;
      });
  EXPECT_LT(difference(of(forces, ForceContribution::images), expected), 1e-12);
}

TEST(NodalForces, AreTheSameBitsOnAnyNumberOfThreads)
{
  const Network network = tangle();
  const BoxShape shape(Vec3::Zero(), size);
  ForceEnvironment environment;
  environment.shape = &shape;
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const NodalForces one = compute_nodal_forces(network, settings(), environment, MPI_COMM_SELF);
  omp_set_num_threads(3);
  const NodalForces three = compute_nodal_forces(network, settings(), environment, MPI_COMM_SELF);
  omp_set_num_threads(threads);
  EXPECT_EQ(one.total, three.total);
}
} // namespace ddfem
