#pragma once

#include "fem/triangulation.h"

#include <deal.II/base/point.h>

namespace ddfem::fem
{
/// Round pillar with axis z on a square base, with a fillet where they meet. Lengths in nm.
struct PillarGeometry
{
  double top_radius = 500.;
  double height = 2000.; ///< above the base
  double taper = 0.;     ///< angle between side and axis, rad; positive: narrower at the top
  double fillet_radius = 0.;
  double base_width = 3000.;
  double base_height = 1000.;

  /// Radius where the circle of the fillet touches the base; without fillet that of the pillar's foot.
  double foot_radius() const;
  /// Radius of pillar and fillet at the height @p z above the base, z > 0.
  double radius_at(double z) const;
  /// Height of fillet and base at the distance @p r from the axis, beyond the middle of the fillet.
  double floor_at(double r) const;
  /// Height above the base at which side and fillet touch.
  double fillet_top() const;
  /// Height of the middle of the fillet: where in the mesh the pillar begins.
  double fillet_middle() const;
};

/// Number of cells.
struct PillarCells
{
  unsigned across; ///< a diameter, at least 3
  unsigned base;   ///< through the height of the base
  unsigned along;  ///< along the pillar
};

/// Serial mesh of the pillar; the centre of the bottom of the base is the origin. Boundary ids: side with the fillet 0, bottom
/// 1, top 2, upper face of the base 3, sides of the base 4. Cells of the base outside the pillar are about as wide as high.
/// The side carries its manifold, see attach_pillar_manifolds().
void make_pillar(SerialTriangulation &triangulation, const PillarGeometry &geometry, const PillarCells &n);

/// Lets new points of the side of a pillar that stands at @p base (nm) lie on cone and fillet: coordinates (radius over that of
/// the profile, angle, height) on the pillar and (radius, angle, height above the profile) on the lower half of the fillet.
void attach_pillar_manifolds(SerialTriangulation &triangulation, const PillarGeometry &geometry,
                             const dealii::Point<3> &base);
} // namespace ddfem::fem
