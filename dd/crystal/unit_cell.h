// The axes to which Miller indices refer.
#pragma once

#include "dd/crystal/miller.h"

#include <optional>
#include <string>

namespace ddfem
{
/// Shape of the conventional unit cell in the Cartesian crystal frame. Lengths in units of the lattice parameter a.
///
/// Cubic: the cell axes are the Cartesian axes. Hexagonal: a1 = [100] = [2-1-10] along x, a2 = (-1/2, sqrt(3)/2, 0), so
/// that y is along [120] = [01-10], and c = [001] = [0001] along z with length c/a.
///
/// Planes are (h k l) and directions [u v w] of these three axes for both; a direction lies in a plane if
/// h u + k v + l w = 0. Names of hexagonal planes and directions have the four Miller-Bravais indices, see
/// miller_bravais.h.
class UnitCell
{
public:
  /// Cubic.
  UnitCell() = default;
  /// Throws std::invalid_argument unless 0.5 < c/a < 3, which every hcp metal is far within (1.57 to 1.89).
  static UnitCell hexagonal(double c_over_a);

  bool is_cubic() const { return !c_over_a_; }
  /// 1 for a cubic cell.
  double c_over_a() const { return c_over_a_.value_or(1.0); }

  /// The lattice direction u a1 + v a2 + w a3 in the Cartesian crystal frame, units of a.
  Vec3 direction(const Miller &uvw) const;
  /// Normal h b1 + k b2 + l b3 of a plane in the Cartesian crystal frame, with b_i . a_j = delta_ij, units of 1/a; its
  /// length is the inverse spacing of the planes.
  Vec3 normal(const Miller &hkl) const;
  /// Coordinates u, v, w of a vector of the Cartesian crystal frame; inverse of direction().
  Vec3 coordinates(const Vec3 &crystal_vector) const;
  /// Whether two lattice directions are orthogonal: exactly in integers for a cubic cell, to 1e-9 rad otherwise.
  bool orthogonal(const Miller &a, const Miller &b) const;

  /// "(1-11)" or "(10-11)".
  std::string plane_name(const Miller &hkl) const;
  /// "[1-10]" or "[2-1-13]".
  std::string direction_name(const Miller &uvw) const;

private:
  std::optional<double> c_over_a_; ///< empty: cubic
};
} // namespace ddfem
