#include "dd/geometry/grain_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace ddfem
{
void GrainShape::set_face_kind(const int face_id, const FaceKind kind)
{
  const auto i = static_cast<std::size_t>(face_id);
  if (i >= face_kinds.size())
    face_kinds.resize(i + 1, FaceKind::free);
  face_kinds[i] = kind;
}

FaceKind GrainShape::face_kind(const int face_id) const
{
  const auto i = static_cast<std::size_t>(face_id);
  return i < face_kinds.size() ? face_kinds[i] : FaceKind::free;
}

BoxShape::BoxShape(const Vec3 &lower_corner_, const Vec3 &upper_corner_) : lower(lower_corner_), upper(upper_corner_)
{
  if (((upper - lower).array() <= 0).any())
    throw std::invalid_argument("a box needs positive edge lengths");
}

double BoxShape::signed_distance(const Vec3 &x) const
{
  return std::max((lower - x).maxCoeff(), (x - upper).maxCoeff());
}

int BoxShape::face(const Vec3 &x) const
{
  int best = 0;
  double distance = -std::numeric_limits<double>::infinity();
  const auto check = [&](const int id, const double d)
  {
    if (d > distance)
    {
      distance = d;
      best = id;
    }
  };
  for (int c = 0; c < 3; ++c)
  {
    check(2 * c, lower[c] - x[c]);
    check(2 * c + 1, x[c] - upper[c]);
  }
  return best;
}

Vec3 BoxShape::outward_normal(const Vec3 &x) const
{
  const int id = face(x);
  Vec3 n = Vec3::Zero();
  n[id / 2] = id % 2 == 0 ? -1.0 : 1.0;
  return n;
}

double BoxShape::volume() const
{
  return (upper - lower).prod();
}

CylinderShape::CylinderShape(const Vec3 &base_, const double radius_, const double height_)
    : base(base_), radius(radius_), height(height_)
{
  if (radius <= 0 || height <= 0)
    throw std::invalid_argument("a cylinder needs a positive radius and height");
}

double CylinderShape::signed_distance(const Vec3 &x) const
{
  const Vec3 r = x - base;
  return std::max({std::hypot(r[0], r[1]) - radius, -r[2], r[2] - height});
}

int CylinderShape::face(const Vec3 &x) const
{
  const Vec3 r = x - base;
  const double side = std::hypot(r[0], r[1]) - radius;
  if (side >= -r[2] && side >= r[2] - height)
    return 0;
  return -r[2] > r[2] - height ? 1 : 2;
}

Vec3 CylinderShape::outward_normal(const Vec3 &x) const
{
  const int id = face(x);
  if (id != 0)
    return {0, 0, id == 1 ? -1.0 : 1.0};
  const Vec3 r = x - base;
  const double length = std::hypot(r[0], r[1]);
  return length > 0 ? Vec3(r[0] / length, r[1] / length, 0) : Vec3::UnitX();
}

double CylinderShape::volume() const
{
  return std::numbers::pi * radius * radius * height;
}

Vec3 CylinderShape::lower_corner() const
{
  return base - Vec3(radius, radius, 0);
}

Vec3 CylinderShape::upper_corner() const
{
  return base + Vec3(radius, radius, height);
}

namespace
{
/// Area vector of a polygon (half the sum of the cross products), orientation by its vertex order.
Vec3 area_vector(const std::vector<Vec3> &vertices)
{
  Vec3 area = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < vertices.size(); ++i)
    area += 0.5 * (vertices[i] - vertices[0]).cross(vertices[i + 1] - vertices[0]);
  return area;
}

Vec3 mean(const std::vector<Vec3> &points)
{
  Vec3 sum = Vec3::Zero();
  for (const Vec3 &p : points)
    sum += p;
  return sum / static_cast<double>(points.size());
}
} // namespace

PolyhedronShape::PolyhedronShape(const std::vector<Facet> &facets)
{
  if (facets.size() < 4)
    throw std::invalid_argument("a polyhedral grain needs at least four facets");
  std::vector<Vec3> corners;
  for (const Facet &f : facets)
    corners.insert(corners.end(), f.vertices.begin(), f.vertices.end());
  lower = upper = corners.front();
  for (const Vec3 &x : corners)
  {
    lower = lower.cwiseMin(x);
    upper = upper.cwiseMax(x);
  }
  const Vec3 centre = mean(corners);
  const double tolerance = 1e-6 * (upper - lower).norm();
  for (const Facet &f : facets)
  {
    Vec3 area = area_vector(f.vertices);
    if (area.dot(mean(f.vertices) - centre) < 0)
      area = -area;
    enclosed_volume += area.dot(mean(f.vertices) - centre) / 3;
    const HalfSpace h{area.normalized(), area.normalized().dot(mean(f.vertices)), f.face_id};
    const bool known = std::any_of(half_spaces.begin(), half_spaces.end(),
                                   [&](const HalfSpace &other)
                                   {
                                     return other.face_id == h.face_id && (other.normal - h.normal).norm() < 1e-6 &&
                                            std::abs(other.offset - h.offset) < tolerance;
                                   });
    if (!known)
      half_spaces.push_back(h);
  }
  for (const HalfSpace &h : half_spaces)
    for (const Vec3 &x : corners)
      if (h.normal.dot(x) - h.offset > tolerance)
      {
        std::ostringstream message;
        message << "the grain is not convex: the mesh vertex (" << x.transpose() << ") nm lies "
                << h.normal.dot(x) - h.offset << " nm in front of a facet of boundary " << h.face_id;
        throw std::invalid_argument(message.str());
      }
}

const PolyhedronShape::HalfSpace &PolyhedronShape::nearest(const Vec3 &x) const
{
  return *std::max_element(half_spaces.begin(), half_spaces.end(),
                           [&](const HalfSpace &p, const HalfSpace &q)
                           { return p.normal.dot(x) - p.offset < q.normal.dot(x) - q.offset; });
}

double PolyhedronShape::signed_distance(const Vec3 &x) const
{
  const HalfSpace &h = nearest(x);
  return h.normal.dot(x) - h.offset;
}

Vec3 PolyhedronShape::outward_normal(const Vec3 &x) const
{
  return nearest(x).normal;
}

int PolyhedronShape::face(const Vec3 &x) const
{
  return nearest(x).face_id;
}

namespace
{
/// Newton iterations to the surface along what @p allowed, an orthogonal projection, leaves of the outward normal.
template <class Projection>
std::optional<Vec3> project_along(const GrainShape &shape, const Vec3 &x, const Projection &allowed)
{
  Vec3 y = x;
  const double tolerance = 1e-12 * shape.diameter();
  constexpr int max_iterations = 50;
  constexpr double parallel_sine = 1e-3;
  for (int i = 0; i < max_iterations; ++i)
  {
    const double phi = shape.signed_distance(y);
    if (std::abs(phi) <= tolerance)
      return y;
    const Vec3 m = allowed(shape.outward_normal(y)); // |m| = sine of the angle between plane (or line) and face
    const double slope = m.squaredNorm();
    if (slope < parallel_sine * parallel_sine)
      return std::nullopt;
    y -= phi / slope * m;
  }
  if (std::abs(shape.signed_distance(y)) < 1e-9 * shape.diameter())
    return y;
  return std::nullopt;
}
} // namespace

std::optional<Vec3> project_to_surface(const GrainShape &shape, const Vec3 &x, const Vec3 &plane_normal)
{
  return project_along(shape, x, [&](const Vec3 &n) { return Vec3(n - n.dot(plane_normal) * plane_normal); });
}

std::optional<Vec3> project_to_surface_within(const GrainShape &shape, const Vec3 &x, const Mat3 &directions)
{
  return project_along(shape, x, [&](const Vec3 &n) { return Vec3(directions * n); });
}

Vec3 surface_crossing(const GrainShape &shape, const Vec3 &inside, const Vec3 &outside)
{
  double lo = 0, hi = 1;
  constexpr int n_looks = 8;
  for (int k = 1; k < n_looks && !shape.is_convex(); ++k)
  {
    const double t = static_cast<double>(k) / n_looks;
    if (shape.signed_distance(inside + t * (outside - inside)) > 0)
    {
      hi = t;
      break;
    }
    lo = t;
  }
  for (int i = 0; i < 60; ++i)
  {
    const double mid = 0.5 * (lo + hi);
    (shape.signed_distance(inside + mid * (outside - inside)) > 0 ? hi : lo) = mid;
  }
  return inside + hi * (outside - inside);
}
} // namespace ddfem
