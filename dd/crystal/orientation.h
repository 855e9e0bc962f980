// Orientation of a crystal in the sample.
#pragma once

#include "dd/crystal/miller.h"
#include "dd/crystal/unit_cell.h"

namespace ddfem
{
/// Axis of the sample frame.
enum class SampleAxis
{
  x,
  y,
  z,
};

/// Proper rotation from the Cartesian crystal frame to the sample frame, with the cell that gives Miller indices their
/// meaning. Used once, on reading: everything stored and computed is in the sample frame.
class Orientation
{
public:
  /// Cubic, sample axes along [100], [010], [001].
  Orientation() = default;
  /// Sample axes along the Cartesian axes of the cell: x along [2-1-10] and z along [0001] of a hexagonal one.
  explicit Orientation(const UnitCell &cell) : cell_(cell) {}

  /// The lattice direction @p a lies along sample axis @p axis_a and @p b along @p axis_b; the third axis completes a
  /// right-handed frame.
  /// Throws std::invalid_argument if a direction is zero, the axes are the same, or the directions are not orthogonal.
  static Orientation from_axes(SampleAxis axis_a, const Miller &a, SampleAxis axis_b, const Miller &b,
                               const UnitCell &cell = {});
  /// Cubic crystals: the direction @p direction lies along @p axis. The axis that follows it (x after z) gets the
  /// orthogonal direction of smallest indices; among equals the one with the largest first, then second, then third
  /// index. Example: z along [001] puts x along [100]; z along [111] puts x along [10-1].
  /// Throws std::invalid_argument if the direction is zero.
  static Orientation from_loading_axis(const Miller &direction, SampleAxis axis = SampleAxis::z);
  /// Throws std::invalid_argument if @p rotation is not orthonormal to 1e-9 with determinant +1.
  static Orientation from_rotation(const Mat3 &rotation, const UnitCell &cell = {});

  /// Matrix R with v_sample = R v_crystal; its rows are the sample axes in the crystal frame.
  const Mat3 &rotation() const { return rotation_; }
  Vec3 to_sample(const Vec3 &v_crystal) const { return rotation_ * v_crystal; }
  Vec3 to_crystal(const Vec3 &v_sample) const { return rotation_.transpose() * v_sample; }
  const UnitCell &cell() const { return cell_; }
  /// Unit vector (sample frame) along the lattice direction [u v w].
  Vec3 direction(const Miller &uvw) const { return rotation_ * cell_.direction(uvw).normalized(); }
  /// Unit normal (sample frame) of the plane (h k l), sense of the reciprocal vector.
  Vec3 plane_normal(const Miller &hkl) const { return rotation_ * cell_.normal(hkl).normalized(); }
  /// Unit vector (sample frame) along cubic indices: a direction, or the normal of a plane. Cubic crystals only.
  Vec3 unit_vector(const Miller &m) const { return rotation_ * to_vector(m).normalized(); }

private:
  Orientation(const Mat3 &rotation, const UnitCell &cell) : rotation_(rotation), cell_(cell) {}
  Mat3 rotation_ = Mat3::Identity();
  UnitCell cell_;
};
} // namespace ddfem
