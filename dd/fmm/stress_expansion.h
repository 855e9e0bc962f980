// Stress of distant dislocation lines from nine harmonic potentials.
//
// Let A_mk = int b_m dx'_k over the lines and R = |x - x'|. The potentials of a group of lines are those of the charges
//   P_i  = eps_imk A_mk                      (i.e. int b x dx'),
//   S_mk = symmetric, traceless part of A    (the trace has no field),
//   Q    = int (b x dx') . (x' - x0),
// with x0 the centre of the box. With y = x - x0, the stress of Peach and Koehler (Hirth & Lothe, eq. 4-6; Cai et al.,
// JMPS 54 (2006) 561) is
//   4 pi/mu sigma_ab = eps_ima d_i S_mb + eps_imb d_i S_ma + (m - 1/2) (d_a P_b + d_b P_a) + (1 - 2 m) delta_ab div P
//                      + m (y_i d_a d_b P_i - d_a d_b Q),     m = 1/(1 - nu).
// The core radius a enters through R_a = R + a^2/(2 R) + O(a^4/R^3), whose Laplacian is 2/R + O(a^4): all of order a^2 is one
// dipole, Q -> Q - a^2/2 div P. A move of x0 by D changes Q to Q - D.P.
#pragma once

#include "dd/elasticity/point_batch.h"
#include "dd/elasticity/segment_stress.h"
#include "dd/fmm/expansion_loops.h"
#include "dd/fmm/solid_harmonics.h"

#include <span>
#include <vector>

namespace ddfem::fmm
{
/// A straight directed piece of line, nm (FS/RH).
struct LineSource
{
  Vec3 start, end, burgers;
};

/// A semi-infinite line that leaves `origin` along the unit vector `direction`, Burgers vector for that sense, nm.
struct RaySource
{
  Vec3 origin, direction, burgers;
};

/// Coefficients of the potentials of one box. Row k of `fields`: harmonic k of Px Py Pz Sxx Syy Sxy Sxz Syz.
struct ExpansionView
{
  Row *fields;
  double *q;
};

/// Adds the multipole coefficients of @p sources about @p centre (nm), in a box of @p size (nm), to @p moments. Integrals
/// along the lines by Gauss rules with the points that @p tolerance needs at degrees that matter.
void add_moments(int order, double tolerance, const Vec3 &centre, double size, std::span<const LineSource> sources,
                 const ExpansionView &moments);

/// Adds the local coefficients, in a box of @p size around @p centre (nm), of @p rays that pass at a distance of several
/// @p size. Degree 0, of which the stress does not depend, and which diverges, is left out.
void add_local_of_rays(int order, const Vec3 &centre, double size, std::span<const RaySource> rays,
                       const ExpansionView &local);

/// Calls set(k, Q_k) for @p n coefficients Q_k of a box after a move of x0 by @p shift (nm).
template <class Scalar, class Set>
void move_reference_point(const std::size_t n, const Vec3 &shift, const typename Precision<Scalar>::Narrow::Row *fields,
                          const Scalar *q, Set &&set)
{
  const auto dx = static_cast<Scalar>(shift[0]), dy = static_cast<Scalar>(shift[1]), dz = static_cast<Scalar>(shift[2]);
  for (std::size_t k = 0; k < n; ++k)
    set(k, q[k] - (dx * fields[k][0] + dy * fields[k][1] + dz * fields[k][2]));
}

/// The stress (MPa) in one box from its local coefficients, prepared for evaluation at many points.
class LocalStress : public LocalExpansion<6>
{
public:
  LocalStress(const IsotropicMedium &medium, int order, const Vec3 &centre, double size, const Row *fields,
              const double *q);
};
} // namespace ddfem::fmm
