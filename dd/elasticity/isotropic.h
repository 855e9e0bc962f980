// Isotropic elastic constants together with the core radius of the non-singular theory.
#pragma once

namespace ddfem
{
/// Parameters of the isotropic non-singular theory (Cai, Arsenlis, Weinberger, Bulatov, JMPS 54 (2006) 561).
struct IsotropicMedium
{
  double mu = 0.0; ///< shear modulus, MPa
  double nu = 0.0; ///< Poisson's ratio, dimensionless
  double a = 0.0;  ///< core radius, nm

  /// Young's modulus 2 mu (1 + nu), MPa.
  double youngs_modulus() const { return 2.0 * mu * (1.0 + nu); }
};
} // namespace ddfem
