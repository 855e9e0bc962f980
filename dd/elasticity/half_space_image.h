// Image fields of dislocation lines under a traction-free plane, in closed form or by a short quadrature.
//
// Half-space z > 0 with the free surface z = 0; "image" is what has to be added to the infinite-body field so that
// the surface carries no traction. With M = diag(1, 1, -1) the mirrored field M sigma~(M x) M is that of the line
// M x'(s) with the Burgers vector -M b. On the surface it has the opposite shear tractions and the same normal one:
// adding it leaves only a normal traction 2 sigma~_zz, which one harmonic function phi removes (Boussinesq; Barber,
// Elasticity, ch. 21, "solution F"):
//
//   2 mu u_i = (1-2nu) phi_,i + z phi_,iz  (i = x, y),    2 mu u_z = -2(1-nu) phi_,z + z phi_,zz
//   sigma_zz = -phi_,zz + z phi_,zzz,   sigma_iz = z phi_,izz,   sigma_xy = (1-2nu) phi_,xy + z phi_,xyz
//   sigma_xx = phi_,xx + 2nu phi_,yy + z phi_,xxz,   sigma_yy = phi_,yy + 2nu phi_,xx + z phi_,yyz
//
// with phi_,zz = 2 sigma~_zz on z = 0. The boundary values of R = |x - x'| there and of its derivatives continue into
// z > 0 as harmonic functions of (X, Y, Z) = (x-x', y-y', z+z'), Rb = |(X, Y, Z)|:
// 1/Rb, Lambda = ln(Rb + Z), psi = Z Lambda - Rb, each the z-derivative of the next. From the Peach-Koehler integral,
//
//   phi = mu/(2 pi) int { c . grad psi + z'/(1-nu) (e_x d_x + e_y d_y - e_z d_z) Lambda } ds,
//   e = b x t,   c = 2 t_z (b_y, -b_x) - (e_x, e_y)/(1-nu).
//
// In the non-singular theory the source points move to the depth D = sqrt(z'^2 + a^2): on the surface R_a is then the
// singular R, and the surface stays free of tractions for any core radius. Z = z + D, D stands for z' in front of e_x and
// e_y, and the screw part adds -(a^2/D) t_z (b_y d_x - b_x d_y) Lambda.
//
// The integral is taken by Gauss rules on panels. Each piece of line is in equilibrium on its own if its mirror image is
// closed, which is why pieces come with *legs*: half-lines from their ends into the depth, whose mirror images run away
// from the body.
#pragma once

#include "dd/common/types.h"
#include "dd/elasticity/isotropic.h"
#include "dd/elasticity/point_batch.h"
#include "dd/elasticity/triangular_loop.h"

namespace ddfem
{
/// What all points share. For the kernels and for expansions.
struct SegmentImageData
{
  IsotropicMedium medium;
  Vec3 start, end, burgers; ///< of the mirror image, nm
  Vec3 t, edge;             ///< unit direction of the mirror image; burgers x t, nm
  Vec3 e;                   ///< (e_x, e_y, -e_z)/(1-nu), nm
  Vec3 c;                   ///< nm, third component zero
  Vec3 core;                ///< -a^2 t_z (b_y, -b_x, 0), nm^3
  double length;            ///< nm
  double branch;            ///< sum of the distances of the ends from where D has branch points, nm
  double tolerance;         ///< relative error of the quadrature
  TriangularLoop strip;     ///< the mirror image and its legs
};

struct LegImageData
{
  IsotropicMedium medium;
  Vec3 origin, burgers; ///< of the mirror image, nm
  Vec3 c;
  double of_chi, of_psi, of_lambda; ///< coefficients in phi: 1, nm, nm^2
};

struct PiercingImageData
{
  IsotropicMedium medium;
  Vec3 origin, burgers; ///< of the mirror image of the leg, nm
  double screw;         ///< b_z of the line with sense +z, nm
  double tolerance;     ///< relative error of the quadrature

  /// Distance (nm) from the point beyond which expansions in the core radius hold; the relative error, (a/distance)^4, is about
  /// 1e-6.
  double core_distance() const { return 30 * medium.a; }
};

/// Image field of one straight segment under the free surface z = 0 of the half-space z > 0.
class SegmentImage
{
public:
  /// Segment @p x1 -> @p x2 (nm, z >= 0) with Burgers vector @p b (nm, FS/RH). @p tolerance: relative error of the
  /// quadrature.
  SegmentImage(const IsotropicMedium &medium, const Vec3 &x1, const Vec3 &x2, const Vec3 &b, double tolerance);

  /// Stress (MPa) at @p x (nm, z >= 0), without legs.
  SymTensor stress(const Vec3 &x) const;
  /// Displacement (nm) at @p x; the mirror image is closed by its legs, so that nothing jumps in z >= 0.
  Vec3 displacement(const Vec3 &x) const;
  /// Add the same at many points, with the same points of the quadrature, by vector instructions.
  void add_stress(const StressBatch &batch) const;
  void add_displacement(const DisplacementBatch &batch) const;

  /// Distance (nm) of @p x from the singularities of the stress, which lie on the mirror image.
  double distance(const Vec3 &x) const;

  const SegmentImageData &parameters() const { return data; }
  /// The same image with a quadrature of no less error than @p tolerance.
  SegmentImage loosened(double tolerance) const;

private:
  SegmentImageData data;
};

/// Image field of the half-line from @p x (z >= 0) to z = infinity, line sense away from @p x: a leg of the ends of a
/// line. Needed where the flux of the Burgers vector of imaged segments ends. With the core radius a the integral over the
/// leg adds -a^2/(2(1-nu)) Lambda to what is derived in phi, up to (a/z)^4: a leg that begins above shortest_depth() is to be
/// continued down to it by a SegmentImage.
class LegImage
{
public:
  LegImage(const IsotropicMedium &medium, const Vec3 &x, const Vec3 &b);

  /// Depth (nm) from which on the relative error, (a/z)^4, is about 1e-6.
  static double shortest_depth(const IsotropicMedium &medium) { return 30 * medium.a; }

  SymTensor stress(const Vec3 &x) const;
  /// Displacement of the part that is not the mirror image, nm; the mirror image of the leg belongs to the segments'
  /// SegmentImage::displacement(). Up to a rigid translation.
  Vec3 displacement(const Vec3 &x) const;
  void add_stress(const StressBatch &batch) const;
  void add_displacement(const DisplacementBatch &batch) const;

  /// As SegmentImage::distance(); mirrored legs run away from the body, so that their end is nearest.
  double distance(const Vec3 &x) const { return (x - data.origin).norm(); }

  const LegImageData &parameters() const { return data; }

private:
  LegImageData data;
};

/// Image field of the whole line that pierces the surface at @p x (z = 0) along its normal, less the parts that
/// belong to the image of its leg: what remains is the torsion of the screw part. For a = 0 it is that of Eshelby & Stroh (Phil.
/// Mag. 42 (1951) 1401), u = (b/2 pi) (d_y psi, -d_x psi, 0), which leaves free the surface with the shear tractions
/// mu b/(2 pi) 1/r of the singular line. With the core radius these are mu b/(2 pi) d_r g, g = (1 - a/2 d_a) ln(sqrt(r^2 + a^2)), and
///
///   d_z psi = (1 - a/2 d_a) [ -int_0^infinity ds/sqrt(r^2 + (z+D)^2) ] = g on z = 0,   D = sqrt(s^2 + a^2).
///
/// The integrand in psi is -Lambda + a^2/(2D)/Rb with Z = z + D. From s = 30 a on it is that of a = 0 up to (a/s)^4; farther than 30 a from the
/// point the whole is psi - a^2/4 /|x| up to (a/|x|)^4.
/// @p b: Burgers vector for the line sense that leaves the body.
class PiercingImage
{
public:
  PiercingImage(const IsotropicMedium &medium, const Vec3 &x, const Vec3 &b, double tolerance);

  /// The mirror image of the leg included, so that the stress of a line that ends here is that of its segments' images
  /// plus this.
  SymTensor stress(const Vec3 &x) const;
  /// Without the mirror image of the leg, as in LegImage::displacement().
  Vec3 displacement(const Vec3 &x) const;
  void add_stress(const StressBatch &batch) const;
  void add_displacement(const DisplacementBatch &batch) const;

  double distance(const Vec3 &x) const { return (x - data.origin).norm(); }

  const PiercingImageData &parameters() const { return data; }
  /// The same image with a quadrature of no less error than @p tolerance.
  PiercingImage loosened(double tolerance) const;

private:
  PiercingImageData data;
};
} // namespace ddfem
