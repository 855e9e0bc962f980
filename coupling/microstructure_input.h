// The section Microstructure of the input, and the Miller indices in it and elsewhere.
#pragma once

#include "coupling/parameter_table.h"
#include "coupling/parameters.h"

#include <string>
#include <vector>

namespace ddfem::coupling
{
enum class IndicesOf
{
  plane,
  direction
};

/// Three indices, or for a hexagonal cell three or four (Miller-Bravais), which are turned into three. @p path: the entry that
/// InputError names if they are none.
Miller read_miller(const InputDeck &deck, const std::string &path, const std::string &text, IndicesOf what,
                   Lattice lattice);

/// The first three numbers of an entry.
inline Vec3 to_vec3(const std::vector<double> &v)
{
  return {v[0], v[1], v[2]};
}

/// Sources, loops and network file. Crystal and lattice must have been read. Throws InputError.
void read_microstructure(const InputDeck &deck, Parameters &p);
} // namespace ddfem::coupling
