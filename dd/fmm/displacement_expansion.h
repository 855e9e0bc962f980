// Displacement of distant infinitesimal loops from four harmonic potentials.
//
// A loop of area vector A (right-hand, nm^2) and Burgers vector b displaces by (Mura, Micromechanics of Defects in Solids, 1987,
// eq. 11.30 for the eigenstrain - sym(b x A); Hirth & Lothe, section 4-6)
//   - 8 pi (1 - nu) u_m = (1 - 2 nu) (b_m A.e + A_m b.e - b.A e_m)/R^2 + 3 b.e A.e e_m/R^2,   e = (x - x')/R.
// With S the symmetric part of b x A, y = x - x0 and x0 the centre of the box, this is (Papkovich and Neuber's form)
//   - 8 pi (1 - nu) u_m = 4 (1 - nu) P_m - d_m (y.P - Q),
// P and Q being the potentials of the charges
//   P_m = S_mj d'_j,   Q = y'_i S_ij d'_j + (1 - 2 nu) S_ii,
// where d'_j is a dipole: the derivative of 1/R with respect to the source. A move of x0 by D changes Q to Q - D.P, as for the stress
// (stress_expansion.h), so that the same translations serve.
#pragma once

#include "dd/elasticity/point_batch.h"
#include "dd/elasticity/triangular_loop.h"
#include "dd/fmm/stress_expansion.h"

#include <span>

namespace ddfem::fmm
{
/// Adds the multipole coefficients of finite triangular loops about @p centre (nm), in a box of @p size (nm): P in the first three
/// fields, and Q. Product rules over the triangles with the points that @p tolerance needs.
void add_moments(int order, double tolerance, double nu, const Vec3 &centre, double size,
                 std::span<const TriangularLoop> loops, const ExpansionView &moments);

/// The displacement (nm) in one box from its local coefficients, prepared for evaluation at many points.
class LocalDisplacement : public LocalExpansion<3>
{
public:
  LocalDisplacement(double nu, int order, const Vec3 &centre, double size, const Row *fields, const double *q);
};

/// The stress (MPa) of that displacement.
class LocalDisplacementStress : public LocalExpansion<6>
{
public:
  LocalDisplacementStress(const IsotropicMedium &medium, int order, const Vec3 &centre, double size, const Row *fields,
                          const double *q);
};
} // namespace ddfem::fmm
