#include "dd/crystal/material.h"

#include "dd/common/units.h"
#include "dd/crystal/burgers_vectors.h"

#include <stdexcept>

namespace ddfem
{
namespace
{
constexpr double gpa = 1e9 * units::pascal;

constexpr const char *handbook_lattice =
    "CRC Handbook of Chemistry and Physics, 98th ed., table \"Crystal Structures and Lattice Parameters of the "
    "Elements\"";
constexpr const char *handbook_density =
    "CRC Handbook of Chemistry and Physics, 98th ed., table \"Thermal and Physical Properties of Pure Metals\"";
constexpr const char *handbook_elasticity =
    "Voigt average of the single-crystal constants of the CRC Handbook of Chemistry and Physics, 98th ed., table "
    "\"Elastic Constants of Single Crystals\"";

/// Units of this table: nm, GPa, Pa s, kg/m^3.
Material make(const char *name, Lattice lattice, double a, std::optional<double> c,
              const SingleCrystalStiffness &in_gpa, double drag, const char *drag_source, double density)
{
  Material m;
  m.name = name;
  m.lattice = lattice;
  m.lattice_parameter = a;
  if (c)
    m.c_over_a = *c / a;
  m.burgers_magnitude = burgers_magnitude(lattice, a);
  m.stiffness = {in_gpa.c11 * gpa, in_gpa.c12 * gpa, in_gpa.c44 * gpa, in_gpa.c13 * gpa, in_gpa.c33 * gpa};
  const IsotropicAverage average = voigt_average(lattice, m.stiffness);
  m.mu = average.mu;
  m.nu = average.nu;
  m.drag = drag * units::pascal_second;
  m.mass_density_kg_per_m3 = density;
  m.lattice_source = handbook_lattice;
  m.elasticity_source = handbook_elasticity;
  m.drag_source = drag_source;
  m.density_source = handbook_density;
  return m;
}

SingleCrystalStiffness cubic(double c11, double c12, double c44)
{
  return {c11, c12, c44, c12, c11};
}

constexpr const char *phonon_drag_estimate =
    "order of magnitude of the phonon drag of metals near 300 K, 1e-5 to 1e-4 Pa s (Hirth & Lothe 2nd ed. 1982, "
    "section "
    "7-7; Kubin, Dislocations, Mesoscale Simulations and Plastic Flow, Oxford 2013); not a measurement of this metal";

std::vector<Material> make_table()
{
  return {
      make("aluminium", Lattice::fcc, 0.40496, {}, cubic(106.75, 60.41, 28.34), 2e-5, phonon_drag_estimate, 2700),
      make("copper", Lattice::fcc, 0.36146, {}, cubic(168.3, 121.2, 75.7), 1.7e-5,
           "edge lines near 300 K: Jassby & Vreeland, Phil. Mag. 21 (1970) 1147; DD simulations of copper commonly use "
           "1.5e-5 Pa s (Kubin et al., Solid State Phenomena 23-24 (1992) 455)",
           8960),
      make("nickel", Lattice::fcc, 0.35240, {}, cubic(248.1, 154.9, 124.2), 1.5e-5,
           "edge lines at 300 K, 5e-8 Pa s/K times T in the materials library of MoDELib2 (Ni.txt); magnitude of the "
           "molecular dynamics of Olmsted et al., MSMSE 13 (2005) 371",
           8900),
      make("iron", Lattice::bcc, 0.28665, {}, cubic(226, 140, 116), 1e-4, phonon_drag_estimate, 7870),
      make("tungsten", Lattice::bcc, 0.31652, {}, cubic(522.39, 204.37, 160.58), 6.87e-4,
           "edge lines at 300 K, B = 4.26e-4 + 0.87e-6 T Pa s: Po et al., Acta Mater. 119 (2016) 123, as tabulated in "
           "MoDELib2 (W.txt); screw lines below about 2000 K are thermally activated, not viscous",
           19300),
      make("zirconium", Lattice::hcp, 0.32316, 0.51475, {143.4, 72.8, 32.0, 65.3, 164.8}, 5e-5,
           "value for basal and prismatic planes in the materials library of MoDELib2 (Zr.txt), not attributed to a "
           "measurement there; order of magnitude of phonon drag",
           6520),
  };
}
} // namespace

IsotropicAverage voigt_average(Lattice lattice, const SingleCrystalStiffness &c)
{
  double bulk = 0, mu = 0;
  if (lattice == Lattice::hcp)
  {
    const double c66 = (c.c11 - c.c12) / 2;
    bulk = (2 * c.c11 + 2 * c.c12 + 4 * c.c13 + c.c33) / 9;
    mu = (c.c11 + c.c12 + 2 * c.c33 - 4 * c.c13 + 12 * c.c44 + 12 * c66) / 30;
  }
  else
  {
    bulk = (c.c11 + 2 * c.c12) / 3;
    mu = (c.c11 - c.c12 + 3 * c.c44) / 5;
  }
  return {mu, (3 * bulk - 2 * mu) / (2 * (3 * bulk + mu))};
}

const std::vector<Material> &known_materials()
{
  static const std::vector<Material> table = make_table();
  return table;
}

const Material &find_material(std::string_view name)
{
  if (name == "aluminum")
    name = "aluminium";
  for (const Material &m : known_materials())
    if (m.name == name)
      return m;
  std::string known;
  for (const Material &m : known_materials())
    known += (known.empty() ? "" : ", ") + m.name;
  throw std::invalid_argument("Unknown material \"" + std::string(name) + "\"; known are " + known + ".");
}
} // namespace ddfem
