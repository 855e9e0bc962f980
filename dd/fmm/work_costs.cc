#include "dd/fmm/work_costs.h"

#include "dd/common/parallel.h"

namespace ddfem::fmm
{
namespace
{
/// Weight of an evaluation after the next one.
constexpr double memory = 0.8;
/// With the close pairs of the line that a point is on (measured on loops of 25 nm).
constexpr UnitCosts assumed_for_forces{1, 700, 1};
} // namespace

void WorkCosts::Sums::add(const Sums &other, const double weight)
{
  translations += weight * other.translations;
  seconds_of_translations += weight * other.seconds_of_translations;
  points_points += weight * other.points_points;
  points_pairs += weight * other.points_pairs;
  pairs_pairs += weight * other.pairs_pairs;
  seconds_points += weight * other.seconds_points;
  seconds_pairs += weight * other.seconds_pairs;
}

void WorkCosts::begin_evaluation(const double translations, const double seconds_of_translations)
{
  const Sums before = mine;
  mine = {};
  mine.add(before, memory);
  mine.translations += translations;
  mine.seconds_of_translations += seconds_of_translations;
}

void WorkCosts::add_leaf(const LeafWork &work, const double seconds)
{
  mine.add({0, 0, work.points * work.points, work.points * work.pairs, work.pairs * work.pairs, seconds * work.points,
            seconds * work.pairs},
           1);
}

UnitCosts WorkCosts::unit_costs(MPI_Comm comm) const
{
  Sums s;
  for (const Sums &of_rank : gather_one(mine, comm))
    s.add(of_rank, 1);
  if (s.seconds_points <= 0)
    return assumed_for_forces;
  UnitCosts fit{s.translations > 0 ? s.seconds_of_translations / s.translations : 0.0, 0, 0};
  const double determinant = s.points_points * s.pairs_pairs - s.points_pairs * s.points_pairs;
  if (determinant > 1e-6 * s.points_points * s.pairs_pairs)
  {
    fit.point = (s.seconds_points * s.pairs_pairs - s.seconds_pairs * s.points_pairs) / determinant;
    fit.pair = (s.seconds_pairs * s.points_points - s.seconds_points * s.points_pairs) / determinant;
  }
  // One kind alone, where two cannot be told apart.
  if (fit.pair <= 0)
    return {fit.translation, s.seconds_points / s.points_points, 0};
  if (fit.point < 0)
    return {fit.translation, 0, s.seconds_pairs / s.pairs_pairs};
  return fit;
}
} // namespace ddfem::fmm
