#include "dd/forces/periodic_images.h"

#include "dd/elasticity/gauss.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace ddfem
{
namespace
{
constexpr unsigned max_order = 32;
// On the longer axes of an elongated cell.
constexpr unsigned max_axis_order = 128;

// The nodes an axis needs for the accuracy of the shortest one. The convergence rate is that of the Bernstein ellipse
// through the nearest singularities x +- i d, where d is the smallest distance of a far image across the axis:
// rho = delta + sqrt(1 + delta^2), delta = d / half width of the axis.
unsigned axis_order(unsigned order, double shortest, double length, double margin)
{
  const double delta = (1 - 2 * margin) / (0.5 + margin);
  const double scaled = order * std::asinh(delta) / std::asinh(delta * shortest / length);
  return std::min(static_cast<unsigned>(std::ceil(scaled - 1e-9)), max_axis_order);
}

// Applies @p matrix along one axis of an array over nodes (rows, z fastest) with any number of columns.
Eigen::MatrixXd along_axis(const Eigen::MatrixXd &values, const Eigen::MatrixXd &matrix, unsigned stride)
{
  const Eigen::Index order = matrix.rows(), step = stride;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(values.rows(), values.cols());
  for (Eigen::Index first = 0; first < values.rows(); first += order * step)
    for (Eigen::Index p = 0; p < order; ++p)
      for (Eigen::Index k = 0; k < order; ++k)
        result.middleRows(first + p * step, step) += matrix(p, k) * values.middleRows(first + k * step, step);
  return result;
}

// Gauss rule and number of equal pieces that integrate the far field of an element to about 1e-6; @p extent is its
// length in units of the cell edges.
std::pair<int, int> points_and_pieces(double extent)
{
  if (extent < 0.002)
    return {1, 1};
  if (extent < 0.05)
    return {2, 1};
  return {3, static_cast<int>(std::ceil(5 * extent))};
}

// Sums over the sources that the stress at one node needs. With g_i = d_i lap F, c_i = eps_imk A_mk:
// rotation_ab = (g x A_.b)_a + (a <-> b), hessian_ab = c_i d_i d_a d_b F, in the order xx yy zz xy xz yz.
struct NodeSums
{
  double rotation[6] = {}, hessian[6] = {};

  void add(const ThirdDerivatives &f, const std::array<double, 9> &a)
  {
    const double c0 = a[5] - a[7], c1 = a[6] - a[2], c2 = a[1] - a[3];
    hessian[0] += f[0] * c0 + f[1] * c1 + f[2] * c2;
    hessian[1] += f[3] * c0 + f[6] * c1 + f[7] * c2;
    hessian[2] += f[5] * c0 + f[8] * c1 + f[9] * c2;
    hessian[3] += f[1] * c0 + f[3] * c1 + f[4] * c2;
    hessian[4] += f[2] * c0 + f[4] * c1 + f[5] * c2;
    hessian[5] += f[4] * c0 + f[7] * c1 + f[8] * c2;
    const double g0 = f[0] + f[3] + f[5], g1 = f[1] + f[6] + f[8], g2 = f[2] + f[7] + f[9];
    rotation[0] += 2 * (g1 * a[6] - g2 * a[3]);
    rotation[1] += 2 * (g2 * a[1] - g0 * a[7]);
    rotation[2] += 2 * (g0 * a[5] - g1 * a[2]);
    rotation[3] += g1 * a[7] - g0 * a[6] + g2 * (a[0] - a[4]);
    rotation[4] += g0 * a[3] - g2 * a[5] + g1 * (a[8] - a[0]);
    rotation[5] += g2 * a[2] - g1 * a[1] + g0 * (a[4] - a[8]);
  }

  SymTensor stress(const IsotropicMedium &medium) const
  {
    const double factor = medium.mu / (8 * std::numbers::pi), edge_factor = 2 * factor / (1 - medium.nu);
    const double trace = hessian[0] + hessian[1] + hessian[2];
    SymTensor s;
    for (int c = 0; c < 6; ++c)
      s[c] = factor * rotation[c] + edge_factor * (hessian[c] - (c < 3 ? trace : 0.0));
    return s;
  }
};
} // namespace

double PeriodicImages::Axis::node(unsigned p) const
{
  return half_width * std::cos((2 * p + 1) * std::numbers::pi / (2 * order));
}

void PeriodicImages::Axis::polynomials(double x, double *values) const
{
  const double u = (x - centre) / half_width;
  values[0] = 1;
  values[1] = u;
  for (unsigned k = 2; k < order; ++k)
    values[k] = 2 * u * values[k - 1] - values[k - 2];
}

// Interpolation weight of node p at x: 1/m + 2/m sum_{k=1}^{m-1} T_k(x_p) T_k(x).
void PeriodicImages::Axis::tabulate_weights()
{
  moments_to_nodes.resize(order, order);
  for (unsigned p = 0; p < order; ++p)
    for (unsigned k = 0; k < order; ++k)
      moments_to_nodes(p, k) =
          (k == 0 ? 1.0 : 2.0) / order * std::cos(k * (2 * p + 1) * std::numbers::pi / (2 * order));
}

// The nodes descend and are symmetric about the centre: (i, j), (j, i) and their mirror images (m-1-j, m-1-i) share one
// distance.
void PeriodicImages::Axis::tabulate_differences()
{
  std::map<std::pair<unsigned, unsigned>, unsigned> known;
  for (unsigned i = 0; i < order; ++i)
    for (unsigned j = 0; j < order; ++j)
    {
      const std::pair<unsigned, unsigned> pair{std::min(i, j), std::max(i, j)};
      const std::pair<unsigned, unsigned> mirror{order - 1 - pair.second, order - 1 - pair.first};
      const std::pair<unsigned, unsigned> key = i == j ? std::pair{0u, 0u} : std::min(pair, mirror);
      const auto [entry, is_new] = known.try_emplace(key, static_cast<unsigned>(distances.size()));
      if (is_new)
        distances.push_back(node(key.first) - node(key.second));
      index.push_back(entry->second);
      sign.push_back(i > j ? -1.0 : 1.0);
    }
}

PeriodicImages::PeriodicImages(const Vec3 &origin, const Vec3 &lengths, unsigned order, double margin)
    : edges(lengths), shifts(near_image_shifts(lengths))
{
  if (order < 2 || order > max_order)
    throw std::invalid_argument("the order of the periodic images must be between 2 and 32");
  if (!(margin >= 0 && margin <= 0.4))
    throw std::invalid_argument("the margin of the periodic images must be between 0 and 0.4");
  const PeriodicKernel images(lengths);
  for (std::size_t i = 0; i < 3; ++i)
  {
    const double length = lengths[static_cast<int>(i)];
    axes[i].centre = origin[static_cast<int>(i)] + 0.5 * length;
    axes[i].half_width = (0.5 + margin) * length;
    axes[i].order = axis_order(order, lengths.minCoeff(), length, margin);
    axes[i].tabulate_weights();
    axes[i].tabulate_differences();
  }
  tabulate_kernel(images);
  coefficients = Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, n_nodes());
}

void PeriodicImages::tabulate_kernel(const PeriodicKernel &images)
{
  const std::size_t ny = axes[1].distances.size(), nz = axes[2].distances.size();
  kernel.resize(axes[0].distances.size() * ny * nz);
#pragma omp parallel for schedule(dynamic, 64)
  for (std::size_t i = 0; i < kernel.size(); ++i)
    kernel[i] =
        images(Vec3(axes[0].distances[i / (ny * nz)], axes[1].distances[i / nz % ny], axes[2].distances[i % nz]));
}

// Adds strength_mk T(x) to the moments of all polynomials (rows, z fastest; columns 3 m + k).
void PeriodicImages::add_point(const Vec3 &x, const Mat3 &strength, Eigen::VectorXd &weights,
                               Eigen::MatrixXd &moments) const
{
  double tx[max_axis_order], ty[max_axis_order], tz[max_axis_order];
  axes[0].polynomials(x[0], tx);
  axes[1].polynomials(x[1], ty);
  axes[2].polynomials(x[2], tz);
  Eigen::Index row = 0;
  for (unsigned i = 0; i < axes[0].order; ++i)
    for (unsigned j = 0; j < axes[1].order; ++j)
    {
      const double txy = tx[i] * ty[j];
      for (unsigned k = 0; k < axes[2].order; ++k)
        weights[row++] = txy * tz[k];
    }
  for (int m = 0; m < 3; ++m)
    for (int k = 0; k < 3; ++k)
      moments.col(3 * m + k) += strength(m, k) * weights;
}

void PeriodicImages::add_element(const LineElement &element, Eigen::VectorXd &weights, Eigen::MatrixXd &moments) const
{
  const Vec3 t = element.end - element.start;
  const auto [n_points, n_pieces] = points_and_pieces(t.cwiseQuotient(edges).norm());
  const GaussRule rule = gauss_rule(n_points);
  const Mat3 strength = element.burgers * t.transpose() / n_pieces;
  for (int piece = 0; piece < n_pieces; ++piece)
    for (std::size_t q = 0; q < rule.points.size(); ++q)
      add_point(element.start + (piece + rule.points[q]) / n_pieces * t, rule.weights[q] * strength, weights, moments);
}

// The elements are cut into blocks that depend on their number only, and the blocks are added in order: the result is
// the same on any number of threads.
Eigen::MatrixXd PeriodicImages::source_moments(std::span<const LineElement> elements) const
{
  constexpr std::size_t smallest_block = 128, most_blocks = 64;
  const std::size_t block = std::max(smallest_block, (elements.size() + most_blocks - 1) / most_blocks);
  const std::size_t n_blocks = (elements.size() + block - 1) / block;
  std::vector<Eigen::MatrixXd> partial(n_blocks);
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t b = 0; b < n_blocks; ++b)
  {
    partial[b] = Eigen::MatrixXd::Zero(n_nodes(), 9);
    Eigen::VectorXd weights(n_nodes());
    for (std::size_t e = b * block; e < std::min(elements.size(), (b + 1) * block); ++e)
      add_element(elements[e], weights, partial[b]);
  }
  Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(n_nodes(), 9);
  for (const Eigen::MatrixXd &part : partial)
    moments += part;
  return moments;
}

SymTensor PeriodicImages::node_stress(const IsotropicMedium &medium, const NodeValues &sources, unsigned target) const
{
  const Axis &ax = axes[0], &ay = axes[1], &az = axes[2];
  const unsigned tx = target / (ay.order * az.order) * ax.order, ty = target / az.order % ay.order * ay.order,
                 tz = target % az.order * az.order;
  NodeSums sums;
  std::size_t source = 0;
  for (unsigned i = 0; i < ax.order; ++i)
    for (unsigned j = 0; j < ay.order; ++j)
    {
      const double sx = ax.sign[tx + i], sy = ay.sign[ty + j], sxy = sx * sy;
      const ThirdDerivatives *row =
          &kernel[(ax.index[tx + i] * ay.distances.size() + ay.index[ty + j]) * az.distances.size()];
      for (unsigned k = 0; k < az.order; ++k)
      {
        const ThirdDerivatives &d = row[az.index[tz + k]];
        const double sz = az.sign[tz + k];
        sums.add({sx * d[0], sy * d[1], sz * d[2], sx * d[3], sxy * sz * d[4], sx * d[5], sy * d[6], sz * d[7],
                  sy * d[8], sz * d[9]},
                 sources[source++]);
      }
    }
  return sums.stress(medium);
}

void PeriodicImages::set_sources(const IsotropicMedium &medium, std::span<const LineElement> elements)
{
  overhang = overhang_of(elements);
  const unsigned sy = axes[2].order, sx = axes[1].order * sy;
  Eigen::MatrixXd values = source_moments(elements);
  values = along_axis(values, axes[0].moments_to_nodes, sx);
  values = along_axis(values, axes[1].moments_to_nodes, sy);
  values = along_axis(values, axes[2].moments_to_nodes, 1);
  NodeValues sources(n_nodes());
  for (unsigned p = 0; p < n_nodes(); ++p)
    for (std::size_t c = 0; c < 9; ++c)
      sources[p][c] = values(p, static_cast<Eigen::Index>(c));

  Eigen::MatrixXd stress(n_nodes(), 6);
#pragma omp parallel for schedule(static)
  for (unsigned target = 0; target < n_nodes(); ++target)
    stress.row(target) = node_stress(medium, sources, target).transpose();
  stress = along_axis(stress, axes[0].moments_to_nodes.transpose(), sx);
  stress = along_axis(stress, axes[1].moments_to_nodes.transpose(), sy);
  coefficients = along_axis(stress, axes[2].moments_to_nodes.transpose(), 1).transpose();
}

double PeriodicImages::overhang_of(std::span<const LineElement> elements) const
{
  const Vec3 centre(axes[0].centre, axes[1].centre, axes[2].centre);
  double largest = 0.0;
  for (const LineElement &element : elements)
    for (const Vec3 &end : {element.start, element.end})
      largest = std::max(largest, (end - centre).cwiseQuotient(edges).cwiseAbs().maxCoeff() - 0.5);
  return largest;
}

SymTensor PeriodicImages::far_stress(const Vec3 &x_wrapped) const
{
  double tx[max_axis_order], ty[max_axis_order], tz[max_axis_order];
  axes[0].polynomials(x_wrapped[0], tx);
  axes[1].polynomials(x_wrapped[1], ty);
  axes[2].polynomials(x_wrapped[2], tz);
  SymTensor stress = SymTensor::Zero();
  Eigen::Index column = 0;
  for (unsigned i = 0; i < axes[0].order; ++i)
    for (unsigned j = 0; j < axes[1].order; ++j)
    {
      SymTensor line = SymTensor::Zero();
      for (unsigned k = 0; k < axes[2].order; ++k)
        line += tz[k] * coefficients.col(column++);
      stress += tx[i] * ty[j] * line;
    }
  return stress;
}
} // namespace ddfem
