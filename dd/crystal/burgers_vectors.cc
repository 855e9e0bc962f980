#include "dd/crystal/burgers_vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace ddfem
{
namespace
{
/// Whether (n1 n2 n3) a/2 is a translation of a cubic lattice: fcc has those with an even sum of indices, bcc those
/// with indices that are all even or all odd.
bool is_translation(const Lattice lattice, const Miller &halves)
{
  if (lattice == Lattice::fcc)
    return (halves[0] + halves[1] + halves[2]) % 2 == 0;
  return (halves[0] - halves[1]) % 2 == 0 && (halves[0] - halves[2]) % 2 == 0;
}

BurgersType cubic_type(const Lattice lattice, const Miller &halves)
{
  Miller m = {std::abs(halves[0]), std::abs(halves[1]), std::abs(halves[2])};
  std::ranges::sort(m);
  if (lattice == Lattice::fcc && m == Miller{0, 1, 1})
    return BurgersType::half_110;
  if (lattice == Lattice::bcc && m == Miller{1, 1, 1})
    return BurgersType::half_111;
  if (m == Miller{0, 0, 2})
    return BurgersType::full_100;
  if (lattice == Lattice::bcc && m == Miller{0, 2, 2})
    return BurgersType::full_110;
  return BurgersType::other;
}

BurgersType hexagonal_type(const Miller &m)
{
  // |u a1 + v a2|^2 = u^2 + v^2 - u v is 1 for the six <a> only.
  const int basal = m[0] * m[0] + m[1] * m[1] - m[0] * m[1];
  const int height = std::abs(m[2]);
  if (basal == 1 && height == 0)
    return BurgersType::a;
  if (basal == 0 && height == 1)
    return BurgersType::c;
  if (basal == 1 && height == 1)
    return BurgersType::c_plus_a;
  return BurgersType::other;
}
} // namespace

const char *name_of(const BurgersType type)
{
  switch (type)
  {
    case BurgersType::half_110: return "a/2<110>";
    case BurgersType::half_111: return "a/2<111>";
    case BurgersType::full_100: return "a<100>";
    case BurgersType::full_110: return "a<110>";
    case BurgersType::a: return "1/3<11-20>";
    case BurgersType::c: return "<0001>";
    case BurgersType::c_plus_a: return "1/3<11-23>";
    case BurgersType::other: return "a longer lattice translation";
  }
  return "unknown";
}

double burgers_magnitude(const Lattice lattice, const double lattice_parameter)
{
  switch (lattice)
  {
    case Lattice::fcc: return lattice_parameter / std::sqrt(2.0);
    case Lattice::bcc: return lattice_parameter * std::sqrt(3.0) / 2;
    case Lattice::hcp: return lattice_parameter;
  }
  return lattice_parameter;
}

std::optional<BurgersType> burgers_type(const Lattice lattice, const double lattice_parameter,
                                        const Orientation &orientation, const Vec3 &burgers)
{
  const double unit = lattice == Lattice::hcp ? lattice_parameter : lattice_parameter / 2;
  const Vec3 coordinates = orientation.cell().coordinates(orientation.to_crystal(burgers)) / unit;
  constexpr double largest = 1e6; // far beyond any Burgers vector; keeps the rounding below within the range of int
  if (!(coordinates.cwiseAbs().maxCoeff() < largest) || burgers.isZero(0))
    return {};
  Miller m{};
  for (std::size_t d = 0; d < 3; ++d)
    m[d] = static_cast<int>(std::lround(coordinates[static_cast<Eigen::Index>(d)]));
  constexpr double tolerance = 1e-4;
  if ((coordinates - to_vector(m)).cwiseAbs().maxCoeff() * unit > tolerance * lattice_parameter || is_zero(m))
    return {};
  if (lattice == Lattice::hcp)
    return hexagonal_type(m);
  if (!is_translation(lattice, m))
    return {};
  return cubic_type(lattice, m);
}

Vec3 shortest_translation(const Lattice lattice, const double lattice_parameter, const Orientation &orientation,
                          const Miller &direction)
{
  const Miller m = reduced(direction);
  const bool half = lattice != Lattice::hcp && is_translation(lattice, m);
  const BurgersType type = lattice == Lattice::hcp ? hexagonal_type(m) : cubic_type(lattice, m);
  // One expression for the magnitude of the principal slip, so that it is the same number wherever it occurs.
  const bool principal = type == BurgersType::half_110 || type == BurgersType::half_111;
  const double length = principal ? burgers_magnitude(lattice, lattice_parameter)
                                  : lattice_parameter * orientation.cell().direction(m).norm() * (half ? 0.5 : 1.0);
  return length * orientation.direction(direction);
}
} // namespace ddfem
