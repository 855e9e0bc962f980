// Linear viscous glide in a crystal, with drag coefficients of their own for every family of slip systems.
#pragma once

#include "dd/mobility/linear_glide.h"
#include "dd/mobility/slip_family.h"

#include <map>

namespace ddfem
{
/// f = B(theta) v with the coefficients of the line's family: {111}<110> in fcc; {110}, {112} and {123}<111> in bcc, where screws are slower than
/// edges; basal, prismatic and pyramidal slip in hcp. A line is sessile, that is, keeps its nodes on itself, if it has no glide plane, if the
/// crystal has no slip system of its Burgers vector and plane, or if that family has no coefficients here.
/// Sources: as LinearGlide; families of hcp with drags of their own: Monnet, Devincre & Kubin, Acta Mater. 52 (2004) 4317.
class FamilyGlide : public MobilityLaw
{
public:
  /// Throws std::invalid_argument if there are no coefficients, or one is not positive.
  FamilyGlide(SlipSystems slip_systems, std::map<SlipFamily, CharacterDrag> drag_coefficients);

  ArmConstraint constraint(const LineState &line) const override;
  Resistance resistance(const LineState &line, const Vec3 &velocity) const override;
  double drag(const LineState &line) const override;
  bool is_linear() const override { return true; }

private:
  /// Null for a sessile line.
  const CharacterDrag *coefficients_of(const LineState &line) const;

  SlipSystems systems;
  std::map<SlipFamily, CharacterDrag> coefficients;
};
} // namespace ddfem
