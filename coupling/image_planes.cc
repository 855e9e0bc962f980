#include "coupling/image_planes.h"

#include <algorithm>
#include <map>

namespace ddfem::coupling
{
namespace
{
using Facet = PolyhedronShape::Facet;

struct Box
{
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  Vec3 centre() const { return 0.5 * (low + high); }
};

Box bounding_box(const std::vector<Facet> &facets)
{
  Box box;
  for (const Facet &f : facets)
    for (const Vec3 &x : f.vertices)
    {
      box.low = box.low.cwiseMin(x);
      box.high = box.high.cwiseMax(x);
    }
  return box;
}

/// The plane of one facet, its normal away from @p centre.
ImagePlane plane_of(const Facet &facet, const Vec3 &centre)
{
  const auto &v = facet.vertices;
  Vec3 normal = (v[2] - v[0]).cross(v[3 % v.size()] - v[1]).normalized();
  if (normal.dot(v[0] - centre) < 0)
    normal = -normal;
  return {facet.face_id, v[0], normal};
}

/// Largest height of the vertices of the facets that @p choose accepts above (sign 1) or below (-1) a plane, nm.
template <typename Choose>
double highest(const std::vector<Facet> &facets, const ImagePlane &plane, const double sign, const Choose &choose)
{
  double height = 0;
  for (const Facet &f : facets)
    if (choose(f))
      for (const Vec3 &x : f.vertices)
        height = std::max(height, sign * (x - plane.point).dot(plane.outward));
  return height;
}
} // namespace

std::vector<ImagePlane> image_planes(const std::vector<Facet> &facets, const std::set<int> &held)
{
  const Box box = bounding_box(facets);
  const double tolerance = 1e-6 * (box.high - box.low).norm();
  std::map<int, ImagePlane> candidates;
  for (const Facet &f : facets)
    candidates.try_emplace(f.face_id, plane_of(f, box.centre()));
  std::vector<ImagePlane> planes;
  for (const auto &[id, plane] : candidates)
  {
    const auto own = [face = id](const Facet &f) { return f.face_id == face; };
    const auto all = [](const Facet &) { return true; };
    const auto shares_plane = [&, face = id](const auto &other)
    {
      return other.first != face && (other.second.outward - plane.outward).norm() < 1e-6 &&
             std::abs((other.second.point - plane.point).dot(plane.outward)) < tolerance;
    };
    const bool flat = highest(facets, plane, -1, own) < tolerance;
    const bool supporting = highest(facets, plane, 1, all) < tolerance;
    if (flat && supporting && held.count(id) == 0 && std::none_of(candidates.begin(), candidates.end(), shares_plane))
      planes.push_back(plane);
  }
  return planes;
}

double facet_size(const std::vector<Facet> &facets, const std::vector<ImagePlane> &planes)
{
  double size = 0;
  for (const Facet &f : facets)
    if (std::any_of(planes.begin(), planes.end(), [&](const ImagePlane &p) { return p.face_id == f.face_id; }))
      for (std::size_t k = 0; k < f.vertices.size(); ++k)
        size = std::max(size, (f.vertices[(k + 1) % f.vertices.size()] - f.vertices[k]).norm());
  return size;
}

SegmentPoints::SmoothLength smooth_length_under(const std::vector<ImagePlane> &planes, const double depth,
                                                const double a)
{
  return [&planes, depth, a](const Vec3 &x)
  {
    double least = depth;
    for (const ImagePlane &p : planes)
      least = std::min(least, (p.point - x).dot(p.outward));
    return std::max(least, 0.0) + a;
  };
}
} // namespace ddfem::coupling
