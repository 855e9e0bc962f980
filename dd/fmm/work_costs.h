// What leaves of a tree cost, as measured.
#pragma once

#include "dd/common/stopwatch.h"

#include <mpi.h>

#include <cstddef>

namespace ddfem::fmm
{
/// Of the evaluation of a field at the points of a leaf, or of several.
struct LeafWork
{
  /// Into the leaf, and its part of those into the boxes around it, in units of `pairs` as assumed.
  double translations = 0;
  double points = 0;
  double pairs = 0; ///< evaluations of a source at a point
};

/// One unit of each kind of work, in any unit of time. At first as assumed, in evaluations of a source at a point.
struct UnitCosts
{
  double translation = 1, point = 100, pair = 1;

  double of(const LeafWork &work) const
  {
    return translation * work.translations + point * work.points + pair * work.pairs;
  }
};

/**
 * Costs by kind of work, fitted to the processor time that leaves have taken. Of the past, an evaluation counts less with every one that
 * follows: costs follow the network and the machine. They decide who computes a leaf, and no result.
 */
class WorkCosts
{
public:
  /// Leaves whose time is measured: every so many. The clock takes half a microsecond, which all of them would feel.
  static constexpr std::size_t stride_of_leaves = 8;

  /// Does @p work, which belongs to leaf number @p k of this rank, and adds its processor time to @p seconds if that leaf is measured.
  template <class Work> static void measure(const std::size_t k, double &seconds, Work &&work)
  {
    if (k % stride_of_leaves != 0)
      return work();
    const ThreadStopwatch watch(seconds);
    work();
  }

  /// Adds what this rank has measured in one evaluation: all of its translations at once, then some of its leaves, s.
  void begin_evaluation(double translations, double seconds_of_translations);
  void add_leaf(const LeafWork &work, double seconds);

  /// Collective: from what all ranks of @p comm have measured, the same bits on all of them. As assumed for forces as long as nothing has
  /// been measured.
  UnitCosts unit_costs(MPI_Comm comm) const;

private:
  /// Over leaves.
  struct Sums
  {
    double translations = 0, seconds_of_translations = 0;
    // Of the products in the normal equations of seconds = a points + b pairs.
    double points_points = 0, points_pairs = 0, pairs_pairs = 0, seconds_points = 0, seconds_pairs = 0;

    void add(const Sums &other, double weight);
  };

  Sums mine;
};
} // namespace ddfem::fmm
