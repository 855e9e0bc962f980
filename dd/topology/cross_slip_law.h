// When screw lines change their glide plane.
#pragma once

#include "dd/crystal/slip_systems.h"

#include <cstdint>
#include <optional>
#include <string_view>

namespace ddfem
{
enum class CrossSlipModel : std::uint8_t
{
  off,
  thermally_activated, ///< fcc: to the other {111} plane of the Burgers vector, at random with the rate of the law
  largest_stress,      ///< bcc: to the plane of the zone with the largest resolved shear stress, with hysteresis
};

/// Stresses on a screw line on one glide plane, MPa.
struct ScrewStress
{
  double schmid = 0; ///< magnitude of the shear stress on the plane along b, which moves the line
  double escaig =
      0; ///< shear stress on the plane across b that widens the stacking fault between the partials; negative: narrows it
};

/// Rate of thermally activated cross-slip of a screw of length L,
///
///   nu (L/L_0) exp(-[Q - V_S |tau_c| - V_E (sigma_c - sigma_g)] / kT)
///
/// with tau_c the Schmid stress on the cross-slip plane, sigma_c and sigma_g the Escaig stresses on the cross-slip and the glide plane.
/// With nu = beta/t_0, Q = tau_III V, V_S = V, V_E = 0 it is the law of Kubin, Canova, Condat, Devincre, Pontikis & Brechet, Solid State
/// Phenomena 23-24 (1992) 455: P = beta (L/L_0) (dt/t_0) exp((|tau| - tau_III) V/kT). With V_S = 0 the energy falls with the Escaig stresses, which narrow the
/// fault on the glide plane and widen it on the other (Escaig, J. Physique 29 (1968) 225; linear as measured in molecular dynamics by Oren,
/// Yahel & Makov, Comput. Mater. Sci. 138 (2017) 246).
struct CrossSlipLaw
{
  double attempt_rate = 0;      ///< nu, 1/ns
  double reference_length = 0;  ///< L_0, nm
  double activation_energy = 0; ///< Q, MPa nm^3
  double schmid_volume = 0;     ///< V_S, nm^3
  double escaig_volume = 0;     ///< V_E, nm^3
  double kT = 0;                ///< MPa nm^3

  /// 1/ns; @p length in nm.
  double rate(double length, const ScrewStress &on_glide_plane, const ScrewStress &on_cross_slip_plane) const;
};

/// The law of Kubin et al. (1992) with the numbers published for a material, or empty if this is not copper: tau_III = 32 MPa,
/// V = 300 b^3, one per second for 1 um at tau_III. That is Q = 1.00 eV; measured were 1.15 +- 0.37 eV and 280 b^3 (Bonneville,
/// Escaig & Martin, Acta Metall. 36 (1988) 1989), later 0.61 eV and 124 b^3 (Couteau, Kruml & Martin, Acta Mater. 59 (2011) 4207).
/// @p burgers_magnitude in nm, @p kT in MPa nm^3.
std::optional<CrossSlipLaw> kubin_law(std::string_view material, double burgers_magnitude, double kT);

/// The stresses that @p stress (MPa, sample frame) exerts on a screw line with this Burgers vector (nm) on the plane of this unit
/// normal. Without partials (other lattices than fcc) the Escaig stress is zero.
///
/// Sign in fcc: the line is moved along m = n x xi by a stress that shears the side of n along +b. Then the partial in front
/// carries the part s of b that takes the atoms of that side to fault positions: the one of the three shortest lattice
/// vectors v with v.n > 0, projected on the plane, that has s.b > 0. The partial behind carries b - s. They are pushed apart by
/// e.sigma.n with e = (2 s - b)/|2 s - b|. The result does not depend on the sense of n, of the line or of b.
ScrewStress screw_stress(const SlipSystems &systems, const SymTensor &stress, const Vec3 &burgers, const Vec3 &normal);
} // namespace ddfem
