// Networks on which the fast multipole method is tested and measured.
#pragma once

#include "dd/forces/line_system.h"
#include "samples/random_vectors.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace ddfem::samples
{
/// A network with its surroundings.
struct SampleLines
{
  std::string name;
  Network network;
  std::unique_ptr<GrainShape> shape;
  std::unique_ptr<PeriodicCell> cell;
  std::unique_ptr<PeriodicImages> images;

  LineSystem system() const
  {
    return {copper_like, network, shape.get(), RayDirection::normal, cell.get(), images.get()};
  }
};

/// Adds a circular loop of @p n segments around @p centre.
inline void add_loop(Network &network, const Vec3 &centre, const double radius, const int n, RandomVectors &random)
{
  const Vec3 e1 = random.vector().normalized(), e2 = e1.unitOrthogonal(), b = 0.25 * random.vector().normalized();
  std::vector<NodeIndex> nodes;
  for (int k = 0; k < n; ++k)
  {
    const double angle = 2 * std::numbers::pi * k / n;
    nodes.push_back(network.insert({centre + radius * (std::cos(angle) * e1 + std::sin(angle) * e2)}));
  }
  for (std::size_t k = 0; k < nodes.size(); ++k)
    network.insert(Segment{nodes[k], nodes[(k + 1) % nodes.size()], b, {}});
}

/// Adds a straight line of @p n segments, with ends of the given kind.
inline void add_line(Network &network, const Vec3 &start, const Vec3 &end, const int n, const NodeConstraint ends,
                     const Vec3 &b)
{
  NodeIndex last = network.insert({start, ends});
  for (int k = 1; k <= n; ++k)
  {
    const NodeIndex next = network.insert({start + k * (end - start) / n, k == n ? ends : NodeConstraint::free});
    network.insert(Segment{last, next, b, {}});
    last = next;
  }
}

/// Loops of 16 segments of 25 nm in a cube of 1000 nm.
inline SampleLines random_loops(const int n_loops, const unsigned seed = 3)
{
  SampleLines t{"random", {}, {}, {}, {}};
  RandomVectors random(seed);
  for (int k = 0; k < n_loops; ++k)
    add_loop(t.network, 500 * random.vector(), 65, 16, random);
  return t;
}

/// The same, nine tenths of them in a tenth of the volume.
inline SampleLines clustered_loops(const int n_loops, const unsigned seed = 4)
{
  SampleLines t{"clustered", {}, {}, {}, {}};
  RandomVectors random(seed);
  const double edge = std::cbrt(0.1);
  for (int k = 0; k < n_loops; ++k)
    add_loop(t.network,
             k % 10 == 0 ? Vec3(500 * random.vector())
                         : Vec3(500 * (edge * random.vector() + Vec3::Constant(1 - edge))),
             65, 16, random);
  return t;
}

/// A pillar with loops and with lines that go through its sides and continue as rays.
inline SampleLines pillar(const int n_loops, const int n_lines, const unsigned seed = 5)
{
  SampleLines t{"pillar", {}, std::make_unique<BoxShape>(Vec3(-300, -300, -600), Vec3(300, 300, 600)), {}, {}};
  RandomVectors random(seed);
  for (int k = 0; k < n_loops; ++k)
    add_loop(t.network, random.vector().cwiseProduct(Vec3(230, 230, 530)), 65, 16, random);
  for (int k = 0; k < n_lines; ++k)
    add_line(t.network, Vec3(-300, 300 * random.number(), 550 * random.number()),
             Vec3(300, 300 * random.number(), 550 * random.number()), 24, NodeConstraint::surface,
             0.25 * random.vector().normalized());
  return t;
}

/// A straight segment of 3000 nm among loops of short ones.
inline SampleLines long_line_among_loops(const int n_loops, const unsigned seed = 3)
{
  SampleLines t = random_loops(n_loops, seed);
  t.name = "long line";
  add_line(t.network, Vec3(-1500, 10, 20), Vec3(1500, -50, 30), 1, NodeConstraint::pinned, Vec3(0.25, 0, 0.1));
  return t;
}

/// Loops in a periodic cell.
inline SampleLines periodic_loops(const int n_loops, const Vec3 &origin, const Vec3 &lengths,
                                  const unsigned image_order, const unsigned seed = 6)
{
  SampleLines t{"periodic",
                {},
                {},
                std::make_unique<PeriodicCell>(PeriodicCell{origin, lengths}),
                std::make_unique<PeriodicImages>(origin, lengths, image_order)};
  t.network.set_period(lengths);
  RandomVectors random(seed);
  for (int k = 0; k < n_loops; ++k)
    add_loop(t.network, 0.5 * lengths.cwiseProduct(random.vector()), 65, 16, random);
  return t;
}

/// All networks without periodicity.
inline std::vector<SampleLines> all_finite_systems(const int size)
{
  std::vector<SampleLines> all;
  all.push_back(random_loops(size));
  all.push_back(clustered_loops(size));
  all.push_back(pillar(size * 2 / 3, size / 5));
  all.push_back(long_line_among_loops(size));
  return all;
}

/// Points all over the bounding box of the lines.
inline std::vector<Vec3> points_among(const LineSystem &system, const std::size_t n)
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
} // namespace ddfem::samples
