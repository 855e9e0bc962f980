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

  /// What to do with local coefficients.
  struct Descent
  {
    std::span<const std::uint8_t> wanted; ///< boxes with wanted[box] != 0, and their parents
    int distant_level;                    ///< of the boxes to which sources at infinity are added
    AddToBox add_distant;
    /// Called once for every wanted leaf, from several threads. If empty, the coefficients of all wanted boxes are kept.
    AddToBox use_in_leaf;
  };
  /// Processor time summed over threads, s.
  struct DescentTimes
  {
    double translations = 0, downward = 0, leaves = 0;

    DescentTimes &operator+=(const DescentTimes &t)
    {
      translations += t.translations;
      downward += t.downward;
      leaves += t.leaves;
      return *this;
    }
  };

  /// Multipole coefficients of the boxes that are this rank's own in @p exchange, and that it needs of others. @p add_own_moments: of the
  /// sources that a box holds itself. Collective.
  virtual void upward(MomentExchange &exchange, const AddToBox &add_own_moments) = 0;
  /// From the root down, adds multipole coefficients to the local ones of distant boxes, and hands these down to the children.
  /// Gives up multipole coefficients, and local ones that are not kept, as soon as nothing needs them.
  virtual DescentTimes downward(const Descent &descent) = 0;
  /// Whether the last descent has kept local coefficients.
  virtual bool has_local() const = 0;
  /// Copies kept local coefficients of a box to zeroed rows; extrapolated by @p ahead times their change since the
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
