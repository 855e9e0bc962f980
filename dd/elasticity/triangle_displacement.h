// Displacement field of triangular dislocation loops, some of whose vertices may lie at infinity.
#pragma once

#include "dd/common/types.h"

namespace ddfem
{
/// Vertex of a loop: a position (nm), or the unit direction in which a ray goes to infinity.
struct LoopVertex
{
  Vec3 value = Vec3::Zero();
  bool at_infinity = false;

  static LoopVertex at(const Vec3 &position) { return {position, false}; }
  static LoopVertex towards(const Vec3 &unit_direction) { return {unit_direction, true}; }
};

/// Signed solid angle (sr, in [-2 pi, 2 pi]) of the flat triangle @p p1 @p p2 @p p3 seen from @p x, from van Oosterom &
/// Strackee (1983): tan(Omega/2) = l1.(l2 x l3) / (1 + l1.l2 + l2.l3 + l3.l1), l_i the unit vectors from x to the
/// vertices. Positive where the circuit is seen clockwise, that is from the side its right-hand normal points away
/// from.
double solid_angle(const Vec3 &x, const Vec3 &p1, const Vec3 &p2, const Vec3 &p3);

/// The same with vertices at infinity; at least one vertex must be finite.
double solid_angle(const Vec3 &x, const LoopVertex &v1, const LoopVertex &v2, const LoopVertex &v3);

/// Displacement (nm) at @p x (nm) of the triangular loop @p p1 -> @p p2 -> @p p3 -> @p p1 (nm) with Burgers vector @p b
/// (nm, FS/RH) and core radius 0 in an infinite body of Poisson's ratio @p nu: Barnett, Phil. Mag. A 51 (1985) 383,
/// signs as in Fivel & Depres, Phil. Mag. 94 (2014) 3326. Jumps across the triangle itself and nowhere else: the limit
/// from the side the right-hand normal points away from minus the limit from the other side is b. On the extension of
/// an edge the exact, finite value; on an edge, where the field is singular, a finite value (the logarithm is cut off
/// at a tiny distance).
Vec3 triangle_displacement(double nu, const Vec3 &x, const Vec3 &p1, const Vec3 &p2, const Vec3 &p3, const Vec3 &b);

/// The same for vertices that may lie at infinity (all finite: the same as triangle_displacement()):
///  * two finite vertices A, B and one at infinity along d: the half-strip between the rays A + s d and B + s d,
///    bounded by the segment AB. Exact limit of the triangle (A, B, A + L d), the field vanishes at infinity off the
///    strip;
///  * one finite vertex A, two at infinity along d and d': the sector between the rays A + s d and A + s d'. Its field
///    grows like the logarithm of the size and is defined up to a rigid translation only; the terms that do not depend
///    on x are dropped and the logarithms are taken of lengths divided by @p reference_length (nm). d' = -d is not a
///    sector (no plane is defined) and must not be asked for.
/// Each edge contributes on its own and with the sign of its direction, so that common edges of adjacent loops cancel:
/// sums over chains of moves are path independent up to multiples of b and a rigid translation.
/// At least one vertex must be finite.
Vec3 triangle_displacement(double nu, const Vec3 &x, const LoopVertex &v1, const LoopVertex &v2, const LoopVertex &v3,
                           const Vec3 &b, double reference_length = 1.0);
} // namespace ddfem
