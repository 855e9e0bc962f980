// The mobility law of the input.
#pragma once

#include "coupling/parameters.h"

namespace ddfem::coupling
{
/// Sets the mobility law and the method for velocities of @p p, whose material and crystal have been read. Throws InputError for entries
/// that do not belong to the law or to the lattice.
void read_mobility(const InputDeck &deck, Parameters &p);
} // namespace ddfem::coupling
