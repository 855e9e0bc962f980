#include "dd/topology/cross_slip_law.h"

#include <cmath>

namespace ddfem
{
namespace
{
/// Unit vector e in the plane along which a shear traction on the side of the normal widens the stacking fault; zero where no partial
/// is found.
Vec3 widening_direction(const SlipSystems &systems, const Vec3 &burgers, const Vec3 &normal)
{
  const double b = burgers.norm();
  for (const SlipSystem &system : systems)
  {
    const double height = system.burgers.dot(normal);
    if (std::abs(height) < 1e-3 * b) // a vector of the plane itself
      continue;
    const Vec3 s = (height > 0 ? 1 : -1) * (system.burgers - height * normal);
    if (s.dot(burgers) > 1e-3 * b * b)
      return (2 * s - burgers).normalized();
  }
  return Vec3::Zero();
}
} // namespace

double CrossSlipLaw::rate(const double length, const ScrewStress &on_glide_plane,
                          const ScrewStress &on_cross_slip_plane) const
{
  const double energy = activation_energy - schmid_volume * on_cross_slip_plane.schmid -
                        escaig_volume * (on_cross_slip_plane.escaig - on_glide_plane.escaig);
  return attempt_rate * length / reference_length * std::exp(-energy / kT);
}

std::optional<CrossSlipLaw> kubin_law(const std::string_view material, const double burgers_magnitude, const double kT)
{
  if (material != "copper")
    return std::nullopt;
  constexpr double tau_iii = 32, per_second = 1e-9, micrometre = 1000; // MPa, 1/ns, nm
  const double volume = 300 * burgers_magnitude * burgers_magnitude * burgers_magnitude;
  return CrossSlipLaw{per_second, micrometre, tau_iii * volume, volume, 0, kT};
}

ScrewStress screw_stress(const SlipSystems &systems, const SymTensor &stress, const Vec3 &burgers, const Vec3 &normal)
{
  const Vec3 traction = contract(stress, normal);
  ScrewStress result{std::abs(traction.dot(burgers)) / burgers.norm(), 0};
  if (systems.lattice() == Lattice::fcc)
    result.escaig = traction.dot(widening_direction(systems, burgers, normal));
  return result;
}
} // namespace ddfem
