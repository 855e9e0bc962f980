// Where external stress fields act on the segments.
#pragma once

#include "dd/network/network.h"

#include <functional>
#include <span>
#include <vector>

namespace ddfem
{
/// Gauss points of all segments, in the order of Network::segments(). Three on each segment; where a field varies over
/// less than the length of the segment, three on each of the panels into which it is halved.
class SegmentPoints
{
public:
  /// Length (nm) over which the field varies at a point.
  using SmoothLength = std::function<double(const Vec3 &)>;

  SegmentPoints() = default;
  explicit SegmentPoints(const Network &network, const SmoothLength &smooth_length = {});

  const std::vector<Vec3> &positions() const { return points; } ///< nm
  std::size_t n_segments() const { return first.empty() ? 0 : first.size() - 1; }
  /// Index of the first point of segment number @p i (or one past the last point).
  std::size_t begin_of(std::size_t i) const { return first[i]; }
  /// Positions of the points of segment number @p i along it, 0 to 1, and weights, which sum to one.
  std::span<const double> fractions(std::size_t i) const { return slice(along, i); }
  std::span<const double> weights(std::size_t i) const { return slice(weight, i); }

private:
  std::span<const double> slice(const std::vector<double> &values, std::size_t i) const
  {
    return {values.data() + first[i], first[i + 1] - first[i]};
  }
  void add_panels(const Vec3 &start, const Vec3 &direction, double low, double high, int level,
                  const SmoothLength &smooth_length);

  std::vector<std::size_t> first;
  std::vector<double> along, weight;
  std::vector<Vec3> points;
};

/// The correction field at the points of the segments, MPa.
struct SegmentField
{
  SegmentPoints points;
  std::vector<SymTensor> stress;         ///< all of it
  std::vector<SymTensor> without_images; ///< the part of the finite elements
};
} // namespace ddfem
