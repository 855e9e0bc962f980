#include "fem/interpolated_sum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>

namespace ddfem::fem
{
namespace
{
using Stress = dealii::SymmetricTensor<2, 3>;

/// More nodes in a direction allow nearer sources, but cost as much as halving the box.
constexpr unsigned most_nodes = 8;

struct Cluster
{
  std::vector<unsigned> points, sources;
};

/// Chebyshev nodes of the first kind in the box around some points.
class NodesInBox
{
public:
  NodesInBox(std::span<const dealii::Point<3>> points, const std::vector<unsigned> &numbers)
  {
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    for (const unsigned i : numbers)
    {
      for (unsigned d = 0; d < 3; ++d)
      {
        low[d] = std::min(low[d], points[i][d]);
        high[d] = std::max(high[d], points[i][d]);
      }
    }
  }

  double edge(unsigned d) const { return high[d] - low[d]; }
  double longest() const { return std::max({edge(0), edge(1), edge(2)}); }
  double middle(unsigned d) const { return 0.5 * (low[d] + high[d]); }
  dealii::Point<3> centre() const { return {middle(0), middle(1), middle(2)}; }
  double radius() const { return 0.5 * std::hypot(edge(0), edge(1), edge(2)); }

  /// Numbers of nodes for sources with at least the given smooth length; false if there would be too many.
  bool choose_numbers(double smooth_length, double tolerance)
  {
    if (!(smooth_length > 0.))
    {
      return false;
    }
    for (unsigned d = 0; d < 3; ++d)
    {
      // Rounding gives flat boxes a thickness.
      const bool is_flat = edge(d) <= 1e-9 * longest();
      const double ratio = is_flat ? 0. : 2. * smooth_length / edge(d);
      const double needed = is_flat ? 1. : std::max(1., std::ceil(-std::log(tolerance) / std::asinh(ratio)));
      if (!(needed <= most_nodes))
      {
        return false;
      }
      n[d] = static_cast<unsigned>(needed);
    }
    return true;
  }

  std::size_t size() const { return static_cast<std::size_t>(n[0]) * n[1] * n[2]; }

  /// Of as many nodes as chosen last.
  std::vector<dealii::Point<3>> positions()
  {
    for (unsigned d = 0; d < 3; ++d)
    {
      place_nodes(d);
    }
    std::vector<dealii::Point<3>> result;
    for (unsigned i = 0; i < n[0]; ++i)
    {
      for (unsigned j = 0; j < n[1]; ++j)
      {
        for (unsigned k = 0; k < n[2]; ++k)
        {
          result.emplace_back(node[0][i], node[1][j], node[2][k]);
        }
      }
    }
    return result;
  }

  /// Value at x of the polynomials through the values at these.
  Stress interpolate(const std::vector<Stress> &values, const dealii::Point<3> &x) const
  {
    const auto a = weights(0, x[0]), b = weights(1, x[1]), c = weights(2, x[2]);
    Stress sum;
    std::size_t position = 0;
    for (unsigned i = 0; i < n[0]; ++i)
    {
      for (unsigned j = 0; j < n[1]; ++j)
      {
        for (unsigned k = 0; k < n[2]; ++k)
        {
          sum += a[i] * b[j] * c[k] * values[position++];
        }
      }
    }
    return sum;
  }

private:
  using PerNode = std::array<double, most_nodes>;

  void place_nodes(unsigned d)
  {
    for (unsigned i = 0; i < n[d]; ++i)
    {
      const double angle = std::numbers::pi * (i + 0.5) / n[d];
      node[d][i] = middle(d) + 0.5 * edge(d) * std::cos(angle);
      barycentric[d][i] = (i % 2 == 0 ? 1. : -1.) * std::sin(angle); // Trefethen, eq. 5.15
    }
  }

  /// Lagrange polynomials of a direction at x.
  PerNode weights(unsigned d, double x) const
  {
    PerNode result{};
    double sum = 0.;
    for (unsigned i = 0; i < n[d]; ++i)
    {
      const double distance = x - node[d][i];
      if (distance == 0.)
      {
        result.fill(0.);
        result[i] = 1.;
        return result;
      }
      result[i] = barycentric[d][i] / distance;
      sum += result[i];
    }
    for (unsigned i = 0; i < n[d]; ++i)
    {
      result[i] /= sum;
    }
    return result;
  }

  std::array<double, 3> low, high;
  std::array<unsigned, 3> n{1, 1, 1};
  std::array<PerNode, 3> node, barycentric;
};

/// Points of a cluster by the halves of the box that they are in, along all edges that are long.
std::vector<Cluster> halves(const NodesInBox &box, std::span<const dealii::Point<3>> points, const Cluster &cluster,
                            const std::vector<unsigned> &sources)
{
  std::array<Cluster, 8> parts;
  for (const unsigned i : cluster.points)
  {
    unsigned part = 0;
    for (unsigned d = 0; d < 3; ++d)
    {
      part += box.edge(d) > 0.6 * box.longest() && points[i][d] > box.middle(d) ? 1U << d : 0U;
    }
    parts[part].points.push_back(i);
  }
  std::vector<Cluster> result;
  for (Cluster &part : parts)
  {
    if (!part.points.empty())
    {
      part.sources = sources;
      result.push_back(std::move(part));
    }
  }
  return result;
}

class Summation
{
public:
  Summation(const TractionField &traction_field, std::span<const dealii::Point<3>> positions, double error)
      : field(traction_field), points(positions), tolerance(error), values(positions.size())
  {
  }

  /// Adds what is far from a cluster, or all of it if the cluster is small; returns the parts that remain to be done.
  std::vector<Cluster> add(const Cluster &cluster)
  {
    NodesInBox box(points, cluster.points);
    constexpr std::size_t few = 48;
    if (cluster.points.size() <= few || box.longest() == 0.)
    {
      add_directly(cluster);
      return {};
    }
    std::vector<double> lengths(cluster.sources.size());
    field.smooth_lengths(box.centre(), box.radius(), cluster.sources, lengths);
    std::vector<unsigned> far, near;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < lengths.size(); ++k)
    {
      const bool is_far = box.choose_numbers(lengths[k], tolerance) && 2 * box.size() <= cluster.points.size();
      (is_far ? far : near).push_back(cluster.sources[k]);
      nearest = is_far ? std::min(nearest, lengths[k]) : nearest;
    }
    if (!far.empty())
    {
      box.choose_numbers(nearest, tolerance);
      interpolate(box, far, cluster);
    }
    return near.empty() ? std::vector<Cluster>{} : halves(box, points, cluster, near);
  }

  std::vector<Stress> result() { return std::move(values); }

private:
  void add_directly(const Cluster &cluster)
  {
    std::vector<dealii::Point<3>> positions;
    for (const unsigned i : cluster.points)
    {
      positions.push_back(points[i]);
    }
    std::vector<Stress> stress(positions.size());
    field.add_stress(cluster.sources, positions, stress);
    for (std::size_t k = 0; k < stress.size(); ++k)
    {
      values[cluster.points[k]] += stress[k];
    }
  }

  void interpolate(NodesInBox &box, const std::vector<unsigned> &sources, const Cluster &cluster)
  {
    const auto nodes = box.positions();
    std::vector<Stress> at_nodes(nodes.size());
    field.add_stress(sources, nodes, at_nodes);
    for (const unsigned i : cluster.points)
    {
      values[i] += box.interpolate(at_nodes, points[i]);
    }
  }

  const TractionField &field;
  std::span<const dealii::Point<3>> points;
  double tolerance;
  std::vector<Stress> values; // every point belongs to one cluster at a time
};
} // namespace

std::vector<Stress> interpolated_sum(const TractionField &field, std::span<const unsigned> sources,
                                     std::span<const dealii::Point<3>> points, double tolerance)
{
  Summation sum(field, points, tolerance);
  std::vector<Cluster> level(1);
  level[0].points.resize(points.size());
  std::iota(level[0].points.begin(), level[0].points.end(), 0U);
  level[0].sources.assign(sources.begin(), sources.end());
  while (!level.empty() && !sources.empty() && !points.empty())
  {
    std::vector<std::vector<Cluster>> parts(level.size());
#pragma omp parallel for schedule(dynamic)
    for (std::size_t k = 0; k < level.size(); ++k)
    {
      parts[k] = sum.add(level[k]);
    }
    level.clear();
    for (auto &list : parts)
    {
      std::move(list.begin(), list.end(), std::back_inserter(level));
    }
  }
  return sum.result();
}
} // namespace ddfem::fem
