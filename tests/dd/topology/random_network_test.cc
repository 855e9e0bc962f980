// Random networks moved at random with every operation: all invariants hold after each step.
#include "dd/crystal/product_plane.h"
#include "dd/topology/collisions/moving_lines.h"
#include "dd/topology/remesh.h"
#include "tests/dd/topology/random_networks.h"
#include "tests/dd/topology/topology_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

namespace ddfem
{
namespace
{
enum class Body
{
  periodic,
  box,     ///< five free faces, one impenetrable
  cylinder ///< free
};

struct RandomNetwork : TopologyFixture
{
  SlipSystems systems{Lattice::fcc, 0.405};
  CandidateList candidates;
  std::unique_ptr<GrainShape> grain;
  SymTensor strain = SymTensor::Zero();

  RandomNetwork(const std::size_t n_segments, const double density, const Body body)
  {
    settings = {10, 30, 1, 1.25};
    settings.max_area = 180;
    const double segment = 18;
    const double width = std::cbrt(static_cast<double>(n_segments) * segment / density);
    if (body == Body::periodic)
      network.set_period(Vec3(width, width, width));
    else if (body == Body::box)
    {
      grain = std::make_unique<BoxShape>(Vec3(0, 0, 0), Vec3(width, width, width));
      grain->set_face_kind(4, FaceKind::impenetrable);
    }
    else
      grain = std::make_unique<CylinderShape>(Vec3(width / 2, width / 2, 0), width / 2, width);
    shape = grain.get();
    Random random(n_segments);
    add_random_lines(network, systems, random, width, segment, n_segments, shape);
  }

  void step(const std::uint64_t k)
  {
    TopologyContext c = context();
    c.remaining = random_displacements(network, k, 0.5 * settings.min_segment, shape);
    c.product_plane = [this](Network &n, const Vec3 &xi, const Vec3 &b, const Vec3 &x)
    {
      const auto p = product_plane(systems, xi, b);
      return p ? n.planes().find_or_insert(systems.planes()[*p].miller, systems.planes()[*p].normal, x) : PlaneIndex{};
    };
    move_lines(c, candidates);
    remesh(c);
    strain += plastic_strain_volume(swept);
    swept.clear();
    if (network.node_capacity() > 2 * network.n_nodes() + 64)
      network.clean();
    check();
  }

  void check() const
  {
    network.check_invariants(1e-5);
    if (!shape)
      return;
    for (const NodeIndex i : network.nodes())
    {
      const double outside = shape->signed_distance(network.position(i));
      const bool surface = network.constraint(i) == NodeConstraint::surface;
      if (outside > 1e-6 || (surface && outside < -1e-6))
        throw std::runtime_error(name_of(network.constraint(i)) + (" node " + std::to_string(network.id(i))) +
                                 " lies " + std::to_string(outside) + " nm outside the grain");
    }
  }
};

class RandomNetworkIn : public testing::TestWithParam<Body>
{
};

TEST_P(RandomNetworkIn, KeepsAllInvariantsInEveryStep)
{
  RandomNetwork f(1000, 3e-4, GetParam());
  for (std::uint64_t k = 0; k < 200; ++k)
  {
    ASSERT_NO_THROW(f.step(k)) << "step " << k;
    if (k % 20 == 0)
      std::cout << k << " segs " << f.network.n_segments() << " coll " << f.counts.collisions << " ann "
                << f.counts.annihilations << " ref " << f.counts.refinements << " coars " << f.counts.coarsenings
                << " exits " << f.counts.surface_exits << " builds " << f.candidates.statistics().builds << " skin "
                << f.candidates.statistics().skin << " pairs " << f.candidates.pairs().size() << std::endl;
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, RandomNetworkIn, testing::Values(Body::periodic, Body::box, Body::cylinder));
} // namespace
} // namespace ddfem
