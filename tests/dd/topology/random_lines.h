// Random walks of segments that move, are edited at random, and live in free space or a periodic cell.
#pragma once

#include "dd/network/network.h"

#include <random>
#include <set>
#include <utility>
#include <vector>

namespace ddfem
{
/// A network of random walks, with random motion and edits.
class RandomLines
{
public:
  Network network;
  std::vector<Vec3> displacement;

  RandomLines(unsigned seed, std::size_t n_lines, std::size_t n_per_line, double box, const Vec3 &period)
      : random_(seed), longest_(period.isZero() ? 80 : 25)
  {
    network.set_period(period);
    for (std::size_t l = 0; l < n_lines; ++l)
    {
      Vec3 x = 0.5 * box * (Vec3::Ones() + vector(1));
      NodeIndex last = network.insert({image(x)});
      Vec3 direction = vector(1).normalized();
      for (std::size_t k = 0; k < n_per_line; ++k)
      {
        direction = (direction + 0.4 * vector(1)).normalized();
        x += uniform(5, 20) * direction;
        const NodeIndex next = network.insert({image(x)});
        network.insert(Segment{last, next, Vec3::UnitX(), {}});
        last = next;
      }
    }
  }

  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  Vec3 vector(double r) { return {uniform(-r, r), uniform(-r, r), uniform(-r, r)}; }
  std::size_t pick(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }
  SegmentIndex any_segment() { return network.segments()[pick(network.n_segments())]; }

  /// Some image of @p x, up to five periods away.
  Vec3 image(const Vec3 &x)
  {
    Vec3 y = x;
    for (int d = 0; d < 3; ++d)
      y[d] += (static_cast<double>(pick(11)) - 5) * network.period()[d];
    return y;
  }

  /// Random displacements of up to @p size; one in @p rare of ten times as much.
  void draw_motion(double size, std::size_t rare)
  {
    displacement.assign(network.node_capacity(), Vec3::Zero());
    for (Vec3 &d : displacement)
      d = vector(pick(rare) == 0 ? 10 * size : size);
  }

  /// The same displacement for all.
  void shift(const Vec3 &d) { displacement.assign(network.node_capacity(), d); }

  void move()
  {
    for (const NodeIndex i : network.nodes())
      network.set_position(i, network.position(i) + displacement[i.value]);
  }

  SegmentIndex split(SegmentIndex s)
  {
    const Segment old = network[s];
    const NodeIndex middle = network.insert({network.position(old.start) + 0.5 * network.direction(s)});
    network.erase(s);
    network.insert(Segment{old.start, middle, old.burgers, old.plane});
    return network.insert(Segment{middle, old.end, old.burgers, old.plane});
  }

  void edit()
  {
    const std::vector<SegmentIndex> all(network.segments().begin(), network.segments().end());
    for (const SegmentIndex s : all)
      if (network.length(s) > longest_)
        network.erase(s);
    for (std::size_t n = pick(4); n > 0; --n)
      network.erase(any_segment());
    for (std::size_t n = pick(4); n > 0; --n)
      split(any_segment());
    for (std::size_t n = pick(4); n > 0; --n)
    {
      const NodeIndex end = network.nodes()[pick(network.n_nodes())];
      const NodeIndex start = network.insert({image(network.position(end) + vector(8))});
      network.insert(Segment{start, end, Vec3::UnitY(), {}});
    }
  }

  /// Ends of a segment when its nodes have covered the given parts of their way.
  std::pair<Vec3, Vec3> ends(SegmentIndex s, const std::vector<double> &part) const
  {
    const NodeIndex a = network.start(s), b = network.end(s);
    const Vec3 x = network.position(a) + part[a.value] * displacement[a.value];
    const Vec3 d = network.direction(s) + part[b.value] * displacement[b.value] - part[a.value] * displacement[a.value];
    return {x, x + d};
  }

  static constexpr int n_moments = 5;
  /// Moment @p k of n_moments: every node at the same part of its way, or each at another.
  std::vector<double> parts(int k)
  {
    std::vector<double> part(network.node_capacity(), 0.5 * k);
    if (k > 2)
      for (double &p : part)
        p = uniform(0, 1);
    return part;
  }

private:
  std::mt19937 random_;
  double longest_; ///< well below half of the smallest period, nm
};

/// Whether two segments have a node in common.
inline bool adjacent(const Network &network, SegmentIndex a, SegmentIndex b)
{
  const std::set<NodeIndex> nodes{network.start(a), network.end(a), network.start(b), network.end(b)};
  return nodes.size() < 4;
}
} // namespace ddfem
