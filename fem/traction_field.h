#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>
#include <deal.II/base/types.h>

#include <cstdint>
#include <vector>

namespace ddfem::fem
{
/// Stress field sigma~ (MPa, sample frame) whose traction loads the boundary; implemented by the caller.
class TractionField
{
public:
  virtual ~TractionField() = default;

  /// Lower bound (nm) of the distance between any point of the ball (centre, radius) and the nearest singularity of the
  /// field (for a regularised field the core radius at least). May be infinite; zero or less means nothing is known.
  virtual double smooth_length(const dealii::Point<3> &centre, double radius,
                               dealii::types::boundary_id boundary) const = 0;

  /// smooth_length() of many balls; override it when the whole batch can be had faster (threads). `lengths` has the
  /// right size on entry. Not collective: ranks call it as often as their faces need.
  virtual void smooth_lengths(const std::vector<dealii::Point<3>> &centres, const std::vector<double> &radii,
                              const std::vector<dealii::types::boundary_id> &boundaries,
                              std::vector<double> &lengths) const
  {
    for (std::size_t i = 0; i < centres.size(); ++i)
    {
      lengths[i] = smooth_length(centres[i], radii[i], boundaries[i]);
    }
  }

  /// Stresses (MPa) at points (nm). `values` has the size of `points` on entry. Called by every rank with its own
  /// points, the same number of times on all ranks, possibly with none: collective implementations are allowed.
  virtual void stress(const std::vector<dealii::Point<3>> &points,
                      const std::vector<dealii::types::boundary_id> &boundaries,
                      std::vector<dealii::SymmetricTensor<2, 3>> &values) const = 0;
};

/// Integrals of t = sigma~ n over the whole closed boundary, n outward, summed over the ranks.
struct TractionSummary
{
  dealii::Tensor<1, 3> force;     ///< int t dA, MPa nm^2; zero for a divergence-free field
  dealii::Tensor<1, 3> moment;    ///< int (x - c) x t dA about the grain's centre c, MPa nm^3
  double absolute_force = 0.;     ///< int |t| dA, MPa nm^2: the scale of `force`
  double absolute_moment = 0.;    ///< int |x - c| |t| dA, MPa nm^3: the scale of `moment`
  std::uint64_t n_points = 0;     ///< quadrature points used
  std::uint64_t n_unresolved = 0; ///< pieces of faces at the limit of subdivision, not integrated to the tolerance
};
} // namespace ddfem::fem
