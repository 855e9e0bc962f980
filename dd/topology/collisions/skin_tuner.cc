#include "dd/topology/collisions/skin_tuner.h"

#include <algorithm>
#include <cmath>

namespace ddfem
{
void SkinTuner::retire(std::size_t steps, std::size_t entered, bool expired, double displacement)
{
  entered_ = static_cast<double>(entered);
  // The list was good for `steps` steps, but not for one more if it has expired. Between these limits, nodes that move
  // straight drift as fast as they are displaced.
  const auto n = static_cast<double>(steps);
  const double room = last_.skin / (2 * safety);
  const double sample = std::clamp(displacement, expired ? room / (n + 1) : 0.0, room / n);
  drift_ = drift_ < 0 ? sample : 0.5 * (drift_ + sample);
}

double SkinTuner::pairs(double skin) const
{
  const auto &bins = last_.pairs;
  const double position = skin / last_.skin * n_bins;
  double sum = static_cast<double>(bins[0]); // with the first bin as a whole: touching spheres are in it
  double half = sum;
  for (std::size_t k = 1; k < n_bins; ++k)
  {
    const double part = std::clamp(position - static_cast<double>(k), 0.0, 1.0);
    sum += part * static_cast<double>(bins[k]);
    half += k < n_bins / 2 ? static_cast<double>(bins[k]) : 0.0;
  }
  if (skin <= last_.skin || half == 0)
    return sum;
  const double reach = last_.reach + last_.skin;
  const double power = std::log(sum / half) / std::log(reach / (reach - last_.skin / 2));
  return sum * std::pow((last_.reach + skin) / reach, std::min(power, 4.0));
}

double SkinTuner::cost(double skin) const
{
  const double width = (last_.reach + skin) / (last_.reach + last_.skin);
  const double build =
      build_cost * last_.n_segments + test_cost * last_.sphere_tests * width * width + enter_cost * entered_;
  const double steps = drift_ > 0 ? std::max(1.0, std::floor(skin / (2 * safety * drift_) * (1 + 1e-9))) : INFINITY;
  return build / steps + pair_cost * pairs(skin);
}

double SkinTuner::choose(double displacement, double reach) const
{
  const double least = std::max({2 * safety * displacement, 0.01 * reach, 1e-9});
  if (drift_ < 0)
    return std::max(least, 0.25 * reach);
  const double step = 2 * safety * drift_;
  double best = 0, lowest = INFINITY;
  for (int k = -8; k <= 8; ++k) // factors of 2^(1/8): the model is trusted between half and twice the present skin
  {
    double skin = last_.skin * std::exp2(k / 8.0);
    const double steps = std::max(1.0, std::floor(skin / step));
    if (steps < 16) // no more than these steps need
      skin = steps * step;
    skin = std::max(skin, least);
    const double c = cost(skin);
    if (c < lowest)
    {
      lowest = c;
      best = skin;
    }
  }
  return best;
}
} // namespace ddfem
