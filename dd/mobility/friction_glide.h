// Lattice friction and a limit of the speed.
#pragma once

#include "dd/mobility/mobility_law.h"

namespace ddfem
{
struct FrictionSettings
{
  double stress = 0;        ///< lattice friction: a line stays at rest below this resolved shear stress, MPa
  double largest_speed = 0; ///< that no line reaches, nm/ns; 0: none
};

/// Adds to a linear law, of drag B and constraints, a friction stress tau_f and a drag that grows without bound towards the speed c,
///
///   f(v) = tau_f b v/sqrt(v^2 + v_0^2) + B v/(1 - (v/c)^2).
///
/// The first term is dry friction but for a creep at v_0 = 1e-4 nm/ns (0.1 mm/s): below tau_f the line moves at v_0 tau/sqrt(tau_f^2 - tau^2).
/// The second is the drag of Austin & McDowell (Int. J. Plast. 27 (2011) 1, "relativistic" B_0/(1 - (v/c)^2)), continued linearly
/// beyond 0.999 c. Sources: Hirth & Lothe, Theory of Dislocations, 2nd ed. 1982, sections 7-7 (drag at high speed) and 8-2 (lattice friction).
class FrictionGlide : public MobilityLaw
{
public:
  static constexpr double creep_speed = 1e-4; ///< v_0, nm/ns

  /// Throws std::invalid_argument if @p linear is not linear or a setting is negative.
  FrictionGlide(MobilityPointer linear, const FrictionSettings &friction_settings);

  ArmConstraint constraint(const LineState &line) const override { return viscous->constraint(line); }
  Resistance resistance(const LineState &line, const Vec3 &velocity) const override;
  double drag(const LineState &line) const override { return viscous->drag(line); }

private:
  MobilityPointer viscous;
  FrictionSettings settings;
};
} // namespace ddfem
