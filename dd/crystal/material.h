// Named materials, with a source for every number.
#pragma once

#include "dd/crystal/lattice.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ddfem
{
/// Stiffnesses of a single crystal, MPa, crystal axes, Voigt notation. Cubic crystals have c13 = c12, c33 = c11.
struct SingleCrystalStiffness
{
  double c11 = 0, c12 = 0, c44 = 0, c13 = 0, c33 = 0;
};

/// Isotropic elastic constants.
struct IsotropicAverage
{
  double mu = 0; ///< shear modulus, MPa
  double nu = 0; ///< Poisson's ratio
};

/// Voigt (uniform strain) average over all orientations of the crystal, in the units of the stiffnesses.
/// Cubic: K = (c11 + 2 c12)/3, mu = (c11 - c12 + 3 c44)/5. Hexagonal, with c66 = (c11 - c12)/2:
/// K = (2 c11 + 2 c12 + 4 c13 + c33)/9, mu = (c11 + c12 + 2 c33 - 4 c13 + 12 c44 + 12 c66)/30.
/// Source: Simmons & Wang, Single Crystal Elastic Constants, 2nd ed., MIT Press 1971; Hirth & Lothe, Theory of
/// Dislocations, 2nd ed. 1982, section 13-2, recommend the Voigt average for dislocations.
IsotropicAverage voigt_average(Lattice lattice, const SingleCrystalStiffness &c);

/// Properties of an element near 300 K.
struct Material
{
  std::string name;
  Lattice lattice = Lattice::fcc;
  double lattice_parameter = 0;      ///< a, nm
  std::optional<double> c_over_a;    ///< hcp only
  double burgers_magnitude = 0;      ///< nm: a/sqrt(2) fcc, a sqrt(3)/2 bcc, a hcp
  SingleCrystalStiffness stiffness;  ///< MPa
  double mu = 0;                     ///< isotropic shear modulus, MPa; Voigt average of the stiffnesses
  double nu = 0;                     ///< isotropic Poisson's ratio; same
  double drag = 0;                   ///< glide drag coefficient B, MPa ns (1 MPa ns = 1e-3 Pa s)
  double mass_density_kg_per_m3 = 0; ///< kg/m^3
  std::string lattice_source;
  std::string elasticity_source;
  std::string drag_source; ///< says so where the value is an order of magnitude only
  std::string density_source;
};

/// Aluminium, copper, nickel, iron, tungsten, zirconium (lower case). "aluminum" is understood.
/// Throws std::invalid_argument that lists the known names.
const Material &find_material(std::string_view name);
const std::vector<Material> &known_materials();
} // namespace ddfem
