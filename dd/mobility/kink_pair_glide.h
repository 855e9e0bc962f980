// Glide of bcc lines: screws by thermally activated kink pairs.
#pragma once

#include "dd/mobility/glide_friction.h"
#include "dd/mobility/slip_family.h"

namespace ddfem
{
/// Parameters of the kink-pair law.
struct KinkPairParameters
{
  double temperature = 300;           ///< T, K
  double edge_drag = 0;               ///< B_e, MPa ns
  double screw_drag = 0;              ///< B_s of screws without a barrier, MPa ns
  double kink_drag = 0;               ///< B_k, MPa ns
  double enthalpy = 0;                ///< dH_0 of a kink pair, eV
  double peierls_stress = 0;          ///< tau_P, MPa
  double p = 1, q = 1;                ///< exponents of the barrier, 0 < p <= 1 <= q <= 2
  double athermal_temperature = 0;    ///< T_0 at which the barrier vanishes, K
  static constexpr double width = 25; ///< w of a kink, in Burgers vectors
};

/// Tungsten at @p temperature (K): Po et al. 2016, numbers as tabulated in MoDELib2 (W.txt); B_e = 4.26e-4 Pa s + 0.87e-6 Pa s/K T, T_0 = 0.8 x 3695 K.
KinkPairParameters tungsten_kink_pairs(double temperature);

/// Mobility of bcc lines of Po, Cui, Rivera, Cereceda, Swinburne, Marian & Ghoniem, Acta Mater. 119 (2016) 123, section 3, as far as the force per length
/// f = tau b determines it (without the terms of stress components other than the resolved shear stress):
///
///   v = cos^2(theta) v_s + sin^2(theta) f/B_e,      v_s = f/B exp(-dH_0 g/(2 k T)),
///   g = max(0, (1 - (tau/tau_P)^p)^q - T/T_0),      B = B_k w/(2h) + s (B_s - B_k w/(2h)),  h = (2 sqrt(2)/3) b,
///
/// s = 1/(1 + exp((g - 0.05)/0.05)) leads from motion by kinks to viscous motion. The resistance is the inverse function f(v). a<100> products move like edges.
/// Lines without a slip system of the crystal are sessile.
class KinkPairGlide : public MobilityLaw
{
public:
  /// Throws std::invalid_argument if the crystal is not bcc, a parameter is outside its range, or the speed would not grow with the force.
  KinkPairGlide(SlipSystems slip_systems, const KinkPairParameters &kink_pair_parameters);

  ArmConstraint constraint(const LineState &line) const override;
  Resistance resistance(const LineState &line, const Vec3 &velocity) const override;
  double drag(const LineState &line) const override;

  /// Speed, nm/ns, of a line of this squared cosine of its character and Burgers vector @p b (nm) under @p force per length, MPa nm; not negative.
  double speed(double squared_cosine, double b, double force) const;

private:
  double screw_speed(double b, double force) const;
  double effective_cosine(const LineState &line) const;
  Friction friction(double squared_cosine, double b, double speed) const;

  SlipSystems systems;
  KinkPairParameters k;
};
} // namespace ddfem
