// The stress of dislocation density as a convolution with third derivatives of R_a.
//
// With A_mk = int b_m dx'_k, R = x - x', R_a = sqrt(R^2 + a^2), D_ijk = d_i d_j d_k R_a, L_i = D_ipp and P_i = eps_imk A_mk, the
// stress of Peach and Koehler in the non-singular theory (Hirth & Lothe, eq. 4-6; Cai et al., JMPS 54 (2006) 561, eq. 6) is
//   8 pi/mu sigma_ab = L_i (eps_ima A_mb + eps_imb A_ma) + 2/(1 - nu) (D_iab - delta_ab L_i) P_i.
// The trace of A has no field. The core radius is exact, so that each level has kernels of its own.
#pragma once

#include "dd/common/types.h"
#include "dd/elasticity/isotropic.h"
#include "dd/fmm/grid_transform.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace ddfem::fmm
{
inline constexpr std::size_t n_kernels = 10;  ///< D: xxx xxy xxz xyy xyz xzz yyy yyz yzz zzz
inline constexpr std::size_t n_densities = 8; ///< A: xx-yy yy-zz xy yx xz zx yz zy
inline constexpr std::size_t n_stresses = 6;

using Offset = std::array<std::int16_t, 3>; ///< of boxes, in boxes

/// D at @p R (nm) for the core radius @p a (nm), 1/nm^2.
std::array<double, n_kernels> third_derivatives(const Vec3 &R, double a);
/// A of a line element @p d (nm) with Burgers vector @p b (nm).
std::array<double, n_densities> line_density(const Vec3 &b, const Vec3 &d);
/// Stress (MPa) of the density @p A where its kernels are @p D.
SymTensor stress_of_density(const IsotropicMedium &medium, const std::array<double, n_kernels> &D,
                            const std::array<double, n_densities> &A);

/// Spectra of the kernels between grids whose boxes have given offsets (source - target).
class GridKernel
{
public:
  /// @p spacing: of the points, nm; @p edges: of the boxes, nm. The kernels contain mu/(8 pi) and the normalisation of the transforms.
  GridKernel(const GridTransform &transform, const IsotropicMedium &medium, const Vec3 &spacing, const Vec3 &edges,
             std::span<const Offset> offsets);

  std::uint32_t number(const Offset &offset) const { return numbers[place(offset)]; }
  const Spectra &spectra() const { return values; }

private:
  std::size_t place(const Offset &offset) const;
  void fill(const GridTransform &transform, const IsotropicMedium &medium, const Vec3 &spacing, const Vec3 &edges,
            std::span<const Offset> eight);

  int largest_offset;
  std::vector<std::uint32_t> numbers; ///< by offset, a cube
  Spectra values;
};

/// What acts on one grid: kernel number and source number.
struct GridLink
{
  std::uint32_t kernel, source;
};

/// In one block of frequencies: the spectra of the stress in all targets. Links of target t: [first[t], first[t+1]), summed in this
/// order.
void convolve(double nu, std::span<const GridLink> links, std::span<const std::uint32_t> first, const Row *kernels,
              const Row *sources, Row *targets);
} // namespace ddfem::fmm
