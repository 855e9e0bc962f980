#include "benchmarks/networks.h"

#include "dd/crystal/material.h"
#include "dd/crystal/slip_systems.h"
#include "samples/systems_of_lines.h"

#include <cmath>
#include <numbers>
#include <random>

namespace ddfem
{
namespace
{
constexpr double loop_density = 1e20;     // per m^3
constexpr double mean_displacement = 0.1; // nm per step
constexpr double burgers = 0.323;         // nm, a of zirconium

/// Adds loops and lines at random, with their motion.
class Builder
{
public:
  /// @p jitter: motion of every node by itself, relative to that of its line.
  Builder(double width, double segment_length_, double jitter_, unsigned seed)
      : width_(width), segment_length(segment_length_), jitter(jitter_), random_(seed)
  {
  }

  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  Vec3 point() { return {uniform(0, width_), uniform(0, width_), uniform(0, width_)}; }
  /// Unit vector in the basal plane: one of the three close-packed directions, or normal to one.
  static Vec3 basal(double degrees)
  {
    const double angle = degrees * std::numbers::pi / 180;
    return {std::cos(angle), std::sin(angle), 0};
  }
  double distance_per_step() { return std::exponential_distribution<double>(1 / mean_displacement)(random_); }
  long n_loops() const { return std::lround(loop_density * std::pow(width_ * 1e-9, 3)); }

  /// Loop on a prismatic plane or, with the probability @p basal_share, on a basal plane; it glides along its Burgers
  /// vector.
  void add_loop(double radius, double basal_share);
  struct Line
  {
    Vec3 start, xi, burgers, moves;
    double length;
    bool bows; ///< moves most in the middle
  };
  /// Straight line between two pinned nodes.
  void add_line(const Line &line);
  /// Such a line in a basal plane that glides normal to itself.
  void add_basal_line(double shortest, double longest, bool bows);

  /// The network in Morton order, with the displacements of its nodes.
  MovingNetwork result();

private:
  NodeIndex add_node(const Vec3 &x, NodeConstraint constraint, const Vec3 &moves)
  {
    const double part = constraint == NodeConstraint::pinned ? 0.0 : jitter * moves.norm();
    displacement_.emplace_back(moves + part * Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)));
    return network_.insert({x, constraint});
  }

  double width_, segment_length, jitter;
  std::mt19937 random_;
  Network network_;
  std::vector<Vec3> displacement_;
};

void Builder::add_loop(const double radius, const double basal_share)
{
  const Vec3 centre = point(), b = basal(60.0 * std::floor(uniform(0, 6)));
  const Vec3 normal = uniform(0, 1) < basal_share ? Vec3(Vec3::UnitZ()) : basal(30 + 60.0 * std::floor(uniform(0, 6)));
  const Vec3 e1 = normal.unitOrthogonal(), e2 = normal.cross(e1), moves = distance_per_step() * b;
  const auto n = static_cast<int>(std::lround(2 * std::numbers::pi * radius / segment_length));
  NodeIndex first, last;
  for (int k = 0; k < n; ++k)
  {
    const double angle = 2 * std::numbers::pi * k / n;
    const Vec3 x = centre + radius * (std::cos(angle) * e1 + std::sin(angle) * e2);
    const NodeIndex node = add_node(x, NodeConstraint::free, moves);
    if (k == 0)
      first = node;
    else
      network_.insert(Segment{last, node, burgers * b, {}});
    last = node;
  }
  network_.insert(Segment{last, first, burgers * b, {}});
}

void Builder::add_line(const Line &line)
{
  const auto n = static_cast<int>(std::lround(line.length / segment_length));
  NodeIndex last = add_node(line.start, NodeConstraint::pinned, Vec3::Zero());
  for (int k = 1; k <= n; ++k)
  {
    const bool is_end = k == n;
    const double s = static_cast<double>(k) / n, share = line.bows ? 4 * s * (1 - s) : 1;
    const NodeIndex node =
        add_node(line.start + line.length * k / n * line.xi, is_end ? NodeConstraint::pinned : NodeConstraint::free,
                 is_end ? Vec3(Vec3::Zero()) : Vec3(share * line.moves));
    network_.insert(Segment{last, node, line.burgers, {}});
    last = node;
  }
}

void Builder::add_basal_line(const double shortest, const double longest, const bool bows)
{
  Line line{point(), basal(uniform(0, 360)), burgers * basal(60.0 * std::floor(uniform(0, 6))), {}, 0, bows};
  line.moves = distance_per_step() * Vec3::UnitZ().cross(line.xi);
  line.length = uniform(shortest, longest);
  add_line(line);
}

MovingNetwork Builder::result()
{
  MovingNetwork moving{std::move(network_), {}, width_};
  moving.network.clean();
  for (const NodeIndex i : moving.network.nodes()) // ids count from zero: they are the indices before clean()
    moving.displacement.push_back(displacement_[moving.network.id(i)]);
  return moving;
}
} // namespace

MovingNetwork irradiated_grain(const double t, const unsigned seed)
{
  Builder builder(2000 * std::cbrt(t), 3.3, 0.1, seed);
  for (auto n = builder.n_loops(); n > 0; --n)
    builder.add_loop(25, 0.25);
  for (auto n = std::lround(50 * t); n > 0; --n)
    builder.add_basal_line(150, 1500, false);
  return builder.result();
}

MovingNetwork frank_read_sources(const double t, const unsigned seed)
{
  const SlipSystems systems(Lattice::fcc, find_material("aluminium").lattice_parameter);
  Builder builder(2000 * std::cbrt(t), 6, 0, seed);
  const auto n = static_cast<std::size_t>(std::lround(240 * t));
  for (std::size_t k = 0; k < n; ++k)
  {
    const SlipSystem &system = systems[k % systems.size()];
    const double sign = k / systems.size() % 2 == 0 ? 1 : -1, angle = builder.uniform(0, 2 * std::numbers::pi);
    const Vec3 e1 = system.normal.unitOrthogonal(), e2 = system.normal.cross(e1);
    const Vec3 xi = std::cos(angle) * e1 + std::sin(angle) * e2;
    const double length = builder.uniform(500, 1000);
    const Vec3 start = builder.point() - 0.5 * length * xi;
    builder.add_line(
        {start, xi, sign * system.burgers, builder.distance_per_step() * system.normal.cross(xi), length, true});
  }
  return builder.result();
}

MovingNetwork small_loops(const double t, const unsigned seed)
{
  Builder builder(4000 * std::cbrt(t), 3, 0, seed);
  for (auto n = builder.n_loops(); n > 0; --n)
    builder.add_loop(5, 0);
  for (auto n = std::lround(10 * t); n > 0; --n)
    builder.add_basal_line(1000, 1000, true);
  return builder.result();
}

Network random_loops(const std::size_t n_segments, const bool clustered)
{
  constexpr int segments_per_loop = 16;
  constexpr double radius = 65;                     // nm
  constexpr double volume_per_segment = 1e9 / 1600; // nm^3
  samples::RandomVectors random(1);
  const double half = 0.5 * std::cbrt(volume_per_segment * static_cast<double>(n_segments)), part = std::cbrt(0.1);
  Network network;
  for (std::size_t k = 0; k < n_segments / segments_per_loop; ++k)
  {
    const Vec3 place = random.vector();
    const Vec3 centre = half * (clustered && k % 10 != 0 ? Vec3(part * place + Vec3::Constant(1 - part)) : place);
    samples::add_loop(network, centre, radius, segments_per_loop, random);
  }
  network.clean();
  return network;
}
} // namespace ddfem
