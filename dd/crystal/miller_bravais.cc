#include "dd/crystal/miller_bravais.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <stdexcept>

namespace ddfem
{
namespace
{
void require_sum(const MillerBravais &m)
{
  if (m[0] + m[1] + m[2] != 0)
    throw std::invalid_argument("the first three of the four indices " + to_string(m) + " must add up to zero");
}
} // namespace

Miller plane_from_four_indices(const MillerBravais &hkil)
{
  require_sum(hkil);
  return {hkil[0], hkil[1], hkil[3]};
}

Miller direction_from_four_indices(const MillerBravais &uvtw)
{
  require_sum(uvtw);
  return reduced({uvtw[0] - uvtw[2], uvtw[1] - uvtw[2], uvtw[3]});
}

MillerBravais to_four_index_plane(const Miller &hkl)
{
  return {hkl[0], hkl[1], -(hkl[0] + hkl[1]), hkl[2]};
}

MillerBravais to_four_index_direction(const Miller &uvw)
{
  const MillerBravais m = {2 * uvw[0] - uvw[1], 2 * uvw[1] - uvw[0], -(uvw[0] + uvw[1]), 3 * uvw[2]};
  const int divisor = std::gcd(std::gcd(m[0], m[1]), m[3]);
  return divisor == 0 ? m : MillerBravais{m[0] / divisor, m[1] / divisor, m[2] / divisor, m[3] / divisor};
}

std::string to_string(const MillerBravais &m)
{
  const bool single_digits = std::ranges::all_of(m, [](const int index) { return std::abs(index) < 10; });
  std::string text;
  for (const int index : m)
    text += (text.empty() || single_digits ? "" : " ") + std::to_string(index);
  return text;
}
} // namespace ddfem
