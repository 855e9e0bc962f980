#include "dd/elasticity/triangle_displacement.h"

#include "dd/elasticity/line_integrals.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace ddfem
{
namespace
{
/// Squared distance (relative to the squared distance of the nearest vertex, or nm^2 at a vertex) at which the
/// logarithm is cut off on an edge.
constexpr double tiny2 = 1e-28;

/// A vertex seen from x: relative position and its length, or the direction and one.
struct SeenVertex
{
  Vec3 r;
  double norm;
  bool at_infinity;
};

SeenVertex see(const LoopVertex &v, const Vec3 &x)
{
  if (v.at_infinity)
    return {v.value, 1.0, true};
  const Vec3 r = v.value - x;
  return {r, r.norm(), false};
}

/// @p r1 must be finite; @p w2, @p w3 are the edges from vertex 1 (or directions at infinity): the triple product of
/// the edges keeps all digits where the three directions are nearly equal.
double solid_angle_of(const SeenVertex &v1, const SeenVertex &v2, const SeenVertex &v3, const Vec3 &w2, const Vec3 &w3)
{
  const double numerator = v1.r.dot(w2.cross(w3));
  const double denominator =
      v1.norm * v2.norm * v3.norm + v1.r.dot(v2.r) * v3.norm + v2.r.dot(v3.r) * v1.norm + v3.r.dot(v1.r) * v2.norm;
  return 2.0 * std::atan2(numerator, denominator);
}

/// What the edges of a loop add: log = ln[(R_B + R_B.t)/(R_A + R_A.t)] (Barnett's f = log b x t), and his
/// g = [b.(l_A x l_B)] (l_A + l_B)/(1 + l_A.l_B).
struct EdgeTerms
{
  double log;
  Vec3 g;
};

/// With d the vector from x to the foot of the perpendicular, l_A x l_B = L d x t/(R_A R_B) and
/// 1 + l_A.l_B = Q/(R_A R_B): neither log nor g is a quotient of small differences any more.
EdgeTerms finite_edge(const SeenVertex &a, const SeenVertex &b, const Vec3 &t, double length, const Vec3 &burgers)
{
  const double s1 = a.r.dot(t), s2 = b.r.dot(t);
  const bool first_nearer = std::abs(s1) < std::abs(s2);
  const Vec3 d = first_nearer ? Vec3(a.r - s1 * t) : Vec3(b.r - s2 * t);
  const internal::SegmentGeometry k(s1, s2, length, d.squaredNorm() + tiny2 * length * length);
  const double sum = k.r1 + k.r2;
  const double volume = length * burgers.dot(d.cross(t)) / (k.r1 * k.r2);
  return {k.j01(), volume * ((sum / k.q) * d + ((s1 + s2) / sum) * t)};
}

/// Edge from @p a to infinity along @p t: the limit of finite_edge() without the infinite constant 2 L.
EdgeTerms ray_edge(const SeenVertex &a, const Vec3 &t, const Vec3 &burgers, double reference_length)
{
  const double s = a.r.dot(t);
  const Vec3 d = a.r - s * t;
  const double da2 = d.squaredNorm() + tiny2 * (a.norm > 0.0 ? a.norm * a.norm : 1.0);
  const double r = std::sqrt(s * s + da2);
  const double sum = internal::distance_plus_projection(s, r, da2);
  return {-std::log(sum / reference_length), burgers.dot(d.cross(t)) / r * (d / sum + t)};
}

/// Sums of Barnett's edge terms over the edges of a loop.
struct EdgeSums
{
  Vec3 f = Vec3::Zero(), g = Vec3::Zero();

  void add(double sign, const EdgeTerms &terms, const Vec3 &b_cross_t)
  {
    f += (sign * terms.log) * b_cross_t;
    g += sign * terms.g;
  }

  void add_finite(const SeenVertex &a, const SeenVertex &c, const Vec3 &edge, const Vec3 &b)
  {
    const double length = edge.norm();
    if (length == 0.0)
      return;
    const Vec3 t = edge / length;
    add(1.0, finite_edge(a, c, t, length, b), b.cross(t));
  }

  /// Any edge; one at infinity adds a constant, which is dropped. The return along a ray is minus the way out.
  void add_edge(const LoopVertex &from, const LoopVertex &to, const SeenVertex &seen_from, const SeenVertex &seen_to,
                const Vec3 &b, double reference_length)
  {
    if (!from.at_infinity && !to.at_infinity)
      add_finite(seen_from, seen_to, to.value - from.value, b);
    else if (!from.at_infinity)
      add(1.0, ray_edge(seen_from, to.value, b, reference_length), b.cross(to.value));
    else if (!to.at_infinity)
      add(-1.0, ray_edge(seen_to, from.value, b, reference_length), b.cross(from.value));
  }
};

/// Barnett's sum; with the sign of solid_angle(), opposite to his, the jump term is + Omega b/(4 pi).
Vec3 assemble(double nu, double omega, const EdgeSums &edges, const Vec3 &b)
{
  const double factor = 1.0 / (8.0 * std::numbers::pi * (1.0 - nu));
  return (omega / (4.0 * std::numbers::pi)) * b - (factor * (1.0 - 2.0 * nu)) * edges.f + factor * edges.g;
}
} // namespace

double solid_angle(const Vec3 &x, const Vec3 &p1, const Vec3 &p2, const Vec3 &p3)
{
  const Vec3 r1 = p1 - x, r2 = p2 - x, r3 = p3 - x;
  return solid_angle_of({r1, r1.norm(), false}, {r2, r2.norm(), false}, {r3, r3.norm(), false}, p2 - p1, p3 - p1);
}

double solid_angle(const Vec3 &x, const LoopVertex &v1, const LoopVertex &v2, const LoopVertex &v3)
{
  if (v1.at_infinity)
  {
    assert(!(v2.at_infinity && v3.at_infinity));
    return solid_angle(x, v2, v3, v1);
  }
  const Vec3 w2 = v2.at_infinity ? v2.value : Vec3(v2.value - v1.value);
  const Vec3 w3 = v3.at_infinity ? v3.value : Vec3(v3.value - v1.value);
  return solid_angle_of(see(v1, x), see(v2, x), see(v3, x), w2, w3);
}

Vec3 triangle_displacement(double nu, const Vec3 &x, const Vec3 &p1, const Vec3 &p2, const Vec3 &p3, const Vec3 &b)
{
  const Vec3 r1 = p1 - x, r2 = p2 - x, r3 = p3 - x;
  const SeenVertex v1{r1, r1.norm(), false}, v2{r2, r2.norm(), false}, v3{r3, r3.norm(), false};
  const Vec3 e12 = p2 - p1, e23 = p3 - p2, e31 = p1 - p3;
  EdgeSums edges;
  edges.add_finite(v1, v2, e12, b);
  edges.add_finite(v2, v3, e23, b);
  edges.add_finite(v3, v1, e31, b);
  return assemble(nu, solid_angle_of(v1, v2, v3, e12, -e31), edges, b);
}

Vec3 triangle_displacement(double nu, const Vec3 &x, const LoopVertex &v1, const LoopVertex &v2, const LoopVertex &v3,
                           const Vec3 &b, double reference_length)
{
  const SeenVertex s1 = see(v1, x), s2 = see(v2, x), s3 = see(v3, x);
  EdgeSums edges;
  edges.add_edge(v1, v2, s1, s2, b, reference_length);
  edges.add_edge(v2, v3, s2, s3, b, reference_length);
  edges.add_edge(v3, v1, s3, s1, b, reference_length);
  return assemble(nu, solid_angle(x, v1, v2, v3), edges, b);
}
} // namespace ddfem
