#include "dd/crystal/material.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

namespace
{
using namespace ddfem;

/// Voigt average computed from the definition: the full tensor C_ijkl and its two rotation invariants C_iijj, C_ijij.
IsotropicAverage average_of_tensor(const Material &m)
{
  const SingleCrystalStiffness &c = m.stiffness;
  const double c66 = m.lattice == Lattice::hcp ? (c.c11 - c.c12) / 2 : c.c44;
  const std::array<std::array<double, 6>, 6> voigt = {{{c.c11, c.c12, c.c13, 0, 0, 0},
                                                       {c.c12, c.c11, c.c13, 0, 0, 0},
                                                       {c.c13, c.c13, c.c33, 0, 0, 0},
                                                       {0, 0, 0, c.c44, 0, 0},
                                                       {0, 0, 0, 0, c.c44, 0},
                                                       {0, 0, 0, 0, 0, c66}}};
  const auto pair = [](std::size_t i, std::size_t j) { return i == j ? i : 6 - i - j; };
  double iijj = 0, ijij = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
    {
      iijj += voigt[i][j];
      ijij += voigt[pair(i, j)][pair(i, j)];
    }
  // Isotropic: iijj = 9 lambda + 6 mu, ijij = 3 lambda + 12 mu.
  const double mu = (3 * ijij - iijj) / 30, lambda = (iijj - 6 * mu) / 9;
  return {mu, lambda / (2 * (lambda + mu))};
}

TEST(Material, IsotropicConstantsAreTheVoigtAverageOfTheSingleCrystal)
{
  for (const Material &m : known_materials())
  {
    const IsotropicAverage expected = average_of_tensor(m);
    EXPECT_NEAR(m.mu, expected.mu, 1e-9 * expected.mu) << m.name;
    EXPECT_NEAR(m.nu, expected.nu, 1e-12) << m.name;
  }
}

TEST(Material, IsotropicConstantsAreWithinMeasurementScatterOfOtherCompilations)
{
  // mu (GPa) and nu from Voigt averages of the older measurements compiled by Hirth & Lothe (1982) for the cubic
  // metals; polycrystalline zirconium from the CRC Handbook / Samsonov.
  const std::map<std::string, std::pair<double, double>> published = {
      {"aluminium", {26.5, 0.347}}, {"copper", {54.6, 0.324}},    {"nickel", {94.7, 0.276}},
      {"iron", {86.0, 0.291}},      {"tungsten", {160.0, 0.278}}, {"zirconium", {36.0, 0.33}}};
  for (const Material &m : known_materials())
  {
    const auto &[mu, nu] = published.at(m.name);
    EXPECT_NEAR(m.mu, 1e3 * mu, 0.035 * 1e3 * mu) << m.name; // MPa
    EXPECT_NEAR(m.nu, nu, 0.02) << m.name;
  }
}

TEST(Material, BurgersVectorIsTheShortestLatticeTranslation)
{
  EXPECT_NEAR(find_material("aluminium").burgers_magnitude, 0.2863, 1e-4);
  EXPECT_NEAR(find_material("copper").burgers_magnitude, 0.2556, 1e-4);
  EXPECT_NEAR(find_material("nickel").burgers_magnitude, 0.2492, 1e-4);
  EXPECT_NEAR(find_material("iron").burgers_magnitude, 0.2482, 1e-4);
  EXPECT_NEAR(find_material("tungsten").burgers_magnitude, 0.2741, 1e-4);
  EXPECT_NEAR(find_material("zirconium").burgers_magnitude, 0.3232, 1e-4);
  EXPECT_NEAR(*find_material("zirconium").c_over_a, 1.593, 1e-3);
}

TEST(Material, DensityFollowsFromLatticeParameterAndAtomicMass)
{
  const std::map<std::string, double> atomic_mass = {{"aluminium", 26.982}, {"copper", 63.546},
                                                     {"nickel", 58.693},    {"iron", 55.845},
                                                     {"tungsten", 183.84},  {"zirconium", 91.224}};
  constexpr double dalton = 1.66053907e-27; // kg
  for (const Material &m : known_materials())
  {
    const double a = m.lattice_parameter * 1e-9;
    const double cell = m.lattice == Lattice::hcp ? std::sqrt(3.0) / 2 * *m.c_over_a * a * a * a : a * a * a;
    const double n_atoms = m.lattice == Lattice::fcc ? 4 : 2;
    EXPECT_NEAR(m.mass_density_kg_per_m3, n_atoms * atomic_mass.at(m.name) * dalton / cell,
                0.01 * m.mass_density_kg_per_m3)
        << m.name;
  }
}

TEST(Material, EveryNumberHasASourceAndDragIsOfThePhononMagnitude)
{
  EXPECT_EQ(known_materials().size(), 6u);
  for (const Material &m : known_materials())
  {
    EXPECT_FALSE(m.lattice_source.empty() || m.elasticity_source.empty() || m.drag_source.empty() ||
                 m.density_source.empty());
    EXPECT_GT(m.drag, 1e-2); // MPa ns = 1e-3 Pa s
    EXPECT_LT(m.drag, 1.0);
  }
  EXPECT_DOUBLE_EQ(find_material("copper").drag, 1.7e-5 * 1e3);
}

TEST(Material, UnknownNameIsAnsweredWithTheKnownOnes)
{
  EXPECT_EQ(find_material("aluminum").name, "aluminium");
  try
  {
    find_material("unobtainium");
    FAIL();
  }
  catch (const std::invalid_argument &error)
  {
    EXPECT_STREQ(error.what(), "Unknown material \"unobtainium\"; known are aluminium, copper, nickel, iron, tungsten, "
                               "zirconium.");
  }
}
} // namespace
