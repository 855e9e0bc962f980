#pragma once

#include "fem/nodal_grid.h"

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <vector>

namespace ddfem::fem
{
/// A rigid motion u(x) = shift + spin x (x - centre) / length, small rotation.
struct RigidMotion
{
  dealii::Tensor<1, 3> shift;
  dealii::Tensor<1, 3> spin;

  dealii::Tensor<1, 3> at(const dealii::Tensor<1, 3> &scaled_arm) const
  {
    return shift + cross_product_3d(spin, scaled_arm);
  }
};

/// The six rigid motions: three translations, three rotations, unit amplitude.
std::array<RigidMotion, 6> all_rigid_motions();

/// Rigid motions that vanish on all prescribed unknowns: the null space of the six motions restricted to them, found
/// from the eigenvalues of their Gram matrix. `prescribed` holds one flag for each local node and component; arms are
/// measured from `centre` in units of `length`. Collective.
std::vector<RigidMotion> free_rigid_motions(const NodalGrid &grid, const std::vector<std::array<bool, 3>> &prescribed,
                                            const dealii::Point<3> &centre, double length);
} // namespace ddfem::fem
