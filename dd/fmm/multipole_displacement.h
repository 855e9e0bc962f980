// Displacement of many triangular dislocation loops at many points by a fast multipole method.
#pragma once

#include "dd/elasticity/triangular_loop.h"
#include "dd/fmm/multipole_sum.h"

#include <vector>

namespace ddfem::fmm
{
/// Near pairs of boxes by the closed form (triangle_displacement.h), distant pairs by four harmonic potentials
/// (displacement_expansion.h). The tolerance is relative to the rms of the far displacement.
class MultipoleDisplacement final : public MultipoleSum
{
public:
  /// Finite loops.
  MultipoleDisplacement(double nu, const MultipoleSettings &settings, std::span<const TriangularLoop> loops,
                        std::span<const Vec3> points);

  /// At the points in the order given, nm. Collective: see compute().
  std::vector<Vec3> displacement(MPI_Comm comm, Part part = Part::all);

private:
  MultipoleDisplacement(double nu, const MultipoleSettings &settings, std::span<const TriangularLoop> loops,
                        std::span<const SourceExtent> extents, std::span<const Vec3> points);
  void add_own_moments(const Box &box, const ExpansionView &moments) const override;
  void add_far(const Box &leaf, const Row *fields, const double *q) override;
  void add_near(std::size_t leaf) override;

  double nu;
  std::vector<TriangularLoop> sources; ///< in the tree's order
};
} // namespace ddfem::fmm
