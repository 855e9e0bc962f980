#include "coupling/mobility_input.h"

#include "coupling/input_error.h"
#include "dd/common/units.h"
#include "dd/crystal/material.h"
#include "dd/mobility/climb.h"
#include "dd/mobility/family_glide.h"
#include "dd/mobility/friction_glide.h"
#include "dd/mobility/kink_pair_glide.h"

#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace ddfem::coupling
{
namespace
{
/// The number in the deck, or @p fallback where it is zero.
double number_or(const InputDeck &deck, const std::string &entry, const double unit, const double fallback)
{
  const double value = deck.number("Mobility/" + entry);
  return value > 0 ? value * unit : fallback;
}

CharacterDrag read_drag(const InputDeck &deck)
{
  const double of_material = find_material(deck.text("Material/Name")).drag;
  return {number_or(deck, "Edge drag", units::pascal_second, of_material),
          number_or(deck, "Screw drag", units::pascal_second, of_material)};
}

/// The families of a crystal, products included, in the order of its slip systems.
std::vector<SlipFamily> families_of(const SlipSystems &systems)
{
  std::vector<SlipFamily> families;
  const auto add = [&](const SlipSystem &s)
  {
    if (families.empty() || families.back() != s.family)
      families.push_back(s.family);
  };
  for (const SlipSystem &s : systems)
    add(s);
  for (const SlipSystem &s : systems.product_systems())
    add(s);
  return families;
}

/// Applies one item of Mobility/Family drags.
void set_family(const InputDeck &deck, const std::string &item, const std::vector<SlipFamily> &families,
                std::map<SlipFamily, CharacterDrag> &drags)
{
  const std::string path = "Mobility/Family drags";
  const auto colon = item.find(':');
  const std::string name = item.substr(0, colon), rest = colon == std::string::npos ? "" : item.substr(colon + 1);
  std::string known;
  for (const SlipFamily f : families)
  {
    known += (known.empty() ? "" : ", ") + std::string(name_of(f));
    if (name != name_of(f))
      continue;
    std::istringstream in(rest);
    std::string word;
    if (in >> word && word == "sessile" && !(in >> word))
    {
      drags.erase(f);
      return;
    }
    std::istringstream numbers(rest);
    CharacterDrag drag;
    if (numbers >> drag.edge >> drag.screw && drag.edge > 0 && drag.screw > 0 && !(numbers >> word))
    {
      drags[f] = {drag.edge * units::pascal_second, drag.screw * units::pascal_second};
      return;
    }
    deck.reject(path,
                "'" + item + "': allowed is 'FAMILY: EDGE SCREW' with two positive numbers, or 'FAMILY: sessile'");
  }
  deck.reject(path, "'" + name + "' is no family of slip systems of this crystal; allowed are " + known);
}

MobilityPointer viscous_law(const InputDeck &deck, const SlipSystems &systems)
{
  const std::vector<SlipFamily> families = families_of(systems);
  std::map<SlipFamily, CharacterDrag> drags;
  for (const SlipFamily f : families)
    drags[f] = read_drag(deck);
  for (const std::string &item : deck.items("Mobility/Family drags"))
    set_family(deck, item, families, drags);
  if (drags.empty())
    deck.reject("Mobility/Family drags", "at least one family must glide");
  return std::make_shared<FamilyGlide>(systems, drags);
}

MobilityPointer linear_law(const InputDeck &deck, const Parameters &p, const SlipSystems &systems)
{
  const MobilityPointer viscous = viscous_law(deck, systems);
  FrictionSettings friction;
  friction.stress = deck.number("Mobility/Friction stress") * units::pascal;
  const double density = find_material(deck.text("Material/Name")).mass_density_kg_per_m3;
  const double shear_wave = std::sqrt(p.medium.mu / units::pascal / density) * units::metre_per_second;
  friction.largest_speed = deck.number("Mobility/Largest speed") * shear_wave;
  if (friction.stress == 0 && friction.largest_speed == 0)
    return viscous;
  return std::make_shared<FrictionGlide>(viscous, friction);
}

/// Tungsten's parameters, or the ones given; other materials must give all.
KinkPairParameters kink_pairs(const InputDeck &deck)
{
  KinkPairParameters k = tungsten_kink_pairs(deck.number("Mobility/Temperature"));
  const std::string material = find_material(deck.text("Material/Name")).name;
  const auto read = [&](const std::string &entry, const double unit, double &value)
  {
    if (material != "tungsten" && deck.number("Mobility/" + entry) == 0)
      deck.reject("Mobility/" + entry, "must be given for the kink-pair law of " + material +
                                           ": the program knows these parameters of tungsten only");
    value = number_or(deck, entry, unit, value);
  };
  read("Edge drag", units::pascal_second, k.edge_drag);
  read("Screw drag", units::pascal_second, k.screw_drag);
  read("Kink drag", units::pascal_second, k.kink_drag);
  read("Kink-pair enthalpy", 1, k.enthalpy);
  read("Peierls stress", units::pascal, k.peierls_stress);
  read("Athermal temperature", 1, k.athermal_temperature);
  const auto exponents = deck.numbers("Mobility/Kink-pair exponents", 2);
  if (exponents[0] != 0 || exponents[1] != 0)
  {
    k.p = exponents[0];
    k.q = exponents[1];
  }
  else if (material != "tungsten")
    deck.reject("Mobility/Kink-pair exponents", "must be given for the kink-pair law of " + material);
  return k;
}

/// Entries that mean nothing under the chosen law must be left alone.
void check_unused(const InputDeck &deck, const std::string &law)
{
  const auto reject_unless = [&](const std::string &owner, const std::vector<std::string> &entries)
  {
    for (const std::string &entry : entries)
      if (law != owner && deck.number("Mobility/" + entry) != 0)
        deck.reject("Mobility/" + entry, "belongs to Mobility/Law = " + owner + "; it is " + law);
  };
  reject_unless("linear", {"Friction stress", "Largest speed"});
  reject_unless("kink pair", {"Kink drag", "Kink-pair enthalpy", "Peierls stress", "Athermal temperature"});
  if (law != "linear" && !deck.items("Mobility/Family drags").empty())
    deck.reject("Mobility/Family drags", "belongs to Mobility/Law = linear; it is " + law);
}
} // namespace

void read_mobility(const InputDeck &deck, Parameters &p)
{
  const std::string law = deck.text("Mobility/Law");
  check_unused(deck, law);
  const SlipSystems systems = p.slip_systems();
  if (law == "kink pair" && p.lattice != Lattice::bcc)
    deck.reject("Mobility/Law", std::string("kink pair is a law of bcc crystals; this one is ") + name_of(p.lattice));
  try
  {
    if (law == "kink pair")
      p.mobility = std::make_shared<KinkPairGlide>(systems, kink_pairs(deck));
    else if (law == "linear")
      p.mobility = linear_law(deck, p, systems);
    else
      p.mobility = linear_glide(read_drag(deck).edge, read_drag(deck).edge);
  }
  catch (const std::invalid_argument &e)
  {
    deck.reject("Mobility/Law", e.what());
  }
  if (const double climb = deck.number("Mobility/Climb drag") * units::pascal_second; climb > 0)
    p.mobility = std::make_shared<Climb>(p.mobility, climb);
  p.velocities.method =
      deck.text("Mobility/Velocities") == "local" ? VelocityMethod::local : VelocityMethod::consistent;
  if (p.velocities.method == VelocityMethod::consistent &&
      (law == "kink pair" || deck.number("Mobility/Friction stress") > 0))
    deck.reject("Mobility/Velocities", "consistent velocities do not converge with thresholds: allowed are laws "
                                       "without friction stress or kink pairs");
  p.velocities.sliding_drag = deck.number("Mobility/Sliding drag");
}
} // namespace ddfem::coupling
