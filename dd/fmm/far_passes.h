// The far field of the boxes of a tree: multipole expansions upward, translations across, local expansions downward.
#pragma once

#include "dd/fmm/moment_exchange.h"
#include "dd/fmm/octree.h"
#include "dd/fmm/stress_expansion.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

namespace ddfem::fmm
{
/// Of the expansions.
struct ExpansionOrders
{
  int multipole;
  /// That cubes at a distance of two edges need; lower than that of the expansions for other boxes.
  int of_cubes;
  /// How often the potentials are integrated over z, 0 or 3; then only P and Q are translated (half_line_translation.h). The
  /// degree of the local expansions is lower by this.
  int n_antiderivatives = 0;

  int local() const { return multipole - n_antiderivatives; }
};

/// The passes of the fast multipole method, in the precision of the expansions that the implementation keeps. All sums run in a
/// fixed order: the result does not depend on the number of threads, nor on which boxes are wanted.
class FarPasses
{
public:
  /// Adds to the coefficients of a box, in double precision.
  using AddToBox = std::function<void(const Box &, const ExpansionView &)>;

  virtual ~FarPasses() = default;
  FarPasses(const FarPasses &) = delete;
  FarPasses &operator=(const FarPasses &) = delete;

  /// Multipole coefficients of the boxes that are this rank's own in @p exchange, and that it needs of others. @p add_own_moments: of the
  /// sources that a box holds itself. Collective.
  virtual void upward(MomentExchange &exchange, const AddToBox &add_own_moments) = 0;
  /// Adds them to the local coefficients of distant boxes, for all boxes with wanted[box] != 0.
  virtual void translate(std::span<const std::uint8_t> wanted) = 0;
  /// Hands local coefficients down to the children. @p add_distant: of sources at infinity, at boxes of level @p distant_level.
  virtual void downward(std::span<const std::uint8_t> wanted, int distant_level, const AddToBox &add_distant) = 0;
  /// Copies the local coefficients of a box to zeroed rows; extrapolated by @p ahead times their change since the
  /// earlier ones, if there are any.
  virtual void copy_local(std::size_t box, double ahead, const ExpansionView &local) const = 0;
  /// Makes the local coefficients the earlier ones, and the other way round.
  virtual void swap_local() = 0;

protected:
  FarPasses() = default;
};

/// @p single_precision: of expansions and translations; not with antiderivatives.
std::unique_ptr<FarPasses> make_far_passes(const Octree &tree, const RootGrid &grid, const ExpansionOrders &orders,
                                           bool single_precision);
} // namespace ddfem::fmm
