#include "dd/elasticity/triangle_displacement.h"

#include "dd/elasticity/triangle_displacement-inl.h"

#include <algorithm>
#include <cassert>

namespace ddfem
{
namespace
{
TriangularLoop::Edge edge_between(const std::array<LoopVertex, 3> &vertices, unsigned from, unsigned to, const Vec3 &b)
{
  TriangularLoop::Edge edge;
  const LoopVertex &v = vertices[from], &w = vertices[to];
  if (v.at_infinity && w.at_infinity)
    return edge;
  if (!v.at_infinity && !w.at_infinity)
  {
    edge = {from, to, 1.0, (w.value - v.value).norm(), w.value - v.value, Vec3::Zero()};
    if (edge.length == 0.0)
      return {};
    edge.t /= edge.length;
  }
  else if (w.at_infinity)
    edge = {from, to, 1.0, 0.0, w.value, Vec3::Zero()};
  else
    edge = {to, from, -1.0, 0.0, v.value, Vec3::Zero()};
  edge.b_cross_t = b.cross(edge.t);
  return edge;
}

Vec3 to_vec3(const HWY_NAMESPACE::Vector<double> &v)
{
  return {v.x, v.y, v.z};
}
} // namespace

Vec3 TriangularLoop::middle() const
{
  const Vec3 mean = (vertices[0].value + vertices[1].value + vertices[2].value) / 3;
  Vec3 of_longest = Vec3::Zero();
  double longest = -1;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const Vec3 &p = vertices[i].value, &q = vertices[(i + 1) % 3].value;
    if ((q - p).squaredNorm() > longest)
    {
      longest = (q - p).squaredNorm();
      of_longest = 0.5 * (p + q);
    }
  }
  return radius_about(of_longest) < radius_about(mean) ? of_longest : mean;
}

double TriangularLoop::radius_about(const Vec3 &x) const
{
  double largest = 0;
  for (const LoopVertex &v : vertices)
    largest = std::max(largest, (v.value - x).norm());
  return largest;
}

TriangularLoop::TriangularLoop(const LoopVertex &v1, const LoopVertex &v2, const LoopVertex &v3, const Vec3 &b)
    : vertices{v1, v2, v3}, burgers(b)
{
  assert(!(v1.at_infinity && v2.at_infinity && v3.at_infinity));
  while (vertices[0].at_infinity)
    std::rotate(vertices.begin(), vertices.begin() + 1, vertices.end());
  for (unsigned k = 0; k < 3; ++k)
    edges[k] = edge_between(vertices, k, (k + 1) % 3, b);
  const auto away = [&](const LoopVertex &v) { return v.at_infinity ? v.value : Vec3(v.value - vertices[0].value); };
  normal = away(vertices[1]).cross(away(vertices[2]));
}

double solid_angle(const Vec3 &x, const Vec3 &p1, const Vec3 &p2, const Vec3 &p3)
{
  return solid_angle(x, LoopVertex::at(p1), LoopVertex::at(p2), LoopVertex::at(p3));
}

double solid_angle(const Vec3 &x, const LoopVertex &v1, const LoopVertex &v2, const LoopVertex &v3)
{
  const TriangularLoop loop(v1, v2, v3, Vec3::Zero());
  const auto at = HWY_NAMESPACE::vector_of<double>(x);
  const auto see = [&](const std::size_t k) { return HWY_NAMESPACE::SeenVertex<double>(loop.vertices[k], at); };
  return HWY_NAMESPACE::solid_angle_of(see(0), see(1), see(2), HWY_NAMESPACE::vector_of<double>(loop.normal));
}

Vec3 triangle_displacement(double nu, const Vec3 &x, const Vec3 &p1, const Vec3 &p2, const Vec3 &p3, const Vec3 &b)
{
  return triangle_displacement(nu, x, LoopVertex::at(p1), LoopVertex::at(p2), LoopVertex::at(p3), b);
}

Vec3 triangle_displacement(double nu, const Vec3 &x, const LoopVertex &v1, const LoopVertex &v2, const LoopVertex &v3,
                           const Vec3 &b, double reference_length)
{
  return to_vec3(HWY_NAMESPACE::displacement_of(nu, TriangularLoop(v1, v2, v3, b), reference_length,
                                                HWY_NAMESPACE::vector_of<double>(x)));
}
} // namespace ddfem
