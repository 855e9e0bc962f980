#include "dd/crystal/unit_cell.h"

#include "dd/crystal/miller_bravais.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace ddfem
{
namespace
{
constexpr double inverse_sqrt3 = std::numbers::inv_sqrt3;
} // namespace

UnitCell UnitCell::hexagonal(const double c_over_a)
{
  if (!(c_over_a > 0.5 && c_over_a < 3))
    throw std::invalid_argument("The axial ratio c/a of the hexagonal cell is " + std::to_string(c_over_a) +
                                "; it must lie between 0.5 and 3.");
  UnitCell cell;
  cell.c_over_a_ = c_over_a;
  return cell;
}

Vec3 UnitCell::direction(const Miller &uvw) const
{
  if (is_cubic())
    return to_vector(uvw);
  const Vec3 m = to_vector(uvw);
  return {m[0] - m[1] / 2, m[1] * std::numbers::sqrt3 / 2, m[2] * *c_over_a_};
}

Vec3 UnitCell::normal(const Miller &hkl) const
{
  if (is_cubic())
    return to_vector(hkl);
  const Vec3 m = to_vector(hkl);
  return {m[0], (m[0] + 2 * m[1]) * inverse_sqrt3, m[2] / *c_over_a_};
}

Vec3 UnitCell::coordinates(const Vec3 &crystal_vector) const
{
  if (is_cubic())
    return crystal_vector;
  const double v = 2 * inverse_sqrt3 * crystal_vector[1];
  return {crystal_vector[0] + v / 2, v, crystal_vector[2] / *c_over_a_};
}

bool UnitCell::orthogonal(const Miller &a, const Miller &b) const
{
  if (is_cubic())
    return dot(a, b) == 0;
  return std::abs(direction(a).normalized().dot(direction(b).normalized())) < 1e-9;
}

std::string UnitCell::plane_name(const Miller &hkl) const
{
  return "(" + (is_cubic() ? to_string(hkl) : to_string(to_four_index_plane(hkl))) + ")";
}

std::string UnitCell::direction_name(const Miller &uvw) const
{
  return "[" + (is_cubic() ? to_string(uvw) : to_string(to_four_index_direction(uvw))) + "]";
}
} // namespace ddfem
