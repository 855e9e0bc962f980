// On which plane the product of a reaction glides.
#pragma once

#include "dd/crystal/slip_systems.h"

#include <cstddef>
#include <optional>
#include <span>

namespace ddfem
{
/// Index into systems.planes() of the glide plane of a line of unit direction @p xi and Burgers vector @p burgers (nm;
/// both sample frame), or empty if the line is sessile.
///
/// The line glides on the plane that holds xi and b (xi to 1e-4 rad) if that is a slip plane of the lattice for this
/// kind of Burgers vector. A screw lies in several: it takes the first of @p parents (planes of the lines that reacted)
/// that is among them, otherwise the first in the order of systems.planes(): {111} in the order A B C D; {110} before
/// {112} before {123}; prismatic (the principal slip of zirconium and titanium) before basal before first-order before
/// second-order pyramidal.
///
/// Examples: fcc Lomer lock, a/2<110> along <110> in {100}: sessile; fcc a<100> (Hirth): sessile.
/// Source: Hirth & Lothe, Theory of Dislocations, 2nd ed. 1982, ch. 22 (intersections and barriers).
std::optional<std::size_t> product_plane(const SlipSystems &systems, const Vec3 &xi, const Vec3 &burgers,
                                         std::span<const std::size_t> parents = {});
} // namespace ddfem
