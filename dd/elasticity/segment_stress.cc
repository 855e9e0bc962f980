#include "dd/elasticity/segment_stress.h"

namespace ddfem
{
namespace
{
Vec3 unit_or_zero(const Vec3 &v)
{
  const double length = v.norm();
  return length > 0.0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

SymTensor to_tensor(const double (&s)[6])
{
  return SymTensor::Map(s);
}
} // namespace

SegmentStressField::SegmentStressField(const IsotropicMedium &medium, const Vec3 &x1_, const Vec3 &x2_, const Vec3 &b)
    : x1(x1_), x2(x2_), length((x2_ - x1_).norm()), constants(medium, unit_or_zero(x2_ - x1_), b)
{
}

SymTensor SegmentStressField::operator()(const Vec3 &x) const
{
  const Vec3 p = x - x1, q = x - x2;
  double s[6];
  internal::segment_stress_at(constants, length, p[0], p[1], p[2], q[0], q[1], q[2], s);
  return to_tensor(s);
}

RayStressField::RayStressField(const IsotropicMedium &medium, const Vec3 &origin_, const Vec3 &direction, const Vec3 &b)
    : origin(origin_), constants(medium, direction, b)
{
}

SymTensor RayStressField::operator()(const Vec3 &x) const
{
  const Vec3 p = x - origin;
  double s[6];
  internal::ray_stress_at(constants, p[0], p[1], p[2], s);
  return to_tensor(s);
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
