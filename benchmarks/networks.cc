#include "benchmarks/networks.h"

#include <cmath>
#include <numbers>
#include <random>

namespace ddfem
{
namespace
{
constexpr double width_of_unit = 2000; // nm
constexpr double loop_density = 1e20;  // per m^3
constexpr double loop_radius = 25;     // nm
constexpr double segment_length = 3.3; // nm
constexpr double lines_per_unit = 50;
constexpr double mean_displacement = 0.1; // nm per step
constexpr double burgers = 0.323;         // nm, a of zirconium

class Generator
{
public:
  Generator(double t, unsigned seed) : width_(width_of_unit * std::cbrt(t)), random_(seed)
  {
    const double volume = std::pow(width_ * 1e-9, 3); // m^3
    for (auto n = std::lround(loop_density * volume); n > 0; --n)
      add_loop();
    for (auto n = std::lround(lines_per_unit * t); n > 0; --n)
      add_line();
  }

  /// The network in Morton order, with the displacements of its nodes.
  IrradiatedGrain result()
  {
    IrradiatedGrain grain{std::move(network_), {}};
    grain.network.clean();
    for (const NodeIndex i : grain.network.nodes()) // ids count from zero: they are the indices before clean()
      grain.displacement.push_back(displacement_[grain.network.id(i)]);
    return grain;
  }

private:
  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  Vec3 point() { return {uniform(0, width_), uniform(0, width_), uniform(0, width_)}; }
  /// Unit vector in the basal plane: one of the three close-packed directions, or normal to one.
  Vec3 basal(double degrees) const
  {
    const double angle = degrees * std::numbers::pi / 180;
    return {std::cos(angle), std::sin(angle), 0};
  }

  NodeIndex add_node(const Vec3 &x, NodeConstraint constraint, const Vec3 &moves)
  {
    const double part = constraint == NodeConstraint::pinned ? 0.0 : 0.1 * moves.norm();
    displacement_.emplace_back(moves + part * Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)));
    return network_.insert({x, constraint});
  }

  double distance_per_step() { return std::exponential_distribution<double>(1 / mean_displacement)(random_); }

  /// Loop on a prismatic plane or, one in four, on a basal plane; it glides along its Burgers vector.
  void add_loop()
  {
    const Vec3 centre = point(), b = basal(60.0 * std::floor(uniform(0, 6)));
    const Vec3 normal = uniform(0, 4) < 1 ? Vec3(Vec3::UnitZ()) : basal(30 + 60.0 * std::floor(uniform(0, 6)));
    const Vec3 e1 = normal.unitOrthogonal(), e2 = normal.cross(e1), moves = distance_per_step() * b;
    const auto n = static_cast<int>(std::lround(2 * std::numbers::pi * loop_radius / segment_length));
    NodeIndex first, last;
    for (int k = 0; k < n; ++k)
    {
      const double angle = 2 * std::numbers::pi * k / n;
      const Vec3 x = centre + loop_radius * (std::cos(angle) * e1 + std::sin(angle) * e2);
      const NodeIndex node = add_node(x, NodeConstraint::free, moves);
      if (k == 0)
        first = node;
      else
        network_.insert(Segment{last, node, burgers * b, {}});
      last = node;
    }
    network_.insert(Segment{last, first, burgers * b, {}});
  }

  /// Straight line in a basal plane between two pinned nodes; it glides normal to itself.
  void add_line()
  {
    const Vec3 start = point(), xi = basal(uniform(0, 360)), b = basal(60.0 * std::floor(uniform(0, 6)));
    const Vec3 moves = distance_per_step() * Vec3::UnitZ().cross(xi);
    const double length = uniform(150, 1500);
    const auto n = static_cast<int>(std::lround(length / segment_length));
    NodeIndex last = add_node(start, NodeConstraint::pinned, Vec3::Zero());
    for (int k = 1; k <= n; ++k)
    {
      const bool is_end = k == n;
      const NodeIndex node =
          add_node(start + length * k / n * xi, is_end ? NodeConstraint::pinned : NodeConstraint::free,
                   is_end ? Vec3(Vec3::Zero()) : moves);
      network_.insert(Segment{last, node, burgers * b, {}});
      last = node;
    }
  }

  double width_;
  std::mt19937 random_;
  Network network_;
  std::vector<Vec3> displacement_;
};
} // namespace

IrradiatedGrain irradiated_grain(double t, unsigned seed)
{
  return Generator(t, seed).result();
}
} // namespace ddfem
