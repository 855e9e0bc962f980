#include "coupling/thermal_input.h"

#include "dd/common/units.h"
#include "dd/mobility/thermal_force.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace ddfem::coupling
{
namespace
{
/// The law from the input, or the published one of the named material if the input gives no number of it.
CrossSlipLaw read_law(const InputDeck &deck, const Parameters &p)
{
  const std::string s = "Cross-slip/";
  const std::array<const char *, 4> numbers{"Attempt rate", "Activation energy", "Schmid volume", "Escaig volume"};
  const double kT = boltzmann_constant * p.thermal.temperature;
  if (std::ranges::none_of(numbers, [&](const char *name) { return deck.is_set(s + name); }))
  {
    if (const auto law = kubin_law(deck.text("Material/Name"), p.burgers_magnitude, kT))
      return *law;
    deck.reject(s + "Model",
                "no published law is built in for " + deck.text("Material/Name") +
                    " (only for copper): give Attempt rate, Activation energy, Schmid volume, Escaig volume");
  }
  CrossSlipLaw law;
  law.attempt_rate = deck.number(s + "Attempt rate") * units::per_second;
  law.reference_length = deck.number(s + "Reference length") * units::metre;
  law.activation_energy = deck.number(s + "Activation energy") * units::joule;
  const double cubic_metre = units::metre * units::metre * units::metre;
  law.schmid_volume = deck.number(s + "Schmid volume") * cubic_metre;
  law.escaig_volume = deck.number(s + "Escaig volume") * cubic_metre;
  law.kT = kT;
  for (const char *name : {"Attempt rate", "Activation energy"})
    if (!(deck.number(s + name) > 0))
      deck.reject(s + name, "must be positive once a number of the law is given");
  return law;
}

void read_cross_slip(const InputDeck &deck, Parameters &p)
{
  const std::string path = "Cross-slip/Model", model = deck.text(path);
  p.cross_slip.model = model == "thermally activated" ? CrossSlipModel::thermally_activated
                       : model == "largest stress"    ? CrossSlipModel::largest_stress
                                                      : CrossSlipModel::off;
  p.cross_slip.screw_angle = deck.number("Cross-slip/Screw angle") * std::numbers::pi / 180;
  p.cross_slip.stress_ratio = deck.number("Cross-slip/Stress ratio");
  p.cross_slip.hysteresis = deck.number("Cross-slip/Hysteresis");
  if (p.cross_slip.model == CrossSlipModel::thermally_activated)
  {
    if (p.lattice != Lattice::fcc)
      deck.reject(path, std::string("allowed in fcc crystals; this one is ") + name_of(p.lattice));
    p.cross_slip.law = read_law(deck, p);
  }
  if (p.cross_slip.model == CrossSlipModel::largest_stress && p.lattice != Lattice::bcc)
    deck.reject(path, std::string("allowed in bcc crystals; this one is ") + name_of(p.lattice));
}
} // namespace

void read_thermal(const InputDeck &deck, Parameters &p)
{
  p.thermal.seed = deck.integer("Random seed");
  p.thermal.temperature = deck.number("Mobility/Temperature");
  p.thermal.motion = deck.flag("Mobility/Thermal motion");
  if (p.thermal.motion && !p.mobility->is_linear())
    deck.reject("Mobility/Thermal motion",
                "needs a force proportional to the velocity: law linear or relaxation, without "
                "friction stress and largest speed");
  read_cross_slip(deck, p);
}
} // namespace ddfem::coupling
