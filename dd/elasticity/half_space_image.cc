#include "dd/elasticity/half_space_image.h"

#include "dd/elasticity/distance.h"
#include "dd/elasticity/half_space_image-inl.h"
#include "dd/elasticity/image_quadrature.h"
#include "dd/elasticity/vectorised/image_kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace ddfem
{
namespace
{
namespace formulas = HWY_NAMESPACE;

Vec3 mirrored(const Vec3 &x)
{
  return {x[0], x[1], -x[2]};
}

/// Burgers vector of the mirror image of a line, for the mirrored line sense.
Vec3 mirror_burgers(const Vec3 &b)
{
  return {-b[0], -b[1], b[2]};
}

/// Out of the body.
const Vec3 outward(0, 0, -1);

/// phi of the leg is mu/(2 pi) d_c { 2 nu/(1-nu) chi - depth/(1-nu) psi - a^2/(2 (1-nu)) Lambda }, chi_,z = psi,
/// c = (b_y, -b_x).
Vec3 leg_direction(const Vec3 &b)
{
  return {b[1], -b[0], 0.0};
}

SymTensor to_tensor(const formulas::Tensor<double> &s)
{
  SymTensor sigma;
  sigma << s.xx, s.yy, s.zz, s.xy, s.xz, s.yz;
  return sigma;
}

Vec3 to_vec3(const formulas::Vector<double> &v)
{
  return {v.x, v.y, v.z};
}

SegmentImageData data_of(const IsotropicMedium &medium, const Vec3 &x1, const Vec3 &x2, const Vec3 &b,
                         const double tolerance)
{
  const double length = (x2 - x1).norm(), m = 1 / (1 - medium.nu);
  const Vec3 direction = length > 0 ? Vec3((x2 - x1) / length) : Vec3(Vec3::Zero());
  const Vec3 edge = b.cross(direction), burgers = mirror_burgers(b), start = mirrored(x1), end = mirrored(x2);
  const Vec3 c(2 * direction[2] * b[1] - m * edge[0], -2 * direction[2] * b[0] - m * edge[1], 0.0);
  return {medium,
          start,
          end,
          burgers,
          mirrored(direction),
          burgers.cross(mirrored(direction)),
          m * mirrored(edge),
          c,
          -medium.a * medium.a * direction[2] * Vec3(b[1], -b[0], 0.0),
          length,
          internal::branch_points(start, mirrored(direction), medium.a).ellipse(0.0, length) * length,
          tolerance,
          TriangularLoop(LoopVertex::at(start), LoopVertex::at(end), LoopVertex::towards(outward), burgers)};
}

/// The integral over the elements of the line at @p x.
template <class Sums> Sums integrate(const SegmentImageData &d, const Vec3 &x)
{
  Sums sums{};
  if (!(d.length > 0))
    return sums;
  const auto at = formulas::vector_of<double>(x);
  internal::for_each_image_point(d, x,
                                 [&](const double s, const double weight)
                                 { formulas::add_image_element(d, at, s / d.length, weight, sums); });
  return sums;
}

bool is_near(const PiercingImageData &d, const Vec3 &x)
{
  return (x - d.origin).squaredNorm() < d.core_distance() * d.core_distance();
}

/// The torsion at any point: near the exit point the integral through the core.
formulas::Torsion<double> torsion(const PiercingImageData &d, const Vec3 &x)
{
  const Vec3 r = x - d.origin;
  if (!is_near(d, x))
    return formulas::far_torsion(d, formulas::vector_of<double>(r));
  const double a = d.medium.a, core_depth = d.core_distance();
  const formulas::Radii<double> k({r[0], r[1], r[2] + core_depth});
  formulas::Torsion<double> sum{-k.s, k.psi_q, k.lambda_p};
  auto singularities = internal::LineSingularities::of_point(r, a, Vec3::Zero(), outward);
  singularities.add(0, a); // branch point of D
  internal::integrate_on_panels(singularities, core_depth, d.tolerance,
                                [&](const double s, const double weight)
                                {
                                  const double depth = std::hypot(s, a), core = 0.5 * a * a / depth;
                                  const formulas::Radii<double> e({r[0], r[1], r[2] + depth});
                                  sum.first -= weight * (e.lambda_p + core * e.v3);
                                  sum.second -= weight * (e.lambda_q - 3 * core * e.v5);
                                  sum.shear += weight * (e.v3 + 3 * core * (r[2] + depth) * e.v5);
                                });
  return sum;
}

/// Adds to the values of a batch of points: @p add_all() takes all points for far ones, so that what near ones had is kept
/// aside, and @p at_point(x) serves those.
template <std::size_t n_values, class AddAll, class AtPoint>
void add_piercing(const PiercingImageData &d, const PointBatch<n_values> &batch, AddAll &&add_all, AtPoint &&at_point)
{
  std::vector<std::pair<std::size_t, std::array<double, n_values>>> near;
  for (std::size_t i = 0; i < batch.n; ++i)
  {
    const Vec3 x(batch.x[0][i], batch.x[1][i], batch.x[2][i]);
    if (!is_near(d, x))
      continue;
    const auto added = at_point(x);
    near.emplace_back(i, std::array<double, n_values>());
    for (std::size_t c = 0; c < n_values; ++c)
      near.back().second[c] = batch.value[c][i] + added[static_cast<Eigen::Index>(c)];
  }
  add_all();
  for (const auto &[i, sums] : near)
    for (std::size_t c = 0; c < n_values; ++c)
      batch.value[c][i] = sums[c];
}
} // namespace

SegmentImage::SegmentImage(const IsotropicMedium &medium, const Vec3 &x1, const Vec3 &x2, const Vec3 &b,
                           const double tolerance)
    : data(data_of(medium, x1, x2, b, tolerance))
{
}

SymTensor SegmentImage::stress(const Vec3 &x) const
{
  const auto mirror = formulas::mirror_of<double>(data);
  formulas::Tensor<double> sigma =
      formulas::stress_of(data.medium,
                          formulas::segment_stress_terms(formulas::StressConstants<double>(data.medium), mirror,
                                                         formulas::vector_of<double>(x)),
                          mirror.t);
  integrate<formulas::StressSums<double>>(data, x).add_stress_to(sigma, data.medium.mu / (2 * std::numbers::pi),
                                                                 data.medium.nu, x[2]);
  return to_tensor(sigma);
}

Vec3 SegmentImage::displacement(const Vec3 &x) const
{
  const double mu = data.medium.mu, nu = data.medium.nu;
  return to_vec3(
      formulas::displacement_of(nu, data.strip, 1.0, formulas::vector_of<double>(x)) +
      integrate<formulas::DisplacementSums<double>>(data, x).displacement(mu / (2 * std::numbers::pi), mu, nu, x[2]));
}

void SegmentImage::add_stress(const StressBatch &batch) const
{
  add_image_stress(data, batch);
}

void SegmentImage::add_displacement(const DisplacementBatch &batch) const
{
  add_image_displacement(data, batch);
}

SegmentImage SegmentImage::loosened(const double tolerance) const
{
  SegmentImage result = *this;
  result.data.tolerance = std::max(tolerance, data.tolerance);
  return result;
}

double SegmentImage::distance(const Vec3 &x) const
{
  return std::sqrt(distance_point_segment(x, data.start, data.end).squared);
}

LegImage::LegImage(const IsotropicMedium &medium, const Vec3 &x, const Vec3 &b)
    : data{medium,
           mirrored(x),
           mirror_burgers(b),
           leg_direction(b),
           2 * medium.nu / (1 - medium.nu),
           -x[2] / (1 - medium.nu),
           -0.5 * medium.a * medium.a / (1 - medium.nu)}
{
}

SymTensor LegImage::stress(const Vec3 &x) const
{
  return to_tensor(formulas::stress_of(data, formulas::vector_of<double>(x)));
}

Vec3 LegImage::displacement(const Vec3 &x) const
{
  return to_vec3(formulas::displacement_of(data, formulas::vector_of<double>(x)));
}

void LegImage::add_stress(const StressBatch &batch) const
{
  add_image_stress(data, batch);
}

void LegImage::add_displacement(const DisplacementBatch &batch) const
{
  add_image_displacement(data, batch);
}

PiercingImage::PiercingImage(const IsotropicMedium &medium, const Vec3 &x, const Vec3 &b, const double tolerance)
    : data{medium, x, mirror_burgers(b), -b[2], tolerance}
{
}

SymTensor PiercingImage::stress(const Vec3 &x) const
{
  return to_tensor(formulas::stress_of(data, formulas::vector_of<double>(x), torsion(data, x)));
}

Vec3 PiercingImage::displacement(const Vec3 &x) const
{
  return to_vec3(formulas::displacement_of(data, formulas::vector_of<double>(x), torsion(data, x)));
}

void PiercingImage::add_stress(const StressBatch &batch) const
{
  add_piercing(
      data, batch, [&] { add_image_stress(data, batch); }, [&](const Vec3 &x) { return stress(x); });
}

void PiercingImage::add_displacement(const DisplacementBatch &batch) const
{
  add_piercing(
      data, batch, [&] { add_image_displacement(data, batch); }, [&](const Vec3 &x) { return displacement(x); });
}

PiercingImage PiercingImage::loosened(const double tolerance) const
{
  PiercingImage result = *this;
  result.data.tolerance = std::max(tolerance, data.tolerance);
  return result;
}
} // namespace ddfem
