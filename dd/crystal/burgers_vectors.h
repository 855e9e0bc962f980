// Which Burgers vectors a lattice has.
#pragma once

#include "dd/crystal/lattice.h"
#include "dd/crystal/orientation.h"

#include <optional>

namespace ddfem
{
/// Kinds of lattice translations that occur as Burgers vectors of lines and of the products of their reactions.
enum class BurgersType
{
  half_110, ///< fcc a/2<110>, the shortest
  half_111, ///< bcc a/2<111>, the shortest
  full_100, ///< a<100>: fcc product of a Hirth reaction, bcc product of two a/2<111>
  full_110, ///< bcc a<110>: product of two a/2<111> that repel, or of two a<100>
  a,        ///< hcp 1/3<11-20>, the shortest
  c,        ///< hcp <0001>
  c_plus_a, ///< hcp 1/3<11-23>
  other,    ///< a longer lattice translation
};
/// Such as "a/2<110>" or "1/3<11-20>".
const char *name_of(BurgersType type);

/// Length of the Burgers vector of the principal slip, nm: a/sqrt(2) fcc, a sqrt(3)/2 bcc, a hcp (hcp: that of <a>).
double burgers_magnitude(Lattice lattice, double lattice_parameter);

/// The type of @p burgers (nm, sample frame), or empty if it is not a translation of the lattice (a partial, or a
/// vector of another crystal). Compared to 1e-4 of the lattice parameter. The cell of @p orientation gives c/a.
std::optional<BurgersType> burgers_type(Lattice lattice, double lattice_parameter, const Orientation &orientation,
                                        const Vec3 &burgers);

/// The shortest lattice translation (nm, sample frame) along a lattice direction, sense kept: what a direction means as
/// a Burgers vector. Example: fcc [110] gives a/2[110], [100] gives a[100].
Vec3 shortest_translation(Lattice lattice, double lattice_parameter, const Orientation &orientation,
                          const Miller &direction);
} // namespace ddfem
