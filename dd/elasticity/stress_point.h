// The stress of a straight line at one point in plain numbers, from which both the single and the vectorised evaluation are
// made. Internal to dd/elasticity.
#pragma once

#include "dd/common/types.h"
#include "dd/elasticity/isotropic.h"
#include "dd/elasticity/line_integrals.h"

#include <cmath>
#include <numbers>

namespace ddfem::internal
{
/// What all points share: unit line direction t, Burgers vector b, e = b x t, 1/(1-nu), a^2, mu/(4 pi).
struct LineConstants
{
  double t[3], b[3], e[3];
  double m, a2, prefactor;

  LineConstants(const IsotropicMedium &medium, const Vec3 &direction, const Vec3 &burgers)
      : t{direction[0], direction[1], direction[2]}, b{burgers[0], burgers[1], burgers[2]}, e{b[1] * t[2] - b[2] * t[1],
                                                                                              b[2] * t[0] - b[0] * t[2],
                                                                                              b[0] * t[1] -
                                                                                                  b[1] * t[0]},
        m(1.0 / (1.0 - medium.nu)), a2(medium.a * medium.a), prefactor(medium.mu / (4.0 * std::numbers::pi))
  {
  }
};

/// The formula at the top of segment_stress.h with R = d - s t inserted (R x b = d x b + s e, R.e = d.e), d the vector from
/// the line to the point.
inline void assemble_stress(const LineConstants &c, const StressIntegrals &j, double d0, double d1, double d2,
                            double (&sigma)[6])
{
  const double de = c.m * (d0 * c.e[0] + d1 * c.e[1] + d2 * c.e[2]);
  const double core = 1.5 * c.a2;
  const double of_cross = -(j.j03 + core * j.j05), of_e = (c.m - 1.0) * j.j13 - core * j.j15;
  const double of_d = -3.0 * de * j.j15, of_t = 1.5 * de * j.j25;
  const double v0 = of_cross * (d1 * c.b[2] - d2 * c.b[1]) + of_e * c.e[0] + of_d * d0 + of_t * c.t[0];
  const double v1 = of_cross * (d2 * c.b[0] - d0 * c.b[2]) + of_e * c.e[1] + of_d * d1 + of_t * c.t[1];
  const double v2 = of_cross * (d0 * c.b[1] - d1 * c.b[0]) + of_e * c.e[2] + of_d * d2 + of_t * c.t[2];
  const double e_in_w = -c.m * j.j03, d_in_w = 1.5 * de * j.j05;
  const double w0 = e_in_w * c.e[0] + d_in_w * d0, w1 = e_in_w * c.e[1] + d_in_w * d1,
               w2 = e_in_w * c.e[2] + d_in_w * d2;
  const double pressure = de * (j.j03 + 2.0 * core * j.j05);
  sigma[0] = c.prefactor * (2.0 * (c.t[0] * v0 + d0 * w0) + pressure);
  sigma[1] = c.prefactor * (2.0 * (c.t[1] * v1 + d1 * w1) + pressure);
  sigma[2] = c.prefactor * (2.0 * (c.t[2] * v2 + d2 * w2) + pressure);
  sigma[3] = c.prefactor * (c.t[0] * v1 + c.t[1] * v0 + d0 * w1 + d1 * w0);
  sigma[4] = c.prefactor * (c.t[0] * v2 + c.t[2] * v0 + d0 * w2 + d2 * w0);
  sigma[5] = c.prefactor * (c.t[1] * v2 + c.t[2] * v1 + d1 * w2 + d2 * w1);
}

/// Segment of given length; (p, q) are the vectors from its first and second end to the point.
inline void segment_stress_at(const LineConstants &c, double length, double p0, double p1, double p2, double q0,
                              double q1, double q2, double (&sigma)[6])
{
  const double s1 = -(p0 * c.t[0] + p1 * c.t[1] + p2 * c.t[2]), s2 = -(q0 * c.t[0] + q1 * c.t[1] + q2 * c.t[2]);
  // The perpendicular is taken from the nearer end: its rounding error is then relative to the smaller distance.
  const bool first_nearer = std::abs(s1) < std::abs(s2);
  const double s = first_nearer ? s1 : s2;
  const double d0 = (first_nearer ? p0 : q0) + s * c.t[0], d1 = (first_nearer ? p1 : q1) + s * c.t[1],
               d2 = (first_nearer ? p2 : q2) + s * c.t[2];
  const SegmentGeometry geometry(s1, s2, length, d0 * d0 + d1 * d1 + d2 * d2 + c.a2);
  assemble_stress(c, stress_integrals(geometry), d0, d1, d2, sigma);
}

/// Ray; p is the vector from its origin to the point.
inline void ray_stress_at(const LineConstants &c, double p0, double p1, double p2, double (&sigma)[6])
{
  const double s = -(p0 * c.t[0] + p1 * c.t[1] + p2 * c.t[2]);
  const double d0 = p0 + s * c.t[0], d1 = p1 + s * c.t[1], d2 = p2 + s * c.t[2];
  assemble_stress(c, ray_stress_integrals(s, d0 * d0 + d1 * d1 + d2 * d2 + c.a2), d0, d1, d2, sigma);
}
} // namespace ddfem::internal
