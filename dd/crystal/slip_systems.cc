#include "dd/crystal/slip_systems.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace ddfem
{
namespace
{
constexpr double match_tolerance = 1e-4;

double burgers_length(Lattice lattice, double lattice_parameter)
{
  if (!(lattice_parameter > 0) || !std::isfinite(lattice_parameter))
    throw std::invalid_argument("The lattice parameter is " + std::to_string(lattice_parameter) +
                                " nm; it must be positive.");
  switch (lattice)
  {
    case Lattice::fcc: return lattice_parameter / std::sqrt(2.0);
    case Lattice::bcc: return lattice_parameter * std::sqrt(3.0) / 2;
    case Lattice::hcp: break;
  }
  throw std::invalid_argument("Slip systems are tabulated for fcc and bcc crystals, not for hcp.");
}

/// All {hkl} planes that share the absolute values of the indices of @p m, once each, in a fixed order.
std::vector<Miller> family(const Miller &m)
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
} // namespace

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

SlipSystems::SlipSystems(Lattice lattice, double lattice_parameter, const Orientation &orientation)
    : orientation_(orientation), burgers_magnitude_(burgers_length(lattice, lattice_parameter))
{
  if (lattice == Lattice::fcc)
    add_fcc();
  else
    add_bcc();
}

void SlipSystems::add(std::size_t plane, const Miller &direction, const std::string &schmid_boas)
{
  SlipSystem system;
  system.plane = plane;
  system.plane_miller = planes_[plane].miller;
  system.direction = direction;
  system.name = "(" + to_string(system.plane_miller) + ")[" + to_string(direction) + "]";
  system.schmid_boas = schmid_boas;
  system.normal = planes_[plane].normal;
  system.burgers = burgers_magnitude_ * orientation_.unit_vector(direction);
  systems_.push_back(std::move(system));
}

void SlipSystems::add_fcc()
{
  constexpr std::array<Miller, 4> planes = {{{-1, 1, 1}, {1, 1, 1}, {-1, -1, 1}, {1, -1, 1}}};
  constexpr std::array<Miller, 6> directions = {{{0, 1, 1}, {0, -1, 1}, {1, 0, 1}, {-1, 0, 1}, {-1, 1, 0}, {1, 1, 0}}};
  for (std::size_t p = 0; p < planes.size(); ++p)
  {
    const char letter = static_cast<char>('A' + p);
    planes_.push_back({planes[p], letter, orientation_.unit_vector(planes[p])});
    for (std::size_t d = 0; d < directions.size(); ++d)
      if (dot(planes[p], directions[d]) == 0)
        add(p, directions[d], letter + std::to_string(d + 1));
  }
}

void SlipSystems::add_bcc()
{
  for (const Miller &kind : {Miller{0, 1, 1}, Miller{1, 1, 2}})
    for (const Miller &plane : family(kind))
    {
      planes_.push_back({plane, 0, orientation_.unit_vector(plane)});
      for (const Miller &direction : family({1, 1, 1}))
        if (dot(plane, direction) == 0)
          add(planes_.size() - 1, direction, "");
    }
}

template <class IsPlane>
std::optional<SlipSystemMatch> SlipSystems::find_if(const Vec3 &burgers, IsPlane &&is_plane) const
{
  for (std::size_t s = 0; s < systems_.size(); ++s)
  {
    if (!is_plane(systems_[s]))
      continue;
    const double tolerance = match_tolerance * burgers_magnitude_;
    if ((burgers - systems_[s].burgers).norm() <= tolerance)
      return SlipSystemMatch{s, 1};
    if ((burgers + systems_[s].burgers).norm() <= tolerance)
      return SlipSystemMatch{s, -1};
  }
  return {};
}

std::optional<SlipSystemMatch> SlipSystems::find(const Vec3 &burgers, const Miller &plane) const
{
  const Miller wanted = without_sense(plane);
  return find_if(burgers, [&](const SlipSystem &s) { return without_sense(s.plane_miller) == wanted; });
}

std::optional<SlipSystemMatch> SlipSystems::find(const Vec3 &burgers, const Vec3 &normal) const
{
  return find_if(burgers, [&](const SlipSystem &s) { return s.normal.cross(normal).norm() <= match_tolerance; });
}

std::optional<std::size_t> SlipSystems::find(const std::string &name) const
{
  for (std::size_t s = 0; s < systems_.size(); ++s)
    if (!name.empty() && (systems_[s].name == name || systems_[s].schmid_boas == name))
      return s;
  return {};
}

std::vector<std::size_t> SlipSystems::glissile_planes(const Vec3 &burgers) const
{
  std::vector<std::size_t> found;
  for (std::size_t p = 0; p < planes_.size(); ++p)
    if (find_if(burgers, [&](const SlipSystem &s) { return s.plane == p; }))
      found.push_back(p);
  return found;
}

double SlipSystems::largest_schmid_factor(const Vec3 &axis) const
{
  double largest = 0;
  for (const SlipSystem &s : systems_)
    largest = std::max(largest, std::abs(s.schmid_factor(axis)));
  return largest;
}
} // namespace ddfem
