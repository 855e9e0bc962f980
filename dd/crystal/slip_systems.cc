#include "dd/crystal/slip_systems.h"

#include "dd/crystal/miller_bravais.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace ddfem
{
namespace
{
constexpr double match_tolerance = 1e-4;

void check(const Lattice lattice, const double lattice_parameter, const Orientation &orientation,
           const SlipSystemOptions &options)
{
  if (!(lattice_parameter > 0) || !std::isfinite(lattice_parameter))
    throw std::invalid_argument("The lattice parameter is " + std::to_string(lattice_parameter) +
                                " nm; it must be positive.");
  if ((lattice == Lattice::hcp) == orientation.cell().is_cubic())
    throw std::invalid_argument(std::string("The orientation given to this ") + name_of(lattice) + " crystal needs a " +
                                (lattice == Lattice::hcp ? "hexagonal" : "cubic") + " unit cell.");
  if (options.bcc_123_planes && lattice != Lattice::bcc)
    throw std::invalid_argument("Slip on {123} planes is known of bcc crystals only.");
}

/// All {hkl} planes that share the absolute values of the indices of @p m, once each, in a fixed order.
std::vector<Miller> cubic_family(const Miller &m)
{
  std::vector<Miller> members;
  Miller sorted = m;
  std::ranges::sort(sorted);
  do
    for (int signs = 0; signs < 8; ++signs)
    {
      Miller member = sorted;
      for (std::size_t d = 0; d < 3; ++d)
        if ((signs >> d & 1) != 0)
          member[d] = -member[d];
      member = without_sense(member);
      if (std::ranges::find(members, member) == members.end())
        members.push_back(member);
    }
  while (std::ranges::next_permutation(sorted).found);
  return members;
}

/// All planes or directions that share the four indices @p m up to order and sign of the first three together and the
/// sign of the last: its orbit under the point group 6/mmm, once each, in a fixed order. @p convert: to three indices.
template <class Convert> std::vector<Miller> hexagonal_family(const MillerBravais &m, const Convert &convert)
{
  std::vector<Miller> members;
  std::array<int, 3> basal = {m[0], m[1], m[2]};
  std::ranges::sort(basal);
  do
    for (const int sign : {1, -1})
    {
      const Miller member = without_sense(convert({sign * basal[0], sign * basal[1], sign * basal[2], m[3]}));
      if (std::ranges::find(members, member) == members.end())
        members.push_back(member);
    }
  while (std::ranges::next_permutation(basal).found);
  return members;
}
} // namespace

const char *name_of(const SlipFamily family)
{
  switch (family)
  {
    case SlipFamily::fcc_111: return "{111}<110>";
    case SlipFamily::bcc_110: return "{110}<111>";
    case SlipFamily::bcc_112: return "{112}<111>";
    case SlipFamily::bcc_123: return "{123}<111>";
    case SlipFamily::bcc_110_100: return "{110}<100>";
    case SlipFamily::prismatic: return "prismatic <a>";
    case SlipFamily::basal: return "basal <a>";
    case SlipFamily::pyramidal_a: return "first-order pyramidal <a>";
    case SlipFamily::pyramidal_ca: return "first-order pyramidal <c+a>";
    case SlipFamily::pyramidal2_ca: return "second-order pyramidal <c+a>";
  }
  return "unknown";
}

SymTensor SlipSystem::schmid_tensor() const
{
  return symmetric_part(burgers.normalized() * normal.transpose());
}

double SlipSystem::resolved_shear_stress(const SymTensor &stress) const
{
  return burgers.normalized().dot(contract(stress, normal));
}

double SlipSystem::schmid_factor(const Vec3 &axis) const
{
  const Vec3 t = axis.normalized();
  return normal.dot(t) * burgers.normalized().dot(t);
}

SlipSystems::SlipSystems(const Lattice lattice, const double lattice_parameter, const Orientation &orientation,
                         const SlipSystemOptions &options)
    : lattice_(lattice), lattice_parameter_(lattice_parameter), orientation_(orientation),
      burgers_magnitude_(ddfem::burgers_magnitude(lattice, lattice_parameter))
{
  check(lattice, lattice_parameter, orientation, options);
  switch (lattice)
  {
    case Lattice::fcc: add_fcc(); break;
    case Lattice::bcc: add_bcc(options); break;
    case Lattice::hcp: add_hcp(); break;
  }
}

std::size_t SlipSystems::add_plane(const Miller &plane, const char schmid_boas)
{
  planes_.push_back({plane, schmid_boas, orientation_.plane_normal(plane)});
  return planes_.size() - 1;
}

SlipSystem SlipSystems::make(const SlipFamily family, const std::size_t plane, const Miller &direction,
                             const std::string &schmid_boas) const
{
  const UnitCell &cell = orientation_.cell();
  SlipSystem system;
  system.family = family;
  system.plane = plane;
  system.plane_miller = planes_[plane].miller;
  system.direction = direction;
  system.name = cell.plane_name(system.plane_miller) + cell.direction_name(direction);
  system.schmid_boas = schmid_boas;
  system.normal = planes_[plane].normal;
  system.burgers = shortest_translation(lattice_, lattice_parameter_, orientation_, direction);
  return system;
}

void SlipSystems::add_fcc()
{
  constexpr std::array<Miller, 4> planes = {{{-1, 1, 1}, {1, 1, 1}, {-1, -1, 1}, {1, -1, 1}}};
  constexpr std::array<Miller, 6> directions = {{{0, 1, 1}, {0, -1, 1}, {1, 0, 1}, {-1, 0, 1}, {-1, 1, 0}, {1, 1, 0}}};
  for (std::size_t p = 0; p < planes.size(); ++p)
  {
    const char letter = static_cast<char>('A' + p);
    const std::size_t plane = add_plane(planes[p], letter);
    for (std::size_t d = 0; d < directions.size(); ++d)
      if (dot(planes[p], directions[d]) == 0)
        systems_.push_back(make(SlipFamily::fcc_111, plane, directions[d], letter + std::to_string(d + 1)));
  }
}

void SlipSystems::add_bcc(const SlipSystemOptions &options)
{
  struct Kind
  {
    Miller plane;
    SlipFamily slip;
  };
  std::vector<Kind> kinds = {{{0, 1, 1}, SlipFamily::bcc_110}, {{1, 1, 2}, SlipFamily::bcc_112}};
  if (options.bcc_123_planes)
    kinds.push_back({{1, 2, 3}, SlipFamily::bcc_123});
  for (const Kind &kind : kinds)
    for (const Miller &miller : cubic_family(kind.plane))
    {
      const std::size_t plane = add_plane(miller);
      for (const Miller &direction : cubic_family({1, 1, 1}))
        if (dot(miller, direction) == 0)
          systems_.push_back(make(kind.slip, plane, direction, ""));
      if (kind.slip != SlipFamily::bcc_110)
        continue;
      for (const Miller &direction : cubic_family({0, 0, 1}))
        if (dot(miller, direction) == 0)
          product_systems_.push_back(make(SlipFamily::bcc_110_100, plane, direction, ""));
    }
}

void SlipSystems::add_hcp()
{
  const std::vector<Miller> a = hexagonal_family({1, 1, -2, 0}, direction_from_four_indices),
                            ca = hexagonal_family({1, 1, -2, 3}, direction_from_four_indices);
  const auto add = [&](const SlipFamily family, const std::size_t plane, const std::vector<Miller> &directions)
  {
    for (const Miller &direction : directions)
      if (dot(planes_[plane].miller, direction) == 0)
        systems_.push_back(make(family, plane, direction, ""));
  };
  const auto planes = [&](const MillerBravais &kind)
  {
    std::vector<std::size_t> indices;
    for (const Miller &miller : hexagonal_family(kind, plane_from_four_indices))
      indices.push_back(add_plane(miller));
    return indices;
  };
  for (const std::size_t p : planes({1, 0, -1, 0}))
    add(SlipFamily::prismatic, p, a);
  for (const std::size_t p : planes({0, 0, 0, 1}))
    add(SlipFamily::basal, p, a);
  const std::vector<std::size_t> first_order = planes({1, 0, -1, 1});
  for (const std::size_t p : first_order)
    add(SlipFamily::pyramidal_a, p, a);
  for (const std::size_t p : first_order)
    add(SlipFamily::pyramidal_ca, p, ca);
  for (const std::size_t p : planes({1, 1, -2, 2}))
    add(SlipFamily::pyramidal2_ca, p, ca);
}

template <class IsPlane>
std::optional<SlipSystemMatch> SlipSystems::find_if(const std::vector<SlipSystem> &systems, const Vec3 &burgers,
                                                    IsPlane &&is_plane) const
{
  for (std::size_t s = 0; s < systems.size(); ++s)
  {
    if (!is_plane(systems[s]))
      continue;
    const double tolerance = match_tolerance * burgers_magnitude_;
    if ((burgers - systems[s].burgers).norm() <= tolerance)
      return SlipSystemMatch{s, 1};
    if ((burgers + systems[s].burgers).norm() <= tolerance)
      return SlipSystemMatch{s, -1};
  }
  return {};
}

std::optional<SlipSystemMatch> SlipSystems::find(const Vec3 &burgers, const Miller &plane) const
{
  const Miller wanted = without_sense(plane);
  return find_if(systems_, burgers, [&](const SlipSystem &s) { return without_sense(s.plane_miller) == wanted; });
}

std::optional<SlipSystemMatch> SlipSystems::find(const Vec3 &burgers, const Vec3 &normal) const
{
  return find_if(systems_, burgers,
                 [&](const SlipSystem &s) { return s.normal.cross(normal).norm() <= match_tolerance; });
}

std::optional<std::size_t> SlipSystems::find(const std::string &name) const
{
  for (std::size_t s = 0; s < systems_.size(); ++s)
    if (!name.empty() && (systems_[s].name == name || systems_[s].schmid_boas == name))
      return s;
  return {};
}

std::optional<SlipFamily> SlipSystems::family(const Vec3 &burgers, const std::size_t plane) const
{
  for (const auto *systems : {&systems_, &product_systems_})
    if (const auto match = find_if(*systems, burgers, [&](const SlipSystem &s) { return s.plane == plane; }))
      return (*systems)[match->system].family;
  return {};
}

std::vector<std::size_t> SlipSystems::glissile_planes(const Vec3 &burgers) const
{
  std::vector<std::size_t> found;
  for (std::size_t p = 0; p < planes_.size(); ++p)
    if (family(burgers, p))
      found.push_back(p);
  return found;
}

std::optional<BurgersType> SlipSystems::burgers_type(const Vec3 &burgers) const
{
  return ddfem::burgers_type(lattice_, lattice_parameter_, orientation_, burgers);
}

std::string SlipSystems::glissile_types() const
{
  switch (lattice_)
  {
    case Lattice::fcc: return name_of(BurgersType::half_110);
    case Lattice::bcc: return std::string(name_of(BurgersType::half_111)) + ", " + name_of(BurgersType::full_100);
    case Lattice::hcp: return std::string(name_of(BurgersType::a)) + ", " + name_of(BurgersType::c_plus_a);
  }
  return "";
}

double SlipSystems::largest_schmid_factor(const Vec3 &axis) const
{
  double largest = 0;
  for (const SlipSystem &s : systems_)
    largest = std::max(largest, std::abs(s.schmid_factor(axis)));
  return largest;
}
} // namespace ddfem
