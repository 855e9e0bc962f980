// Orientation of a crystal in the sample.
#pragma once

#include "dd/crystal/miller.h"

namespace ddfem
{
/// Axis of the sample frame.
enum class SampleAxis
{
  x,
  y,
  z,
};

/// Proper rotation from the crystal frame (cubic axes) to the sample frame. Used once, on reading: everything stored
/// and computed is in the sample frame.
class Orientation
{
public:
  /// Sample axes along [100], [010], [001].
  Orientation() = default;

  /// The cubic crystal direction @p a lies along sample axis @p axis_a and @p b along @p axis_b; the third axis
  /// completes a right-handed frame.
  /// Throws std::invalid_argument if a direction is zero, the axes are the same, or the directions are not orthogonal.
  static Orientation from_axes(SampleAxis axis_a, const Miller &a, SampleAxis axis_b, const Miller &b);
  /// The cubic crystal direction @p direction lies along @p axis. The axis that follows it (x after z) gets the
  /// orthogonal direction of smallest indices; among equals the one with the largest first, then second, then third
  /// index. Example: z along [001] puts x along [100]; z along [111] puts x along [10-1].
  /// Throws std::invalid_argument if the direction is zero.
  static Orientation from_loading_axis(const Miller &direction, SampleAxis axis = SampleAxis::z);
  /// Throws std::invalid_argument if @p rotation is not orthonormal to 1e-9 with determinant +1.
  static Orientation from_rotation(const Mat3 &rotation);

  /// Matrix R with v_sample = R v_crystal; its rows are the sample axes in the crystal frame.
  const Mat3 &rotation() const { return rotation_; }
  Vec3 to_sample(const Vec3 &v_crystal) const { return rotation_ * v_crystal; }
  Vec3 to_crystal(const Vec3 &v_sample) const { return rotation_.transpose() * v_sample; }
  /// Unit vector (sample frame) along cubic indices: a direction, or the normal of a plane.
  Vec3 unit_vector(const Miller &m) const { return rotation_ * to_vector(m).normalized(); }

private:
  explicit Orientation(const Mat3 &rotation) : rotation_(rotation) {}
  Mat3 rotation_ = Mat3::Identity();
};
} // namespace ddfem
