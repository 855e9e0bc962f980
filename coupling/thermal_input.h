// The part of the input that belongs to temperature: heat bath and cross-slip.
#pragma once

#include "coupling/parameters.h"

namespace ddfem::coupling
{
/// Reads temperature, thermal motion, cross-slip and the seed of the random numbers. Throws InputError. Needs the lattice, the Burgers
/// vector and the mode in @p parameters.
void read_thermal(const InputDeck &deck, Parameters &parameters);
} // namespace ddfem::coupling
