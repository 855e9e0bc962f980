// Miller indices: the only place where the crystal frame appears.
#pragma once

#include "dd/common/types.h"

#include <array>
#include <string>

namespace ddfem
{
/// Three integer indices [u v w] of a direction or (h k l) of a plane, crystal frame. In a cubic crystal a direction is
/// normal to the plane of the same indices, and both are Cartesian vectors of the crystal frame.
using Miller = std::array<int, 3>;

/// The indices as a vector (cubic crystals: Cartesian, crystal frame, not of unit length).
Vec3 to_vector(const Miller &m);
long dot(const Miller &a, const Miller &b);
Miller cross(const Miller &a, const Miller &b);
bool is_zero(const Miller &m);
/// Divided by the greatest common divisor; the sense is kept.
Miller reduced(const Miller &m);
/// reduced(), with the sense that makes the first non-zero index positive: +m and -m become equal.
Miller without_sense(const Miller &m);
/// "1-11" with single digits, "10 -1 2" otherwise.
std::string to_string(const Miller &m);

/// Smallest integer indices along @p v: the best @p m with |index| <= @p max_index whose direction is within
/// @p tolerance (rad) of v. All zero if there is none. The sense of v is kept.
Miller rationalised(const Vec3 &v, int max_index = 9, double tolerance = 1e-4);
} // namespace ddfem
