#include "dd/forces/segment_points.h"

#include "dd/elasticity/gauss.h"

#include <algorithm>

namespace ddfem
{
namespace
{
constexpr int n_gauss = 3;
/// Longest panel over the length on which the field varies at its ends: with an image at twice the depth the
/// singularity is outside an ellipse of rho = 4 around the panel, where three points err by 4^-6.
constexpr double panel_ratio = 2.0;
/// Halvings; a panel at the surface is then a few core radii long.
constexpr int deepest = 7;
} // namespace

SegmentPoints::SegmentPoints(const Network &network, const SmoothLength &smooth_length) : first{0}
{
  first.reserve(network.n_segments() + 1);
  for (const SegmentIndex s : network.segments())
  {
    add_panels(network.position(network.start(s)), network.direction(s), 0.0, 1.0, 0, smooth_length);
    first.push_back(points.size());
  }
}

void SegmentPoints::add_panels(const Vec3 &start, const Vec3 &direction, const double low, const double high,
                               const int level, const SmoothLength &smooth_length)
{
  if (smooth_length && level < deepest)
  {
    const double smooth = std::min(smooth_length(start + low * direction), smooth_length(start + high * direction));
    if ((high - low) * direction.norm() > panel_ratio * smooth)
    {
      const double middle = 0.5 * (low + high);
      add_panels(start, direction, low, middle, level + 1, smooth_length);
      add_panels(start, direction, middle, high, level + 1, smooth_length);
      return;
    }
  }
  const GaussRule rule = gauss_rule(n_gauss);
  for (std::size_t q = 0; q < rule.points.size(); ++q)
  {
    along.push_back(low + rule.points[q] * (high - low));
    weight.push_back(rule.weights[q] * (high - low));
    points.emplace_back(start + along.back() * direction);
  }
}
} // namespace ddfem
