#include "dd/mobility/kink_pair_glide.h"

#include "dd/common/units.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace ddfem
{
namespace
{
constexpr double boltzmann = 8.617333262e-5;                // eV/K (CODATA 2018)
constexpr double kink_height = 2 * std::numbers::sqrt2 / 3; // h in Burgers vectors: the spacing of the Peierls valleys

double by_kinks(const KinkPairParameters &k)
{
  return k.kink_drag * KinkPairParameters::width / (2 * kink_height);
}

double largest_drag(const KinkPairParameters &k)
{
  return std::max({k.edge_drag, k.screw_drag, by_kinks(k)});
}

void require(const bool holds, const std::string &what)
{
  if (!holds)
    throw std::invalid_argument("kink-pair mobility: " + what);
}
} // namespace

KinkPairParameters tungsten_kink_pairs(const double temperature)
{
  KinkPairParameters k;
  k.temperature = temperature;
  k.edge_drag = (4.26e-4 + 0.87e-6 * temperature) * units::pascal_second;
  k.screw_drag = 9.8e-4 * units::pascal_second;
  k.kink_drag = 8.3e-5 * units::pascal_second;
  k.enthalpy = 1.63;
  k.peierls_stress = 2030;
  k.p = 0.86;
  k.q = 1.69;
  k.athermal_temperature = 0.8 * 3695;
  return k;
}

KinkPairGlide::KinkPairGlide(SlipSystems slip_systems, const KinkPairParameters &kink_pair_parameters)
    : systems(std::move(slip_systems)), k(kink_pair_parameters)
{
  require(systems.lattice() == Lattice::bcc, "allowed are bcc crystals");
  require(k.temperature > 0 && k.athermal_temperature > 0, "temperatures must be positive");
  require(k.edge_drag > 0 && k.screw_drag > 0 && k.kink_drag > 0, "drag coefficients must be positive");
  require(k.enthalpy > 0 && k.peierls_stress > 0, "enthalpy and Peierls stress must be positive");
  require(k.p > 0 && k.p <= 1 && k.q >= 1 && k.q <= 2, "the exponents must be 0 < p <= 1 and 1 <= q <= 2");
  const double b = systems.burgers_magnitude();
  constexpr int samples = 1000;
  for (int n = 1; n <= samples; ++n)
    require(screw_speed(b, 1.5 * k.peierls_stress * b * n / samples) >
                screw_speed(b, 1.5 * k.peierls_stress * b * (n - 1) / samples),
            "the speed of screws does not grow with the stress; the screw drag is too large for the kink drag");
}

double KinkPairGlide::screw_speed(const double b, const double force) const
{
  const double ratio = std::min(1.0, force / (k.peierls_stress * b));
  const double barrier =
      std::max(0.0, std::pow(1 - std::pow(ratio, k.p), k.q) - k.temperature / k.athermal_temperature);
  constexpr double transition = 0.05;
  const double viscous = 1 / (1 + std::exp((barrier - transition) / transition));
  const double drag = by_kinks(k) + viscous * (k.screw_drag - by_kinks(k));
  return force / drag * std::exp(-k.enthalpy * barrier / (2 * boltzmann * k.temperature));
}

double KinkPairGlide::speed(const double squared_cosine, const double b, const double force) const
{
  return squared_cosine * screw_speed(b, force) + (1 - squared_cosine) * force / k.edge_drag;
}

Friction KinkPairGlide::friction(const double squared_cosine, const double b, const double wanted) const
{
  // Force for which speed() is wanted, by the secant rule inside a bracket (Illinois); then its slope by a difference.
  double low = 0, high = std::max(k.peierls_stress * b, wanted * largest_drag(k));
  double at_low = -wanted, at_high = speed(squared_cosine, b, high) - wanted, force = 0;
  int side = 0;
  for (int n = 0; n < 200 && wanted > 0 && high - low > 1e-14 * high; ++n)
  {
    force = n % 3 == 2 ? 0.5 * (low + high) : (low * at_high - high * at_low) / (at_high - at_low);
    const double rest = speed(squared_cosine, b, force) - wanted;
    if (std::abs(rest) < 1e-13 * wanted)
      break;
    if (rest < 0)
    {
      low = force;
      at_low = rest;
      at_high *= side == -1 ? 0.5 : 1;
      side = -1;
    }
    else
    {
      high = force;
      at_high = rest;
      at_low *= side == 1 ? 0.5 : 1;
      side = 1;
    }
  }
  const double step = 1e-6 * std::max(force, 1e-3 * k.peierls_stress * b), below = std::max(0.0, force - step);
  const double growth =
      (speed(squared_cosine, b, force + step) - speed(squared_cosine, b, below)) / (force + step - below);
  return {force, 1 / growth};
}

double KinkPairGlide::effective_cosine(const LineState &line) const
{
  const auto family = slip_family(systems, line);
  return family == SlipFamily::bcc_110_100 ? 0.0 : line.squared_cosine();
}

ArmConstraint KinkPairGlide::constraint(const LineState &line) const
{
  return {slip_family(systems, line) ? line.normal : Vec3(Vec3::Zero()), line.direction};
}

Resistance KinkPairGlide::resistance(const LineState &line, const Vec3 &velocity) const
{
  const double cosine = effective_cosine(line), b = line.burgers.norm();
  return resistance_across(line, velocity, [&](const double v) { return friction(cosine, b, v); });
}

double KinkPairGlide::drag(const LineState &line) const
{
  const double cosine = effective_cosine(line);
  // d ln(v_s)/d ln(f) = 1 + dH_0/(2kT) p q x (1-x)^(q-1) with x = (tau/tau_P)^p, largest at x = 1/q.
  const double steepest = 1 + k.enthalpy * k.p / (2 * boltzmann * k.temperature) * std::pow(1 - 1 / k.q, k.q - 1);
  return 1 / (cosine * steepest / std::min(k.screw_drag, by_kinks(k)) + (1 - cosine) / k.edge_drag);
}
} // namespace ddfem
