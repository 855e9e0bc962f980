// Linear viscous glide.
#pragma once

#include "dd/mobility/mobility_law.h"

namespace ddfem
{
/// Drag coefficients of one kind of line, MPa ns (1e-3 Pa s = 1 MPa ns). Between the characters
/// B(theta) = B_screw cos^2 theta + B_edge sin^2 theta, theta the angle between line and Burgers vector.
struct CharacterDrag
{
  double edge = 0.0, screw = 0.0;

  double operator()(const double squared_cosine) const { return edge + (screw - edge) * squared_cosine; }
};

/// Phonon drag proportional to the velocity, the same on all slip planes: f = B(theta) v.
/// Source: Hirth & Lothe, Theory of Dislocations, 2nd ed. 1982, section 7-7; interpolation in the character: Arsenlis et al.,
/// MSMSE 15 (2007) 553.
class LinearGlide : public MobilityLaw
{
public:
  explicit LinearGlide(const CharacterDrag &drag_coefficients) : coefficients(drag_coefficients) {}

  Resistance resistance(const LineState &line, const Vec3 &velocity) const override;
  double drag(const LineState &line) const override { return coefficients(line.squared_cosine()); }
  bool is_linear() const override { return true; }

private:
  CharacterDrag coefficients;
};

/// Drag coefficients in MPa ns.
MobilityPointer linear_glide(double edge, double screw);
} // namespace ddfem
