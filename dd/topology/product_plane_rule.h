// Where the products of reactions glide in a given crystal.
#pragma once

#include "dd/crystal/slip_systems.h"
#include "dd/topology/topology_context.h"

namespace ddfem
{
/// The rule of dd/crystal/product_plane.h as the topological operations need it.
ProductPlane product_plane_rule(const SlipSystems &systems);
} // namespace ddfem
