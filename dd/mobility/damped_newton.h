// The length of a Newton step down a convex dissipation potential.
#pragma once

#include <cmath>

namespace ddfem
{
/// @p pull(s) is minus the derivative, along a Newton step, of the convex function that is to be minimised, at the fraction s of
/// the step: positive at 0 and never growing. Returns the whole step, unless it leads far over the minimum: then a
/// fraction that leads nearly to it. Friction with a threshold needs this, a linear law never.
template <class Pull> double damped_step(const double pull_at_start, Pull &&pull)
{
  constexpr double overshoot = 0.2; // of the pull at the start, with the other sign
  constexpr int most_halvings = 60;
  double low = 0, high = 1, pull_low = pull_at_start, pull_high = pull(1.0);
  for (int k = 0; k < most_halvings && !(pull_high >= -overshoot * pull_at_start); ++k)
  {
    // Where the pull changes its sign by linear interpolation, but well inside: the function may have a kink.
    const double root = low + (high - low) * pull_low / (pull_low - pull_high);
    const double next = std::isfinite(root) ? std::fmin(std::fmax(root, 0.9 * low + 0.1 * high), 0.5 * (low + high))
                                            : 0.5 * (low + high);
    const double pull_next = pull(next);
    if (pull_next > overshoot * pull_at_start)
    {
      low = next;
      pull_low = pull_next;
    }
    else
    {
      high = next;
      pull_high = pull_next;
    }
  }
  return high;
}
} // namespace ddfem
