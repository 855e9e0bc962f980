// Gauss rules of different orders side by side in the lanes.

#if defined(DDFEM_DD_ELASTICITY_LANE_RULES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DDFEM_DD_ELASTICITY_LANE_RULES_INL_H
#undef DDFEM_DD_ELASTICITY_LANE_RULES_INL_H
#else
#define DDFEM_DD_ELASTICITY_LANE_RULES_INL_H
#endif

#include "dd/elasticity/gauss.h"
#include "dd/elasticity/real-inl.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace ddfem::HWY_NAMESPACE
{
/// Positions and weights on [0, 1]. Lanes with fewer points than others, or none, get points without weight.
class LaneRules
{
public:
  /// @p n_of_lane: numbers of points; nothing is to be done where they are not positive.
  explicit LaneRules(const double *const n_of_lane)
  {
    for (std::size_t l = 0; l < n_lanes; ++l)
      n = std::max(n, static_cast<int>(n_of_lane[l]));
    for (std::size_t l = 0; l < n_lanes; ++l)
      equal = equal && static_cast<int>(n_of_lane[l]) == n;
    if (n > 0 && !equal)
      for (std::size_t l = 0; l < n_lanes; ++l)
        fill(l, static_cast<int>(n_of_lane[l]));
  }

  /// Whether some points have no weight.
  bool has_idle_lanes() const { return !equal; }

  /// Calls @p add(position, weight), two vectors, for each point.
  template <class Add> HWY_INLINE void for_each(Add &&add) const
  {
    if (n == 0)
      return;
    if (!equal)
    {
      for (int q = 0; q < n; ++q)
        add(Real::load(positions[q]), Real::load(weights[q]));
      return;
    }
    const GaussRule rule = gauss_rule(n);
    for (std::size_t q = 0; q < rule.points.size(); ++q)
      add(Real(rule.points[q]), Real(rule.weights[q]));
  }

private:
  void fill(const std::size_t lane, const int n_points)
  {
    std::size_t q = 0;
    if (n_points > 0)
      for (const GaussRule rule = gauss_rule(n_points); q < rule.points.size(); ++q)
      {
        positions[q][lane] = rule.points[q];
        weights[q][lane] = rule.weights[q];
      }
    for (; q < static_cast<std::size_t>(n); ++q)
    {
      positions[q][lane] = 0.5;
      weights[q][lane] = 0.0;
    }
  }

  int n = 0;         // largest number of points
  bool equal = true; // all lanes have that many
  double positions[max_gauss_points][n_lanes], weights[max_gauss_points][n_lanes];
};
} // namespace ddfem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
