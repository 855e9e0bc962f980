// Images of dislocation lines under a free surface as multipoles.
//
// Displacement and stress of the images (half_space_image.h; half-space z > 0) come from the four harmonic potentials P, Q of
// displacement_expansion.h. With y = x - x0, x0 the centre of the box:
//   * The mirror image of a segment, closed by its legs: a strip that reaches from it to z = -infinity. Integrals of the dipoles S_mj d'_j
//     over the strip give P_m = S_mj d_j Lambda, Q = (y'_i S_ij d_j - (1-2nu) S_ii) Lambda + S_zj d_j psi per length of line, S with the area vector
//     t x e_z' per unit of both lengths (e_z': out of the body).
//   * The function phi of solution F: P_z = k phi_,z, Q = -k ((1-2nu) phi + z_0 phi_,z), k = 4 pi (1-nu)/mu.
//   * The torsion u = (b/2 pi) (psi_,y, -psi_,x, 0) of a line that ends on the surface: P = -b (psi_,y, -psi_,x, 0), Q = y'.P.
// A move of x0 by D changes Q to Q - D.P for all of them. Every function becomes a multipole by three derivatives with respect to z, which is what the
// moments hold; their translation to local expansions integrates again (half_line_translation.h).
#pragma once

#include "dd/elasticity/half_space_image.h"
#include "dd/fmm/displacement_expansion.h"

#include <span>
#include <variant>

namespace ddfem::fmm
{
/// In the frame of the surface.
using ImageSource = std::variant<SegmentImage, LegImage, PiercingImage>;

/// The integrals that lead from the multipoles of the moments to the potentials.
inline constexpr int n_image_antiderivatives = 3;

/// Adds the moments of images of @p medium about @p centre (nm), in a box of @p size (nm): P in the first three fields, and Q. @p core_radius of
/// the mirror images: that of the medium for the stress, 0 for the displacement (triangle_displacement.h); to its second order.
void add_image_moments(int order, double tolerance, const IsotropicMedium &medium, double core_radius,
                       const Vec3 &centre, double size, std::span<const ImageSource> images,
                       const ExpansionView &moments);
} // namespace ddfem::fmm
