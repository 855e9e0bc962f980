// The cross section that a plane face shows: area, centre, second moments.
#pragma once

#include "fem/triangulation.h"

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/types.h>

namespace ddfem::fem
{
/// Moments of a boundary as a plane figure.
struct FaceSection
{
  double area = 0.;        ///< nm^2
  dealii::Point<3> centre; ///< nm
  /// int (x - centre)(x - centre)^T dS, nm^4. Along unit vectors e of the plane e . second . e is the second moment of area
  /// of bending in which e is the direction across; the trace is the polar moment.
  dealii::SymmetricTensor<2, 3> second;
};

/// Of all faces with the given boundary id, with a mapping of the given degree; zeros for an unknown one. Collective.
FaceSection face_section(const Triangulation &triangulation, dealii::types::boundary_id boundary,
                         unsigned mapping_degree = 2);
} // namespace ddfem::fem
