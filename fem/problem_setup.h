// What ElasticProblem works out before it can assemble.
#pragma once

#include "fem/elastic_problem.h"
#include "fem/nodal_grid.h"

#include <array>
#include <utility>
#include <vector>

namespace ddfem::fem
{
/// Throws std::invalid_argument for values without sense.
void check(const ElasticProblem::Parameters &parameters);
void check(const Moduli &moduli);

/// First Lame constant, MPa.
double lame_lambda(const Moduli &moduli);

/// Volume (nm^3) and its centre (nm). Collective.
std::pair<double, dealii::Point<3>> volume_and_centre(const NodalGrid &grid);

/// Which condition prescribes each component of each local node: the first that does, or -1.
std::vector<std::array<int, 3>> assign_conditions(const NodalGrid &grid,
                                                  const std::vector<DisplacementCondition> &conditions);

/// Which components of each node some condition prescribes.
std::vector<std::array<bool, 3>> flags_of(const std::vector<std::array<int, 3>> &owner);
} // namespace ddfem::fem
