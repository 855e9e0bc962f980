#include "dd/geometry/surface_mesh_shape.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace ddfem
{
namespace
{
/// Numbers for points; points nearer than a tolerance are the same.
class PointNumbers
{
public:
  explicit PointNumbers(const double tolerance) : width(2 * tolerance) {}

  std::size_t operator()(const Vec3 &x)
  {
    const auto cell = [&](const Vec3 &y)
    {
      return std::array<long long, 3>{std::llround(y[0] / width), std::llround(y[1] / width),
                                      std::llround(y[2] / width)};
    };
    const auto c = cell(x);
    for (long long i = -1; i <= 1; ++i)
      for (long long j = -1; j <= 1; ++j)
        for (long long k = -1; k <= 1; ++k)
          if (const auto found = numbers.find({c[0] + i, c[1] + j, c[2] + k});
              found != numbers.end() && (found->second.first - x).norm() < width)
            return found->second.second;
    return numbers.emplace(c, std::pair(x, numbers.size())).first->second.second;
  }

private:
  double width;
  std::map<std::array<long long, 3>, std::pair<Vec3, std::size_t>> numbers;
};

double angle_between(const Vec3 &u, const Vec3 &v)
{
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

/// Triangles of one polygon: a fan from its first corner, or about the mean of its corners if it is not plane.
std::vector<TriangleCorners> triangles_of(const std::vector<Vec3> &polygon)
{
  Vec3 mean = Vec3::Zero(), area = Vec3::Zero();
  const std::size_t n = polygon.size();
  for (std::size_t k = 0; k < n; ++k)
  {
    mean += polygon[k] / static_cast<double>(n);
    area += 0.5 * (polygon[k] - polygon[0]).cross(polygon[(k + 1) % n] - polygon[0]);
  }
  const double size = std::sqrt(area.norm());
  const bool plane = std::ranges::all_of(polygon, [&](const Vec3 &x)
                                         { return std::abs((x - mean).dot(area.normalized())) < 1e-9 * size; });
  std::vector<TriangleCorners> triangles;
  for (std::size_t k = plane ? 1 : 0; k + (plane ? 1 : 0) < n; ++k)
    triangles.push_back({plane ? polygon[0] : mean, polygon[k], polygon[(k + 1) % n]});
  return triangles;
}

[[noreturn]] void refuse(const std::string &what, const Vec3 &where)
{
  std::ostringstream message;
  message << "the surface of the grain " << what << " at the edge near (" << where.transpose() << ") nm";
  throw std::invalid_argument(message.str());
}
} // namespace

SurfaceMeshShape::SurfaceMeshShape(const std::vector<Facet> &facets)
{
  if (facets.size() < 4)
    throw std::invalid_argument("a grain needs at least four facets");
  add_triangles(facets);
  find_normals();
}

void SurfaceMeshShape::add_triangles(const std::vector<Facet> &facets)
{
  std::vector<TriangleCorners> triangles;
  for (const Facet &f : facets)
    for (const TriangleCorners &t : triangles_of(f.vertices))
    {
      triangles.push_back(t);
      face_ids.push_back(f.face_id);
    }
  lower = upper = triangles[0][0];
  for (const TriangleCorners &t : triangles)
    for (const Vec3 &x : t)
    {
      lower = lower.cwiseMin(x);
      upper = upper.cwiseMax(x);
    }
  const Vec3 centre = 0.5 * (lower + upper);
  for (const TriangleCorners &t : triangles)
    enclosed_volume += (t[0] - centre).dot((t[1] - centre).cross(t[2] - centre)) / 6;
  if (enclosed_volume < 0)
    for (TriangleCorners &t : triangles)
      std::swap(t[1], t[2]);
  enclosed_volume = std::abs(enclosed_volume);
  tree = FacetTree(std::move(triangles));
}

void SurfaceMeshShape::find_normals()
{
  const auto &triangles = tree.triangles();
  PointNumbers number_of(1e-8 * diameter());
  std::vector<std::array<std::size_t, 3>> numbers;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> triangle_at; // by directed edge
  std::vector<Vec3> at_point;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    const auto &x = triangles[t];
    normals.push_back((x[1] - x[0]).cross(x[2] - x[0]).normalized());
    numbers.push_back({number_of(x[0]), number_of(x[1]), number_of(x[2])});
    for (std::size_t k = 0; k < 3; ++k)
    {
      const std::size_t i = numbers[t][k], j = numbers[t][(k + 1) % 3];
      if (!triangle_at.emplace(std::pair(i, j), t).second)
        refuse("has facets of opposite orientation, or more than two,", x[k]);
      at_point.resize(std::max({at_point.size(), i + 1, j + 1}), Vec3::Zero());
      at_point[i] += angle_between(x[(k + 1) % 3] - x[k], x[(k + 2) % 3] - x[k]) * normals[t];
    }
  }
  edge_normals.resize(triangles.size());
  corner_normals.resize(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto neighbour = triangle_at.find({numbers[t][(k + 1) % 3], numbers[t][k]});
      if (neighbour == triangle_at.end())
        refuse("is not closed", triangles[t][k]);
      const std::size_t other = neighbour->second;
      edge_normals[t][k] = normals[t] + normals[other];
      corner_normals[t][k] = at_point[numbers[t][k]];
      for (const Vec3 &x : triangles[other])
        convex = convex && normals[t].dot(x - triangles[t][k]) < 1e-6 * diameter();
    }
}

Vec3 SurfaceMeshShape::pseudonormal(const NearestPoint &p) const
{
  const auto feature = static_cast<std::size_t>(p.feature);
  constexpr auto first_edge = static_cast<std::size_t>(TriangleFeature::edge_0),
                 first_corner = static_cast<std::size_t>(TriangleFeature::corner_0);
  if (feature >= first_corner)
    return corner_normals[p.triangle][feature - first_corner];
  return feature >= first_edge ? edge_normals[p.triangle][feature - first_edge] : normals[p.triangle];
}

double SurfaceMeshShape::signed_distance(const Vec3 &x) const
{
  const NearestPoint p = tree.nearest(x);
  const double distance = std::sqrt(p.squared_distance);
  return pseudonormal(p).dot(x - p.point) > 0 ? distance : -distance;
}

Vec3 SurfaceMeshShape::outward_normal(const Vec3 &x) const
{
  const NearestPoint p = tree.nearest(x);
  const double distance = std::sqrt(p.squared_distance);
  if (p.feature == TriangleFeature::inside || distance < 1e-8 * diameter())
    return normals[p.triangle];
  return (pseudonormal(p).dot(x - p.point) > 0 ? 1 : -1) * (x - p.point) / distance;
}

int SurfaceMeshShape::face(const Vec3 &x) const
{
  return face_ids[tree.nearest(x).triangle];
}
} // namespace ddfem
