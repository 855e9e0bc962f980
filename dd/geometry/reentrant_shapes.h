// Re-entrant grains of simple shape: a pillar on its base, a cantilever at its root block.
#pragma once

#include "dd/geometry/grain_shape.h"

#include <array>

namespace ddfem
{
/// Round pillar with axis z, tapered, on a square base, with a fillet where they meet. Lengths in nm.
struct PillarDimensions
{
  double top_radius = 0;
  double height = 0; ///< of the pillar, from the upper face of the base
  double taper = 0;  ///< angle between the side and the axis, rad; positive: narrower at the top
  double fillet_radius = 0;
  double base_width = 0; ///< edge of the square
  double base_height = 0;

  /// Radius of the side without fillet at height @p z above the base's upper face.
  double side_radius(double z) const;
  /// Centre (radius, height above the base's upper face) of the circle of the fillet, which touches side and base.
  std::array<double, 2> fillet_centre() const;
  /// Height at which the fillet touches the side.
  double fillet_top() const;
  /// Throws std::invalid_argument with one sentence if lengths are not positive, the taper is not in [0, 45) degrees, or the fillet does not fit.
  void check() const;
};

/// Faces side (with the fillet), bottom, top, base-top, base-side are 0..4.
///
/// The distance is that of the profile in the plane of radius and height: side and base meet as the minimum of their
/// distances, rounded by the circle of the fillet inside the cone below its centre, which is exact; the other faces cut this as
/// half-spaces.
class PillarShape final : public GrainShape
{
public:
  /// @p base: centre of the bottom of the base.
  PillarShape(const Vec3 &base, const PillarDimensions &dimensions);
  double signed_distance(const Vec3 &x) const override;
  Vec3 outward_normal(const Vec3 &x) const override;
  int face(const Vec3 &x) const override;
  double volume() const override;
  bool is_convex() const override { return false; }
  Vec3 lower_corner() const override;
  Vec3 upper_corner() const override;

private:
  struct Nearest
  {
    double distance;
    int face;
    Vec3 normal;
  };
  Nearest nearest(const Vec3 &x) const;
  Nearest profile(const Vec3 &r) const;

  Vec3 base;
  PillarDimensions dimensions;
};

/// Beam along x that grows from the middle of the face x+ of a root block. Faces end, root (the block's face x-), beam-y-,
/// beam-y+, beam-z-, beam-z+, block (all others) are 0..6.
class CantileverShape final : public GrainShape
{
public:
  /// @p lower: lowest corner of the block. Throws std::invalid_argument unless the block is wider than the beam along y and z.
  CantileverShape(const Vec3 &lower, const Vec3 &beam_size, const Vec3 &block_size);
  double signed_distance(const Vec3 &x) const override;
  Vec3 outward_normal(const Vec3 &x) const override;
  int face(const Vec3 &x) const override;
  double volume() const override;
  bool is_convex() const override { return false; }
  Vec3 lower_corner() const override { return block.lower_corner(); }
  Vec3 upper_corner() const override;

private:
  bool belongs_to_beam(const Vec3 &x) const;
  BoxShape beam; ///< continued through the block, so that its surface there is never the nearest
  BoxShape block;
};
} // namespace ddfem
