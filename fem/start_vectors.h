#pragma once

#include "fem/elastic_system.h"

#include <cstddef>
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

  /// Takes a solution in as the most recent one. Collective.
  void remember(const NodalVector &solution);

  void clear() { starts.clear(); }

  /// The vectors, the most recent first.
  std::vector<const NodalVector *> vectors() const;

private:
  struct Start
  {
    NodalVector vector, product; // and the stiffness times it
  };

  const ElasticSystem &system;
  std::size_t most;
  std::vector<Start> starts; // most recent first
};
} // namespace ddfem::fem
