#include "dd/fmm/image_expansion.h"

#include "dd/elasticity/image_quadrature.h"
#include "dd/fmm/expansion_loops.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ddfem::fmm
{
namespace
{
/// Moments of eight kinds of charges at points.
class PointCharges
{
public:
  PointCharges(const int order_, const Vec3 &centre_, const double size_)
      : order(order_), centre(centre_), size(size_), values(n_harmonics(order_)), sums(n_harmonics(order_))
  {
  }

  /// Charges at @p x (nm).
  void add(const Vec3 &x, const Row &charges)
  {
    for (int c = 0; c < 3; ++c)
      points[c][n] = (x[c] - centre[c]) / size;
    strength[n] = charges;
    if (++n == row_width)
      flush();
  }
  bool empty() const { return is_empty && n == 0; }
  const RowBuffer &moments()
  {
    flush();
    return sums;
  }

private:
  void flush()
  {
    if (n == 0)
      return;
    regular_harmonics(order, points, values.rows());
    add_outer_products(values.size(), values.rows(), strength, sums.rows());
    std::fill(strength, strength + row_width, Row{});
    n = 0;
    is_empty = false;
  }

  int order;
  Vec3 centre;
  double size;
  RowBuffer values, sums;
  Row points[3] = {}, strength[row_width] = {};
  std::size_t n = 0;
  bool is_empty = true;
};

/// Moments of the derivatives of the potentials of some charges.
class Derivatives
{
public:
  Derivatives(const int order, const double size) : terms(known_gradient_terms(order)), scale(-1 / size) {}

  RowBuffer operator()(const std::size_t axis, const RowBuffer &moments) const
  {
    RowBuffer result(moments.size());
    for (const GradientTerm &t : terms[axis])
      result.rows()[t.from] += (scale * t.factor) * moments.rows()[t.to];
    return result;
  }

private:
  const std::array<std::vector<GradientTerm>, 3> &terms;
  double scale;
};

/// All charges of the images of a box.
class ImageCharges
{
public:
  ImageCharges(const int order_, const double tolerance_, const IsotropicMedium &medium_, const Vec3 &centre_,
               const double size_)
      : order(order_), tolerance(tolerance_), medium(medium_), centre(centre_), size(size_),
        strips(order_, centre_, size_), normals(order_, centre_, size_), torsions(order_, centre_, size_)
  {
  }

  void add(const SegmentImage &image)
  {
    const SegmentImageData &d = image.parameters();
    if (!(d.length > 0))
      return;
    add_strip(d);
    add_normal_tractions(d);
  }

  void add(const LegImage &image)
  {
    const LegImageData &d = image.parameters();
    const Vec3 c = normal_factor() * d.c;
    normals.add(d.origin, Row{d.of_chi * c[0], d.of_chi * c[1], d.of_psi * c[0], d.of_psi * c[1], d.of_lambda * c[0],
                              d.of_lambda * c[1], 0, 0});
  }

  void add(const PiercingImage &image)
  {
    const PiercingImageData &d = image.parameters();
    const double of_psi = -d.screw, of_v = 0.25 * medium.a * medium.a * d.screw;
    const Vec3 y = d.origin - centre;
    torsions.add(d.origin, Row{of_psi, of_psi * y[0], of_psi * y[1], of_v, of_v * y[0], of_v * y[1], 0, 0});
  }

  void add_to(const ExpansionView &target, const double core_radius)
  {
    if (!strips.empty())
      add_strips_to(target, core_radius);
    if (!normals.empty())
      add_normals_to(target);
    if (!torsions.empty())
      add_torsions_to(target);
  }

private:
  double normal_factor() const { return 2 * (1 - medium.nu); } ///< k mu/(2 pi)

  void add_strip(const SegmentImageData &d)
  {
    const Vec3 area = d.t.cross(-Vec3::UnitZ());
    const Mat3 product = d.burgers * area.transpose(), s = 0.5 * (product + product.transpose());
    const GaussRule rule = gauss_rule(n_points_along(order, tolerance, d.length / size));
    for (std::size_t k = 0; k < rule.points.size(); ++k)
    {
      const Vec3 x = d.start + rule.points[k] * d.length * d.t, w = s * (x - centre);
      const double weight = rule.weights[k] * d.length;
      strips.add(x, weight * Row{s(0, 0), s(1, 1), s(0, 1), s(0, 2), s(1, 2), w[0], w[1], w[2]});
    }
  }

  /// Panels on which the depth D is smooth, with the points that the harmonics need too.
  void add_normal_tractions(const SegmentImageData &d)
  {
    internal::for_each_graded_panel(
        internal::branch_points(d.start, d.t, medium.a), d.length, tolerance,
        [&](const double begin, const double end, const int n_smooth)
        {
          const int n = std::max(n_smooth, n_points_along(order, tolerance, (end - begin) / size));
          internal::integrate_on_panel(std::min(n, max_gauss_points), begin, end,
                                       [&](const double s, const double weight) { add_element(d, s, weight); });
        });
  }

  void add_element(const SegmentImageData &d, const double s, const double weight)
  {
    const Vec3 x = d.start + s * d.t;
    const double depth = std::hypot(x[2], medium.a), over_depth = depth > 0 ? 1 / depth : 1.0;
    const Vec3 along(depth * d.e[0] + over_depth * d.core[0], depth * d.e[1] + over_depth * d.core[1], -x[2] * d.e[2]);
    normals.add({x[0], x[1], -depth},
                (normal_factor() * weight) * Row{0, 0, d.c[0], d.c[1], along[0], along[1], along[2], 0});
  }

  void add_strips_to(const ExpansionView &target, const double core_radius)
  {
    const Derivatives derivative(order, size);
    const RowBuffer &m = strips.moments();
    const RowBuffer dx = derivative(0, m), dy = derivative(1, m), dz = derivative(2, m);
    RowBuffer e(m.size()); // P, what is integrated twice in Q
    for (std::size_t k = 0; k < m.size(); ++k)
    {
      e(k, 0) = dx(k, 0) + dy(k, 2) + dz(k, 3);
      e(k, 1) = dx(k, 2) + dy(k, 1) + dz(k, 4);
      e(k, 2) = dx(k, 3) + dy(k, 4);
      e(k, 3) = dx(k, 5) + dy(k, 6) + dz(k, 7) - (1 - 2 * medium.nu) * (m(k, 0) + m(k, 1));
    }
    if (core_radius > 0)
    {
      const RowBuffer ex = derivative(0, e), ey = derivative(1, e), ez = derivative(2, e);
      for (std::size_t k = 0; k < m.size(); ++k)
        e(k, 3) -= 0.5 * core_radius * core_radius * (ex(k, 0) + ey(k, 1) + ez(k, 2));
    }
    RowBuffer ez = derivative(2, e);
    for (std::size_t k = 0; k < m.size(); ++k)
      ez(k, 3) += e(k, 2);
    const RowBuffer ezz = derivative(2, ez);
    for (std::size_t k = 0; k < m.size(); ++k)
    {
      for (std::size_t i = 0; i < 3; ++i)
        target.fields[k][i] += ezz(k, i);
      target.q[k] += ezz(k, 3);
    }
  }

  void add_normals_to(const ExpansionView &target)
  {
    const Derivatives derivative(order, size);
    const RowBuffer &m = normals.moments();
    const RowBuffer dx = derivative(0, m), dy = derivative(1, m), dz = derivative(2, m);
    RowBuffer of_chi(m.size()), of_psi(m.size()), phi(m.size());
    for (std::size_t k = 0; k < m.size(); ++k)
    {
      of_chi(k, 0) = dx(k, 0) + dy(k, 1);
      of_psi(k, 0) = dx(k, 2) + dy(k, 3);
      phi(k, 0) = dx(k, 4) + dy(k, 5) + dz(k, 6); // of Lambda so far
    }
    for (const RowBuffer *next : {&of_psi, &of_chi})
    {
      phi = derivative(2, phi);
      for (std::size_t k = 0; k < m.size(); ++k)
        phi(k, 0) += (*next)(k, 0);
    }
    const RowBuffer phi_z = derivative(2, phi);
    for (std::size_t k = 0; k < m.size(); ++k)
    {
      target.fields[k][2] += phi_z(k, 0);
      target.q[k] -= (1 - 2 * medium.nu) * phi(k, 0) + centre[2] * phi_z(k, 0);
    }
  }

  void add_torsions_to(const ExpansionView &target)
  {
    const Derivatives derivative(order, size);
    const RowBuffer &m = torsions.moments(), mzz = derivative(2, derivative(2, m));
    RowBuffer psi(m.size());
    for (std::size_t k = 0; k < m.size(); ++k)
      for (std::size_t i = 0; i < 3; ++i)
        psi(k, i) = m(k, i) + mzz(k, i + 3);
    psi = derivative(2, psi);
    const RowBuffer dx = derivative(0, psi), dy = derivative(1, psi);
    for (std::size_t k = 0; k < m.size(); ++k)
    {
      target.fields[k][0] += dy(k, 0);
      target.fields[k][1] -= dx(k, 0);
      target.q[k] += dy(k, 1) - dx(k, 2);
    }
  }

  int order;
  double tolerance;
  IsotropicMedium medium;
  Vec3 centre;
  double size;
  PointCharges strips;   ///< S_xx S_yy S_xy S_xz S_yz, y'_i S_ij
  PointCharges normals;  ///< dipoles of chi (x, y), of psi (x, y), of Lambda (x, y, z) in phi
  PointCharges torsions; ///< of psi: 1, y'_x, y'_y; of 1/R likewise
};
} // namespace

void add_image_moments(const int order, const double tolerance, const IsotropicMedium &medium, const double core_radius,
                       const Vec3 &centre, const double size, const std::span<const ImageSource> images,
                       const ExpansionView &moments)
{
  ImageCharges charges(order, tolerance, medium, centre, size);
  for (const ImageSource &image : images)
    std::visit([&](const auto &i) { charges.add(i); }, image);
  charges.add_to(moments, core_radius);
}
} // namespace ddfem::fmm
