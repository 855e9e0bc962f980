#include "dd/elasticity/half_space_image.h"

#include "dd/elasticity/distance.h"
#include "dd/elasticity/half_space_image-inl.h"
#include "dd/elasticity/image_quadrature.h"
#include "dd/elasticity/vectorised/image_kernels.h"

#include <cmath>
#include <numbers>

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
} // namespace

SegmentImage::SegmentImage(const IsotropicMedium &medium, const Vec3 &x1, const Vec3 &x2, const Vec3 &b,
                           const double tolerance)
    : data(data_of(medium, x1, x2, b, tolerance))
{
}

SymTensor SegmentImage::stress(const Vec3 &x) const
{
  const auto mirror = formulas::mirror_of<double>(data);
  formulas::Tensor<double> sigma{};
  formulas::add_scaled_stress(data.medium,
                              formulas::segment_stress_terms(formulas::StressConstants<double>(data.medium), mirror,
                                                             formulas::vector_of<double>(x)),
                              mirror.t, sigma);
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
           0.0,
           0.0}
{
  constexpr double many_core_radii = 10;
  const double a2 = medium.a * medium.a;
  const bool deep = x[2] > many_core_radii * medium.a;
  data.a2 = deep ? 0.0 : a2;
  data.of_lambda = deep ? -0.5 * a2 / (1 - medium.nu) : 0.0;
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

PiercingImage::PiercingImage(const IsotropicMedium &medium, const Vec3 &x, const Vec3 &b)
    : data{medium, x, mirror_burgers(b), -b[2]}
{
}

SymTensor PiercingImage::stress(const Vec3 &x) const
{
  return to_tensor(formulas::stress_of(data, formulas::vector_of<double>(x)));
}

Vec3 PiercingImage::displacement(const Vec3 &x) const
{
  return to_vec3(formulas::displacement_of(data, formulas::vector_of<double>(x)));
}

void PiercingImage::add_stress(const StressBatch &batch) const
{
  add_image_stress(data, batch);
}

void PiercingImage::add_displacement(const DisplacementBatch &batch) const
{
  add_image_displacement(data, batch);
}
} // namespace ddfem
