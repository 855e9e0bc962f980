#include "dd/crystal/miller.h"

#include <cmath>
#include <cstdlib>
#include <numeric>

namespace ddfem
{
Vec3 to_vector(const Miller &m)
{
  return Eigen::Vector3i(m[0], m[1], m[2]).cast<double>();
}

long dot(const Miller &a, const Miller &b)
{
  return long{a[0]} * b[0] + long{a[1]} * b[1] + long{a[2]} * b[2];
}

Miller cross(const Miller &a, const Miller &b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

bool is_zero(const Miller &m)
{
  return m == Miller{};
}

Miller reduced(const Miller &m)
{
  const int divisor = std::gcd(std::gcd(m[0], m[1]), m[2]);
  return divisor == 0 ? m : Miller{m[0] / divisor, m[1] / divisor, m[2] / divisor};
}

Miller without_sense(const Miller &m)
{
  const Miller r = reduced(m);
  for (const int index : r)
    if (index != 0)
      return index > 0 ? r : Miller{-r[0], -r[1], -r[2]};
  return r;
}

std::string to_string(const Miller &m)
{
  bool single_digits = true;
  for (const int index : m)
    single_digits = single_digits && std::abs(index) < 10;
  const std::string separator = single_digits ? "" : " ";
  return std::to_string(m[0]) + separator + std::to_string(m[1]) + separator + std::to_string(m[2]);
}

Miller rationalised(const Vec3 &v, int max_index, double tolerance)
{
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0) || !v.allFinite())
    return {};
  // The largest index can be any of 1 ... max_index; the first that fits gives the smallest indices.
  for (int scale = 1; scale <= max_index; ++scale)
  {
    Miller m{};
    for (std::size_t d = 0; d < 3; ++d)
      m[d] = static_cast<int>(std::lround(v[static_cast<Eigen::Index>(d)] / largest * scale));
    const Vec3 direction = to_vector(m).normalized();
    if (direction.cross(v.normalized()).norm() <= tolerance)
      return reduced(m);
  }
  return {};
}
} // namespace ddfem
