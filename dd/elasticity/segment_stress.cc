#include "dd/elasticity/segment_stress.h"

#include "dd/elasticity/line_stress-inl.h"

#include <numbers>

namespace ddfem
{
namespace
{
namespace formulas = HWY_NAMESPACE;

Vec3 unit_or_zero(const Vec3 &v)
{
  const double length = v.norm();
  return length > 0.0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

SymTensor to_tensor(const IsotropicMedium &medium, const formulas::StressTerms<double> &terms, const Vec3 &t)
{
  formulas::Tensor<double> s{};
  formulas::add_stress(terms, formulas::vector_of<double>(t), s);
  SymTensor sigma;
  sigma << s.xx, s.yy, s.zz, s.xy, s.xz, s.yz;
  return medium.mu / (4.0 * std::numbers::pi) * sigma;
}

formulas::Line<double> line_of(const Vec3 &x1, const Vec3 &x2, const Vec3 &t, const Vec3 &b, const double length)
{
  using formulas::vector_of;
  return {vector_of<double>(x1), vector_of<double>(x2),         vector_of<double>(t),
          vector_of<double>(b),  vector_of<double>(b.cross(t)), length};
}
} // namespace

SegmentStressField::SegmentStressField(const IsotropicMedium &medium_, const Vec3 &x1_, const Vec3 &x2_, const Vec3 &b_)
    : medium(medium_), x1(x1_), x2(x2_), t(unit_or_zero(x2_ - x1_)), b(b_), length((x2_ - x1_).norm())
{
}

SymTensor SegmentStressField::operator()(const Vec3 &x) const
{
  return to_tensor(medium,
                   formulas::segment_stress_terms(formulas::StressConstants<double>(medium),
                                                  line_of(x1, x2, t, b, length), formulas::vector_of<double>(x)),
                   t);
}

void SegmentStressField::add(const StressBatch &batch) const
{
  LineTable table;
  table.add_segment(x1, x2, b);
  add_segment_stress(medium, table, batch);
}

RayStressField::RayStressField(const IsotropicMedium &medium_, const Vec3 &origin_, const Vec3 &direction_,
                               const Vec3 &b_)
    : medium(medium_), origin(origin_), direction(direction_), b(b_)
{
}

SymTensor RayStressField::operator()(const Vec3 &x) const
{
  return to_tensor(medium,
                   formulas::ray_stress_terms(formulas::StressConstants<double>(medium),
                                              line_of(origin, Vec3::Zero(), direction, b, 0.0),
                                              formulas::vector_of<double>(x)),
                   direction);
}

void RayStressField::add(const StressBatch &batch) const
{
  LineTable table;
  table.add_ray(origin, direction, b);
  add_ray_stress(medium, table, batch);
}

SymTensor segment_stress(const IsotropicMedium &medium, const Vec3 &x, const Vec3 &x1, const Vec3 &x2, const Vec3 &b)
{
  return SegmentStressField(medium, x1, x2, b)(x);
}

SymTensor ray_stress(const IsotropicMedium &medium, const Vec3 &x, const Vec3 &origin, const Vec3 &direction,
                     const Vec3 &b)
{
  return RayStressField(medium, origin, direction, b)(x);
}
} // namespace ddfem
