#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>
#include <deal.II/base/types.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace ddfem::fem
{
/// Points (nm) of this rank on one boundary, and what the sum of the first sources misses there.
struct BoundaryPoints
{
  dealii::types::boundary_id boundary;
  std::vector<unsigned> vanishing; ///< sources among the first whose traction is zero there: too much in the sum
  std::vector<unsigned> others;    ///< the other sources whose traction is not
  std::vector<dealii::Point<3>> points;
};

/// Stress field sigma~ (MPa, sample frame) whose traction loads the boundary: a sum over sources 0 ... n_sources() - 1,
/// each with its own singularities. Implemented by the caller. All members are local and are called by several threads
/// at once, each with its own arguments.
class TractionField
{
public:
  virtual ~TractionField() = default;

  virtual unsigned n_sources() const = 0;

  /// Lower bounds (nm), one for each of `sources`, of the distance between any point of the ball (centre, radius; nm) and
  /// the nearest singularity of that source in the complex plane (for a regularised field the core radius at least). May
  /// be infinite; zero or less means that nothing is known.
  virtual void smooth_lengths(const dealii::Point<3> &centre, double radius, std::span<const unsigned> sources,
                              std::span<double> lengths) const = 0;

  /// values += stress (MPa) of all `sources` together at points (nm); both spans have the same size.
  virtual void add_stress(std::span<const unsigned> sources, std::span<const dealii::Point<3>> points,
                          std::span<dealii::SymmetricTensor<2, 3>> values) const = 0;

  /// Whether the traction of a source is known to be zero on the whole boundary with an id; it is not integrated there.
  virtual bool vanishes_on(unsigned /*source*/, dealii::types::boundary_id /*boundary*/) const { return false; }

  /// If the field is to be summed at so many points in all: whether to sum all sources at the same points, corrected for those that are
  /// too near for these, with a relative error of summation_error(). Then the first so many sources (perhaps none) are summed by sum(),
  /// complete_sum() adds the others, faster than one by one. Without a value every source is integrated by itself.
  virtual std::optional<unsigned> n_summed(std::size_t /*n_points*/) const { return {}; }
  virtual double summation_error() const { return 0.; }
  /// Stress (MPa) of the first sources at points of this rank (nm). Collective over the ranks of the mesh.
  virtual std::vector<dealii::SymmetricTensor<2, 3>> sum(std::span<const dealii::Point<3>> /*points*/) const
  {
    return {};
  }
  /// For each boundary, the stress (MPa) at its points of the other sources less that of the vanishing ones. Local. Unless overridden, one
  /// by one.
  virtual std::vector<std::vector<dealii::SymmetricTensor<2, 3>>> complete_sum(
      std::span<const BoundaryPoints> boundaries) const;
  /// Appends, in ascending order, the sources that may have smooth lengths below `length` in a ball (nm), and perhaps others.
  virtual void append_near(const dealii::Point<3> & /*centre*/, double /*radius*/, double /*length*/,
                           std::vector<unsigned> & /*sources*/) const
  {
  }

protected:
  /// `values` += `sign` times the stress of some sources at points, in parallel.
  void add_in_parallel(std::span<const unsigned> sources, double sign, std::span<const dealii::Point<3>> points,
                       std::span<dealii::SymmetricTensor<2, 3>> values) const;
};

/// Integrals of t = sigma~ n over the whole closed boundary, n outward, summed over the ranks.
struct TractionSummary
{
  dealii::Tensor<1, 3> force;  ///< int t dA, MPa nm^2; zero for a divergence-free field
  dealii::Tensor<1, 3> moment; ///< int (x - c) x t dA about the grain's centre c, MPa nm^3
  /// Scale of `force`: sum over faces and their nodes of |int N t dA|, MPa nm^2. It does not depend on how the field is
  /// divided into sources. Equal to int |t| dA for degree 1 and a traction of one direction on each face; less where the
  /// traction changes its direction within an element.
  double absolute_force = 0.;
  double absolute_moment = 0.;     ///< scale of `moment`: the same sum weighted with |x - c| of the nodes, MPa nm^3
  std::uint64_t n_points = 0;      ///< quadrature points used
  std::uint64_t n_evaluations = 0; ///< pairs of source and quadrature point: the cost
  std::uint64_t n_unresolved = 0;  ///< pieces of faces at the limit of subdivision, not integrated to the tolerance
};
} // namespace ddfem::fem
