#pragma once

#include "fem/elastic_system.h"

#include <cstddef>
#include <deque>
#include <vector>

namespace ddfem::fem
{
/// The last few solutions (free unknowns) and what the next solve is to start from.
class StartVectors
{
public:
  /// `most`: how many solutions are kept, at least one.
  StartVectors(const ElasticSystem &system, std::size_t most);

  /// Vector to start from for a load: the combination of the kept solutions that minimises the energy x.Kx/2 - x.load
  /// (Fischer, CMAME 163 (1998) 193); zero without history. For a load that varies smoothly in time this is at least as
  /// good as the extrapolation by a polynomial through the kept solutions. Collective.
  NodalVector best(const NodalVector &load) const;

  /// Takes a solution in as the most recent one, with its product with the stiffness. An error of the products would grow by
  /// extrapolation from step to step; load minus residual is good enough if the residual was computed from the start vector. Collective.
  void remember(const NodalVector &solution, const NodalVector &product);

  /// Everything that is kept, and the same back: changes and their products by turns. Restoring is collective.
  std::vector<const NodalVector *> state() const;
  void restore(const std::vector<NodalVector> &state);

private:
  struct Change
  {
    NodalVector vector, product; // and the stiffness times it
  };

  void multiply_from(std::size_t first, std::size_t last);

  const ElasticSystem &system;
  std::size_t most;
  /// The latest solution, and then of each earlier one the difference from its successor. With these instead of the solutions themselves, which
  /// are nearly equal, the products below keep the digits that tell them apart.
  std::deque<Change> changes;
  std::vector<std::vector<double>> products; // of each two of them, in energy
};
} // namespace ddfem::fem
