// Four-index (Miller-Bravais) notation of hexagonal crystals.
#pragma once

#include "dd/crystal/miller.h"

#include <array>
#include <string>

namespace ddfem
{
/// (h k i l) with i = -(h+k), or [u v t w] with t = -(u+v). Used in input and names only; inside, a plane is (h k l)
/// and a direction [U V W] on the axes a1, a2, c.
using MillerBravais = std::array<int, 4>;

/// Dropping i leaves (h k l). Throws std::invalid_argument if h + k + i is not zero.
Miller plane_from_four_indices(const MillerBravais &hkil);
/// [U V W] = [u-t, v-t, w], reduced. Throws std::invalid_argument if u + v + t is not zero.
/// Source: Frank, On Miller-Bravais indices and four-dimensional vectors, Acta Cryst. 18 (1965) 862.
Miller direction_from_four_indices(const MillerBravais &uvtw);

MillerBravais to_four_index_plane(const Miller &hkl);
/// The smallest integers u = (2U-V)/3, v = (2V-U)/3, t = -(u+v), w = W times a common factor, sense kept.
MillerBravais to_four_index_direction(const Miller &uvw);

/// "10-11" with single digits, "10 -1 -9 2" otherwise.
std::string to_string(const MillerBravais &m);
} // namespace ddfem
