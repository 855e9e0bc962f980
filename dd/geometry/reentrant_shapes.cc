#include "dd/geometry/reentrant_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace ddfem
{
double PillarDimensions::side_radius(const double z) const
{
  return top_radius + (height - z) * std::tan(taper);
}

std::array<double, 2> PillarDimensions::fillet_centre() const
{
  // At the height of the fillet radius above the base and this far from the side.
  return {side_radius(fillet_radius) + fillet_radius / std::cos(taper), fillet_radius};
}

double PillarDimensions::fillet_top() const
{
  return fillet_radius * (1 - std::sin(taper));
}

void PillarDimensions::check() const
{
  std::ostringstream message;
  const double foot = fillet_centre()[0];
  if (!(top_radius > 0 && height > 0 && base_width > 0 && base_height > 0))
    message << "a pillar needs positive radius, height, base width and base height";
  else if (!(taper >= 0 && taper < std::numbers::pi / 4))
    message << "the taper angle must be at least 0 and less than 45 degrees";
  else if (!(fillet_radius >= 0 && fillet_top() < height))
    message << "the fillet (radius " << fillet_radius << " nm) must end below the top of the pillar (height " << height
            << " nm)";
  else if (!(2 * foot < base_width))
    message << "the foot of the pillar with its fillet has the diameter " << 2 * foot
            << " nm and does not fit on the base of width " << base_width << " nm";
  if (!message.str().empty())
    throw std::invalid_argument(message.str());
}

PillarShape::PillarShape(const Vec3 &base_, const PillarDimensions &dimensions_) : base(base_), dimensions(dimensions_)
{
  dimensions.check();
}

/// Side, fillet and upper face of the base; @p r: position relative to the middle of that face.
PillarShape::Nearest PillarShape::profile(const Vec3 &r) const
{
  const double radius = std::hypot(r[0], r[1]), z = r[2];
  const Vec3 radial = radius > 0 ? Vec3(r[0] / radius, r[1] / radius, 0) : Vec3(Vec3::UnitX());
  const double c = std::cos(dimensions.taper), s = std::sin(dimensions.taper);
  const double side = c * (radius - dimensions.side_radius(z)), floor = z;
  const auto centre = dimensions.fillet_centre();
  const double u = radius - centre[0], v = z - centre[1];
  // In the cone spanned by the downward normals of side (c, s) and base (0, 1): (u, v) = -alpha (c, s) - beta (0, 1).
  const double alpha = -u / c, beta = -v - alpha * s;
  if (alpha > 0 && beta > 0)
  {
    const double length = std::hypot(u, v);
    const Vec3 normal = -(u * radial + v * Vec3::UnitZ()) / length;
    return {dimensions.fillet_radius - length, 0, normal};
  }
  return side < floor ? Nearest{side, 0, c * radial + s * Vec3::UnitZ()} : Nearest{floor, 3, Vec3::UnitZ()};
}

PillarShape::Nearest PillarShape::nearest(const Vec3 &x) const
{
  const Vec3 r = x - base - Vec3(0, 0, dimensions.base_height);
  Nearest best = profile(r);
  const auto cut = [&](const double distance, const int id, const Vec3 &normal)
  {
    if (distance > best.distance)
      best = {distance, id, normal};
  };
  cut(r[2] - dimensions.height, 2, Vec3::UnitZ());
  cut(-dimensions.base_height - r[2], 1, -Vec3::UnitZ());
  for (int d = 0; d < 2; ++d)
    cut(std::abs(r[d]) - 0.5 * dimensions.base_width, 4, (r[d] < 0 ? -1 : 1) * Vec3::Unit(d));
  return best;
}

double PillarShape::signed_distance(const Vec3 &x) const
{
  return nearest(x).distance;
}

Vec3 PillarShape::outward_normal(const Vec3 &x) const
{
  return nearest(x).normal;
}

int PillarShape::face(const Vec3 &x) const
{
  return nearest(x).face;
}

double PillarShape::volume() const
{
  const PillarDimensions &d = dimensions;
  const double r0 = d.side_radius(0),
               cone = std::numbers::pi * d.height / 3 * (r0 * r0 + r0 * d.top_radius + d.top_radius * d.top_radius);
  // Ring of the fillet: the kite between corner, two points of contact and centre, without the sector of the circle
  // (Pappus: area times the way of its centroid).
  const auto [rc, zc] = d.fillet_centre();
  const double rho = d.fillet_radius, angle = std::numbers::pi / 2 - d.taper; // of the sector
  const double kite = rho * rho * std::tan(angle / 2), sector = 0.5 * rho * rho * angle;
  const double touch_r = rc - rho * std::cos(d.taper);
  // Two triangles of the kite with their common edge from the corner (r0, 0) to the centre.
  const double kite_moment = 0.5 * kite * (r0 + rc + touch_r) / 3 + 0.5 * kite * (r0 + rc + rc) / 3;
  // The centroid of the sector lies on its bisector, at 4 rho sin(angle/2)/(3 angle) from the centre.
  const double to_centroid = angle > 0 ? 4 * rho * std::sin(angle / 2) / (3 * angle) : 0;
  const double sector_moment = sector * (rc - to_centroid * std::sin(angle / 2));
  return cone + 2 * std::numbers::pi * (kite_moment - sector_moment) + d.base_width * d.base_width * d.base_height;
}

Vec3 PillarShape::lower_corner() const
{
  return base - 0.5 * dimensions.base_width * Vec3(1, 1, 0);
}

Vec3 PillarShape::upper_corner() const
{
  return base + 0.5 * dimensions.base_width * Vec3(1, 1, 0) + Vec3(0, 0, dimensions.base_height + dimensions.height);
}

namespace
{
/// Lowest corner of the beam, continued through the block and as far again behind it.
Vec3 beam_corner(const Vec3 &lower, const Vec3 &beam_size, const Vec3 &block_size)
{
  if (!(beam_size[1] < block_size[1] && beam_size[2] < block_size[2]) || (beam_size.array() <= 0).any() ||
      (block_size.array() <= 0).any())
    throw std::invalid_argument(
        "a cantilever needs positive lengths and a root block wider than the beam along y and z");
  return lower + Vec3(-beam_size[0] - block_size[0], 0.5 * (block_size[1] - beam_size[1]),
                      0.5 * (block_size[2] - beam_size[2]));
}
} // namespace

CantileverShape::CantileverShape(const Vec3 &lower, const Vec3 &beam_size, const Vec3 &block_size)
    : beam(beam_corner(lower, beam_size, block_size),
           beam_corner(lower, beam_size, block_size) +
               Vec3(2 * (beam_size[0] + block_size[0]), beam_size[1], beam_size[2])),
      block(lower, lower + block_size)
{
}

bool CantileverShape::belongs_to_beam(const Vec3 &x) const
{
  return beam.signed_distance(x) < block.signed_distance(x);
}

double CantileverShape::signed_distance(const Vec3 &x) const
{
  // The beam ends at the back of the block like the block itself.
  const double merged = std::min(beam.signed_distance(x), block.signed_distance(x));
  return std::max(merged, block.lower_corner()[0] - x[0]);
}

Vec3 CantileverShape::outward_normal(const Vec3 &x) const
{
  if (face(x) == 1)
    return -Vec3::UnitX();
  return belongs_to_beam(x) ? beam.outward_normal(x) : block.outward_normal(x);
}

int CantileverShape::face(const Vec3 &x) const
{
  const double merged = std::min(beam.signed_distance(x), block.signed_distance(x));
  if (block.lower_corner()[0] - x[0] >= merged)
    return 1;
  if (!belongs_to_beam(x))
    return 6;
  const int side = beam.face(x);
  return side <= 1 ? 0 : side;
}

double CantileverShape::volume() const
{
  const Vec3 size = beam.upper_corner() - beam.lower_corner();
  return block.volume() + (beam.upper_corner()[0] - block.upper_corner()[0]) * size[1] * size[2];
}

Vec3 CantileverShape::upper_corner() const
{
  Vec3 corner = block.upper_corner();
  corner[0] = beam.upper_corner()[0];
  return corner;
}
} // namespace ddfem
