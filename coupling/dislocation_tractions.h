// The infinite-body stress of the dislocations as the load of the correction problem.
#pragma once

#include "dd/forces/line_system.h"
#include "fem/traction_field.h"

namespace ddfem::coupling
{
/// Presents a LineSystem to the FEM. The stress of the non-singular theory is analytic up to the distance
/// sqrt(d^2 + a^2) in the complex plane, d being the distance to the nearest line: that is its smooth length.
class DislocationTractions final : public fem::TractionField
{
public:
  /// @p lines must outlive the object.
  explicit DislocationTractions(const LineSystem &lines) : line_system(lines) {}

  double smooth_length(const dealii::Point<3> &centre, double radius) const override;
  void smooth_lengths(const std::vector<dealii::Point<3>> &centres, const std::vector<double> &radii,
                      std::vector<double> &lengths) const override;
  void stress(const std::vector<dealii::Point<3>> &points,
              std::vector<dealii::SymmetricTensor<2, 3>> &values) const override;

private:
  const LineSystem &line_system;
};
} // namespace ddfem::coupling
