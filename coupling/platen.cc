#include "coupling/platen.h"

#include "coupling/convert.h"

#include <stdexcept>

namespace ddfem::coupling
{
Platen::Platen(const PlatenMotion motion, const int along, const double outward, const int transverse_axis,
               const fem::FaceSection &section, const double height, const double reach)
    : kind(motion), axis(along), across(transverse_axis), sign(outward), strain_factor(1 / height),
      stress_factor(1 / section.area), face_centre(to_vec3(section.centre))
{
  if ((kind == PlatenMotion::transverse || kind == PlatenMotion::bending) && across == axis)
    throw std::invalid_argument("is the axis of the grain; allowed are the two axes across it");
  if (kind == PlatenMotion::twist)
  {
    strain_factor = reach / height;
    stress_factor = reach / trace(section.second);
  }
  if (kind == PlatenMotion::bending)
  {
    const auto e = static_cast<unsigned>(across);
    strain_factor = reach / height;
    stress_factor = reach / section.second[e][e];
  }
}

Vec3 Platen::displacement(const Vec3 &x) const
{
  const Vec3 normal = sign * Vec3::Unit(axis);
  switch (kind)
  {
    case PlatenMotion::axial: return normal;
    case PlatenMotion::transverse: return Vec3::Unit(across);
    case PlatenMotion::twist: return normal.cross(x - face_centre);
    case PlatenMotion::bending: return (x - face_centre)[across] * normal;
    case PlatenMotion::none: break;
  }
  return Vec3::Zero();
}

std::array<bool, 3> Platen::held_by_platen(const bool clamped) const
{
  std::array<bool, 3> held{};
  for (int c = 0; c < 3; ++c)
  {
    bool &h = held[static_cast<std::size_t>(c)];
    switch (kind)
    {
      case PlatenMotion::axial: h = clamped || c == axis; break;
      case PlatenMotion::transverse: h = c == across; break;
      case PlatenMotion::twist: h = clamped || c != axis; break;
      case PlatenMotion::bending: h = c == axis; break;
      case PlatenMotion::none: break;
    }
  }
  return held;
}

std::array<bool, 3> Platen::held_by_fixed_face(const bool clamped) const
{
  switch (kind)
  {
    case PlatenMotion::transverse: return {true, true, true};
    case PlatenMotion::none: return {false, false, false};
    case PlatenMotion::bending: return {clamped || axis == 0, clamped || axis == 1, clamped || axis == 2};
    case PlatenMotion::axial:
    case PlatenMotion::twist: break;
  }
  return held_by_platen(clamped);
}
} // namespace ddfem::coupling
