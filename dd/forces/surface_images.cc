#include "dd/forces/surface_images.h"

#include "dd/common/place_key.h"
#include "dd/elasticity/distance.h"
#include "dd/elasticity/segment_stress.h"
#include "dd/elasticity/vectorised/displacement_kernels.h"
#include "dd/elasticity/vectorised/stress_kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace ddfem
{
namespace
{
/// Depth of a node that lies on a face, nm: well above what the projection onto the surface leaves.
constexpr double on_face = 1e-3;
/// Points that are evaluated together.
constexpr std::size_t portion = 32;

/// Part of the Burgers vector that has an image, by the depth of a line: one up to three quarters of the range.
double weight_of_image(const double line_depth, const double range)
{
  const double x = std::clamp((range - line_depth) / (0.25 * range), 0.0, 1.0);
  return x * x * (3 - 2 * x);
}
} // namespace

/// Net Burgers vectors that arrive at the ends of the lines with an image, by position.
class SurfaceImages::NodeFluxes
{
public:
  struct Flux
  {
    Vec3 position, burgers;
  };

  void add(const Vec3 &x, const Vec3 &b)
  {
    const auto [entry, is_new] = fluxes.try_emplace(place_key(x), Flux{x, Vec3::Zero()});
    entry->second.burgers += b;
  }

  template <typename Visit> void for_each_open_end(Visit &&visit) const
  {
    constexpr double closed = 1e-9; // nm
    for (const auto &[key, flux] : fluxes)
      if (flux.burgers.norm() > closed)
        visit(flux);
  }

private:
  std::map<std::array<long long, 3>, Flux> fluxes;
};

SymTensor SurfaceImages::RayTurn::stress(const Vec3 &x) const
{
  return ray_stress(medium, x, origin, -Vec3::UnitZ(), burgers) - ray_stress(medium, x, origin, direction, burgers);
}

void SurfaceImages::RayTurn::add_stress(const StressBatch &batch) const
{
  LineTable rays;
  rays.add_ray(origin, -Vec3::UnitZ(), burgers);
  rays.add_ray(origin, direction, -burgers);
  add_ray_stress(medium, rays, batch);
}

void SurfaceImages::RayTurn::add_displacement(const DisplacementBatch &batch) const
{
  const TriangularLoop sector(LoopVertex::at(origin), LoopVertex::towards(-Vec3::UnitZ()),
                              LoopVertex::towards(direction), burgers);
  add_triangle_displacement(medium.nu, {&sector, 1}, batch);
}

double SurfaceImages::RayTurn::distance(const Vec3 &x) const
{
  return std::sqrt(std::min(distance_point_ray(x, origin, direction).squared,
                            distance_point_ray(x, origin, -Vec3::UnitZ()).squared));
}

SurfaceImages::SurfaceImages(const LineSystem &lines, const std::span<const ImagePlane> image_planes,
                             const ImageSettings &settings)
    : medium(lines.medium()), planes_of_line(lines.lines().size(), 0), planes_of_ray(lines.rays().size(), 0)
{
  if (!(settings.depth > 0))
    return;
  for (const ImagePlane &p : image_planes.first(std::min<std::size_t>(image_planes.size(), 64)))
  {
    Frame frame{p.face_id, p.point, p.outward, Mat3::Zero()};
    frame.to_local.row(0) = p.outward.unitOrthogonal();
    frame.to_local.row(2) = -p.outward;
    frame.to_local.row(1) = frame.to_local.row(2).cross(frame.to_local.row(0));
    planes.push_back(frame);
    add_plane(lines, planes.size() - 1, settings);
  }
}

void SurfaceImages::add_plane(const LineSystem &lines, const std::size_t plane, const ImageSettings &settings)
{
  NodeFluxes fluxes;
  add_lines(lines, plane, settings, fluxes);
  add_rays(lines, plane, settings, fluxes);
  add_legs(lines, plane, settings, fluxes);
}

void SurfaceImages::add_lines(const LineSystem &lines, const std::size_t plane, const ImageSettings &settings,
                              NodeFluxes &fluxes)
{
  const Frame &frame = planes[plane];
  for (std::size_t i = 0; i < lines.lines().size(); ++i)
  {
    const StraightLine &line = lines.lines()[i];
    const Vec3 start = frame.local(line.start), end = frame.local(line.end);
    const double outside = -std::min(frame.unlimited(line.start)[2], frame.unlimited(line.end)[2]);
    const double weight = weight_of_image(std::min(start[2], end[2]), settings.depth);
    if (weight == 0 || outside > on_face)
      continue;
    planes_of_line[i] |= PlaneSet{1} << plane;
    const Vec3 burgers = weight * line.burgers;
    pieces.push_back({plane, SegmentImage(lines.medium(), start, end, frame.to_local * burgers, settings.tolerance)});
    if (weight < 1)
      fading.push_back({{line.start, line.end, line.burgers - burgers}, frame.face_id});
    fluxes.add(line.start, -burgers);
    fluxes.add(line.end, burgers);
  }
}

void SurfaceImages::add_rays(const LineSystem &lines, const std::size_t plane, const ImageSettings &settings,
                             NodeFluxes &fluxes)
{
  const Frame &frame = planes[plane];
  for (std::size_t i = 0; i < lines.rays().size(); ++i)
  {
    const VirtualRay &ray = lines.rays()[i];
    const Vec3 origin = frame.local(ray.origin), burgers = frame.to_local * ray.burgers;
    if (origin[2] > on_face || ray.direction.dot(frame.outward) <= 0)
      continue;
    planes_of_ray[i] |= PlaneSet{1} << plane;
    const Vec3 foot(origin[0], origin[1], 0);
    pieces.push_back({plane, PiercingImage(lines.medium(), foot, burgers, settings.tolerance)});
    if (ray.direction.dot(frame.outward) < 1 - 1e-12)
      pieces.push_back({plane, RayTurn{lines.medium(), foot, frame.to_local * ray.direction, burgers}});
    fluxes.add(ray.origin, -ray.burgers);
  }
}

void SurfaceImages::add_legs(const LineSystem &lines, const std::size_t plane, const ImageSettings &settings,
                             const NodeFluxes &fluxes)
{
  const Frame &frame = planes[plane];
  fluxes.for_each_open_end(
      [&](const NodeFluxes::Flux &flux)
      {
        Vec3 x = frame.local(flux.position);
        const Vec3 burgers = frame.to_local * flux.burgers;
        if (const double deep = LegImage::shortest_depth(lines.medium()); x[2] < deep)
        {
          const Vec3 below(x[0], x[1], deep);
          pieces.push_back({plane, SegmentImage(lines.medium(), x, below, burgers, settings.tolerance)});
          x = below;
        }
        pieces.push_back({plane, LegImage(lines.medium(), x, burgers)});
        legs.push_back({{flux.position, -frame.outward, -flux.burgers}, frame.face_id});
      });
}

bool SurfaceImages::is_freed(const std::vector<PlaneSet> &sets, const std::size_t i, const int face_id) const
{
  if (i >= sets.size() || sets[i] == 0)
    return false;
  for (std::size_t p = 0; p < planes.size(); ++p)
    if ((sets[i] >> p & 1U) != 0 && planes[p].face_id == face_id)
      return true;
  return false;
}

/// Sum over pieces number(0) ... number(n - 1); those of one plane are added up in its frame.
template <typename PieceNumber>
SymTensor SurfaceImages::sum_of_pieces(const std::size_t n, PieceNumber &&number, const Vec3 &x) const
{
  SymTensor total = SymTensor::Zero();
  for (std::size_t i = 0; i < n;)
  {
    const std::size_t plane = pieces[number(i)].plane;
    const Vec3 local = planes[plane].local(x);
    SymTensor sum = SymTensor::Zero();
    for (; i < n && pieces[number(i)].plane == plane; ++i)
      sum += std::visit([&](const auto &field) { return field.stress(local); }, pieces[number(i)].field);
    total += planes[plane].to_sample(sum);
  }
  return total;
}

SymTensor SurfaceImages::stress(const Vec3 &x) const
{
  return sum_of_pieces(
      pieces.size(), [](const std::size_t i) { return i; }, x);
}

SymTensor SurfaceImages::stress(const std::span<const unsigned> images, const Vec3 &x) const
{
  return sum_of_pieces(
      images.size(), [&](const std::size_t i) { return images[i]; }, x);
}

/// A batch of the points in the frame of a plane.
template <typename Buffer> Buffer SurfaceImages::local_points(const Frame &frame, const std::span<const Vec3> points)
{
  Buffer buffer(points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    buffer.set_point(k, frame.local(points[k]));
  return buffer;
}

template <typename PieceNumber, typename Visit>
void SurfaceImages::for_each_plane(const std::size_t n, PieceNumber &&number, Visit &&visit) const
{
  std::vector<std::size_t> of_plane;
  for (std::size_t i = 0; i < n;)
  {
    const std::size_t plane = pieces[number(i)].plane;
    of_plane.clear();
    for (; i < n && pieces[number(i)].plane == plane; ++i)
      of_plane.push_back(number(i));
    visit(planes[plane], of_plane);
  }
}

template <typename PieceNumber>
void SurfaceImages::add_stress_of(const std::size_t n, PieceNumber &&number, const std::span<const Vec3> points,
                                  const std::span<SymTensor> values) const
{
  for_each_plane(n, number,
                 [&](const Frame &frame, const std::vector<std::size_t> &of_plane)
                 {
                   StressBuffer buffer = local_points<StressBuffer>(frame, points);
                   for (const std::size_t i : of_plane)
                     std::visit([&](const auto &field) { field.add_stress(buffer.batch()); }, pieces[i].field);
                   for (std::size_t k = 0; k < points.size(); ++k)
                     values[k] += frame.to_sample(buffer.value(k));
                 });
}

void SurfaceImages::add_stress(const std::span<const unsigned> images, const std::span<const Vec3> points,
                               const std::span<SymTensor> values) const
{
  add_stress_of(
      images.size(), [&](const std::size_t i) { return images[i]; }, points, values);
}

std::vector<SymTensor> SurfaceImages::stress(const std::span<const Vec3> points) const
{
  std::vector<SymTensor> values(points.size(), SymTensor::Zero());
#pragma omp parallel for schedule(dynamic)
  for (std::size_t first = 0; first < points.size(); first += portion)
  {
    const std::size_t n = std::min(portion, points.size() - first);
    add_stress_of(
        pieces.size(), [](const std::size_t i) { return i; }, points.subspan(first, n),
        std::span(values).subspan(first, n));
  }
  return values;
}

template <typename PieceNumber>
void SurfaceImages::add_displacement_of(const std::size_t n, PieceNumber &&number, const std::span<const Vec3> points,
                                        const std::span<Vec3> values) const
{
  for_each_plane(n, number,
                 [&](const Frame &frame, const std::vector<std::size_t> &of_plane)
                 {
                   DisplacementBuffer buffer = local_points<DisplacementBuffer>(frame, points);
                   for (const std::size_t i : of_plane)
                     std::visit([&](const auto &field) { field.add_displacement(buffer.batch()); }, pieces[i].field);
                   for (std::size_t k = 0; k < points.size(); ++k)
                     values[k] += frame.to_local.transpose() * buffer.value(k);
                 });
}

void SurfaceImages::add_displacement(const std::span<const unsigned> images, const std::span<const Vec3> points,
                                     const std::span<Vec3> values) const
{
  add_displacement_of(
      images.size(), [&](const std::size_t i) { return images[i]; }, points, values);
}

std::vector<Vec3> SurfaceImages::displacement(const std::span<const Vec3> points) const
{
  std::vector<Vec3> values(points.size(), Vec3::Zero());
#pragma omp parallel for schedule(dynamic)
  for (std::size_t first = 0; first < points.size(); first += portion)
  {
    const std::size_t n = std::min(portion, points.size() - first);
    add_displacement_of(
        pieces.size(), [](const std::size_t i) { return i; }, points.subspan(first, n),
        std::span(values).subspan(first, n));
  }
  return values;
}

std::vector<Ball> SurfaceImages::bounding_balls() const
{
  // In the frame of the plane; a turned ray may come near anywhere.
  struct
  {
    Ball operator()(const SegmentImage &i) const
    {
      return {0.5 * (i.parameters().start + i.parameters().end), 0.5 * i.parameters().length};
    }
    Ball operator()(const LegImage &i) const { return {i.parameters().origin, 0.0}; }
    Ball operator()(const PiercingImage &i) const { return {i.parameters().origin, 0.0}; }
    Ball operator()(const RayTurn &i) const { return {i.origin, 1e9}; }
  } ball_of;
  std::vector<Ball> balls;
  balls.reserve(pieces.size());
  for (const Piece &piece : pieces)
  {
    const Frame &frame = planes[piece.plane];
    const Ball local = std::visit(ball_of, piece.field);
    balls.push_back({frame.point + frame.to_local.transpose() * local.centre, local.radius});
  }
  return balls;
}

double SurfaceImages::image_distance(const std::size_t image, const Vec3 &x) const
{
  const Piece &piece = pieces[image];
  const Vec3 local = planes[piece.plane].local(x);
  return std::visit([&](const auto &field) { return field.distance(local); }, piece.field);
}
} // namespace ddfem
