// The slip family of a line.
#pragma once

#include "dd/crystal/slip_systems.h"
#include "dd/mobility/mobility_law.h"

#include <optional>

namespace ddfem
{
/// The family of the slip system of a line, by its Burgers vector and glide plane; empty where the crystal has none, or the line no plane.
std::optional<SlipFamily> slip_family(const SlipSystems &systems, const LineState &line);
} // namespace ddfem
