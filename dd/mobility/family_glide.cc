#include "dd/mobility/family_glide.h"

#include <stdexcept>
#include <utility>

namespace ddfem
{
FamilyGlide::FamilyGlide(SlipSystems slip_systems, std::map<SlipFamily, CharacterDrag> drag_coefficients)
    : systems(std::move(slip_systems)), coefficients(std::move(drag_coefficients))
{
  if (coefficients.empty())
    throw std::invalid_argument("a mobility law needs drag coefficients");
  for (const auto &[family, drag] : coefficients)
    if (!(drag.edge > 0 && drag.screw > 0))
      throw std::invalid_argument(std::string("the drag of ") + name_of(family) + " must be positive");
}

const CharacterDrag *FamilyGlide::coefficients_of(const LineState &line) const
{
  const auto family = slip_family(systems, line);
  const auto found = family ? coefficients.find(*family) : coefficients.end();
  return found == coefficients.end() ? nullptr : &found->second;
}

ArmConstraint FamilyGlide::constraint(const LineState &line) const
{
  return {coefficients_of(line) ? line.normal : Vec3(Vec3::Zero()), line.direction};
}

Resistance FamilyGlide::resistance(const LineState &line, const Vec3 &velocity) const
{
  const Mat3 slope = drag(line) * (Mat3::Identity() - line.direction * line.direction.transpose());
  return {slope * velocity, slope};
}

double FamilyGlide::drag(const LineState &line) const
{
  const CharacterDrag *drag = coefficients_of(line);
  return (drag ? *drag : coefficients.begin()->second)(line.squared_cosine());
}
} // namespace ddfem
