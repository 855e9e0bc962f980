// Climb of lines without a glide plane.
#pragma once

#include "dd/mobility/mobility_law.h"

namespace ddfem
{
/// Adds to another law that lines without a glide plane move across themselves against a drag B_c, f = B_c v: the sessile sides of prismatic
/// loops and sessile junctions climb. Lines on a glide plane stay on it.
///
/// A linear drag is the limit of small supersaturation of climb controlled by diffusion (Bako, Clouet, Dupuy & Bletry, Phil. Mag. 91 (2011) 3173);
/// B_c is then k T ln(R/r_c) b_e^2/(2 pi D c_0 Omega^2), with the self-diffusion coefficient D c_0, for the user to give. Drag tensor with glide and climb parts: Cai &
/// Bulatov, Mater. Sci. Eng. A 387-389 (2004) 277.
class Climb : public MobilityLaw
{
public:
  /// @p climb_drag B_c, MPa ns. Throws std::invalid_argument if it is not positive.
  Climb(MobilityPointer glide_law, double climb_drag);

  ArmConstraint constraint(const LineState &line) const override;
  Resistance resistance(const LineState &line, const Vec3 &velocity) const override;
  double drag(const LineState &line) const override;
  bool is_linear() const override { return glide->is_linear(); }

private:
  MobilityPointer glide;
  double coefficient;
};
} // namespace ddfem
