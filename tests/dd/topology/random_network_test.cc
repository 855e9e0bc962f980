// Random networks moved at random with every operation: all invariants hold after each step.
#include "dd/topology/collisions/moving_lines.h"
#include "dd/topology/remesh.h"
#include "tests/dd/topology/random_networks.h"
#include "tests/dd/topology/topology_fixture.h"

#include <gtest/gtest.h>

#include <chrono>
#include <iostream>

namespace ddfem
{
namespace
{
struct RandomNetwork : TopologyFixture
{
  SlipSystems systems{Lattice::fcc, 0.405};
  CandidateList candidates;
  double width;
  SymTensor strain = SymTensor::Zero();

  RandomNetwork(const std::size_t n_segments, const double density, const bool periodic)
  {
    settings = {10, 30, 1, 1.25};
    settings.max_area = 180;
    const double segment = 18;
    width = std::cbrt(static_cast<double>(n_segments) * segment / density);
    if (periodic)
      network.set_period(Vec3(width, width, width));
    Random random(n_segments);
    add_random_lines(network, systems, random, width, segment, n_segments, periodic ? 0 : 110);
  }

  void step(const std::uint64_t k)
  {
    TopologyContext c = context();
    c.remaining = random_displacements(network, k, 0.5 * settings.min_segment, shape);
    c.product_plane = [this](Network &n, const Vec3 &xi, const Vec3 &b, const Vec3 &x)
    {
      for (const std::size_t p : systems.glissile_planes(b))
        if (const SlipPlane &plane = systems.planes()[p]; std::abs(plane.normal.dot(xi)) < 1e-4)
          return n.planes().find_or_insert(plane.miller, plane.normal, x);
      return PlaneIndex{};
    };
    move_lines(c, candidates);
    remesh(c);
    strain += plastic_strain_volume(swept);
    swept.clear();
    if (network.node_capacity() > 2 * network.n_nodes() + 64)
      network.clean();
    network.check_invariants(1e-5);
  }
};

TEST(RandomNetwork, KeepsAllInvariantsInAPeriodicCell)
{
  RandomNetwork f(2000, 3e-4, true);
  for (std::uint64_t k = 0; k < 200; ++k)
  {
    f.step(k);
    if (k % 20 == 0)
      std::cout << k << " segs " << f.network.n_segments() << " coll " << f.counts.collisions << " ann "
                << f.counts.annihilations << " ref " << f.counts.refinements << " coars " << f.counts.coarsenings
                << " builds " << f.candidates.statistics().builds << " skin " << f.candidates.statistics().skin
                << " pairs " << f.candidates.pairs().size() << std::endl;
  }
}
} // namespace
} // namespace ddfem
