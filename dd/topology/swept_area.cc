#include "dd/topology/swept_area.h"

namespace ddfem
{
namespace
{
LoopVertex finite(const Vec3 &x)
{
  return {x, false};
}

LoopVertex infinite(const Vec3 &direction)
{
  return {direction, true};
}

bool coincide(const LoopVertex &v, const LoopVertex &w)
{
  return v.at_infinity == w.at_infinity && v.value == w.value;
}
} // namespace

void SweptArea::add(const LoopVertex &v1, const LoopVertex &v2, const LoopVertex &v3, const Vec3 &b,
                    const PlaneIndex plane, const bool inside)
{
  if (!coincide(v1, v2) && !coincide(v2, v3) && !coincide(v3, v1))
    swept.push_back({{v1, v2, v3}, b, plane, inside});
}

void SweptArea::add_triangle(const Vec3 &p1, const Vec3 &p2, const Vec3 &p3, const Vec3 &b, const PlaneIndex plane)
{
  add(finite(p1), finite(p2), finite(p3), b, plane, true);
}

void SweptArea::add_ray_motion(const Vec3 &o, const Vec3 &d, const Vec3 &o_new, const Vec3 &d_new, const Vec3 &b,
                               const PlaneIndex plane)
{
  add(finite(o), finite(o_new), infinite(d_new), b, plane, false);
  add(finite(o), infinite(d_new), infinite(d), b, plane, false);
}

void SweptArea::add_opening(const Vec3 &p, const Vec3 &d_p, const Vec3 &q, const Vec3 &d_q, const Vec3 &b,
                            const PlaneIndex plane)
{
  add(finite(p), infinite(d_p), infinite(d_q), b, plane, false);
  add(finite(p), infinite(d_q), finite(q), b, plane, false);
}

SymTensor plastic_strain_volume(const SweptArea &area)
{
  Mat3 sum = Mat3::Zero();
  for (const SweptTriangle &t : area.triangles())
    if (t.inside)
    {
      const Vec3 &origin = t.vertices[0].value;
      const Vec3 a = 0.5 * (t.vertices[1].value - origin).cross(t.vertices[2].value - origin);
      sum -= t.burgers * a.transpose();
    }
  return symmetric_part(sum);
}
} // namespace ddfem
