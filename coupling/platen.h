// How the platen of a finite grain moves, and what its motion and load are called.
#pragma once

#include "dd/common/types.h"
#include "fem/face_section.h"

#include <array>

namespace ddfem::coupling
{
/// The one motion of the platen face that is driven; q is its amplitude and Q the load that does work on it.
enum class PlatenMotion
{
  axial,      ///< along the outward normal: q in nm, Q a force (MPa nm^2), tension positive
  transverse, ///< along a direction across the axis, the rest of the face free: end load of a cantilever
  twist,      ///< rotation about the outward normal through the face's centre: q in rad, Q a moment (MPa nm^3)
  bending,    ///< rotation of the face about the axis in its plane; positive stretches the side of positive coordinate
  none        ///< nothing is held: the grain is free
};

/// The platen and the face opposite to it.
class Platen
{
public:
  /// @p axis: coordinate axis of the outward normal, which points along @p sign times it. @p across: coordinate axis of a
  /// transverse motion, or across which the strain of a bent grain varies. @p height: distance of the faces, nm; @p reach: of
  /// the face from its centre, nm (twist), or along @p across (bending). Throws std::invalid_argument where @p across is the axis.
  Platen(PlatenMotion motion, int axis, double sign, int across, const fem::FaceSection &section, double height,
         double reach);

  PlatenMotion motion() const { return kind; }
  /// Displacement of the point @p x of the platen for q = 1, nm.
  Vec3 displacement(const Vec3 &x) const;
  /// Nominal strain per q: 1/height for a displacement; reach/height for a rotation (shear strain of the outermost point, strain of
  /// the outermost fibre).
  double strain_per_motion() const { return strain_factor; }
  /// Nominal stress per Q: 1/area; reach/(polar moment of area) in twist, reach/(second moment of area) in bending.
  double stress_per_load() const { return stress_factor; }
  const Vec3 &centre() const { return face_centre; }
  /// Components prescribed on the platen and on the fixed face; @p clamped: contact with friction.
  std::array<bool, 3> held_by_platen(bool clamped) const;
  std::array<bool, 3> held_by_fixed_face(bool clamped) const;

private:
  PlatenMotion kind;
  int axis, across;
  double sign, strain_factor, stress_factor;
  Vec3 face_centre;
};
} // namespace ddfem::coupling
