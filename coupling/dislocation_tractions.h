// The infinite-body stress of the dislocations as the load of the correction problem.
#pragma once

#include "dd/elasticity/segment_stress.h"
#include "dd/forces/line_system.h"
#include "fem/traction_field.h"

#include <vector>

namespace ddfem::coupling
{
/// Presents a LineSystem to the FEM: every straight line is a source, followed by every ray. The stress of the non-singular
/// theory is analytic up to the distance sqrt(d^2 + a^2) in the complex plane, d being the distance to the line: that is
/// its smooth length.
class DislocationTractions final : public fem::TractionField
{
public:
  /// @p lines, without periodic images, must outlive the object.
  explicit DislocationTractions(const LineSystem &lines);

  unsigned n_sources() const override;
  void smooth_lengths(const dealii::Point<3> &centre, double radius, std::span<const unsigned> sources,
                      std::span<double> lengths) const override;
  void add_stress(std::span<const unsigned> sources, std::span<const dealii::Point<3>> points,
                  std::span<dealii::SymmetricTensor<2, 3>> values) const override;

private:
  const LineSystem &line_system;
  std::vector<SegmentStressField> lines;
  std::vector<RayStressField> rays;
};
} // namespace ddfem::coupling
